//! The text of shapes, as `plane:nx,ny,nz,d` or `!sphere:cx,cy,cz,r`.

use std::fmt;
use std::str::FromStr;

use super::Shape;
use super::parameter::Role;
use super::solid::{KINDS, Kind};
use crate::axis::Axis;
use crate::bounds::Bounds;
use crate::text_reader::{joined, number};
use rara_base::error::{Error, Result, shortened};

/// The kind of solids of this name.
pub(super) fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.iter().copied().find(|kind| kind.name == name)
}

impl FromStr for Shape {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::read(text, None).map(|(read, _)| read)
    }
}

impl Shape {
    /// Reads a text. Where bounds are given, a plane or a slab may lie at shares of them, `plane:AXIS=SHARE%` or
    /// `slab:AXIS=FROM%..TO%`, and points and lengths may be shares, `sphere:50%,50%,50%,20%`; returns true beside the shape if
    /// there are any.
    pub(crate) fn read(text: &str, bounds: Option<&Bounds>) -> Result<(Self, bool)> {
        let (bare, outside) = match text.trim().strip_prefix('!') {
            Some(bare) => (bare, true),
            None => (text.trim(), false),
        };
        let Some((name, numbers)) = bare.split_once(':') else {
            return Err(Error::Invalid(format!(
                "'{}' is not a shape; give one like plane:1,0,0,-0.5 or sphere:0,0,0,1",
                shortened(bare)
            )));
        };
        let name = name.trim();
        let kind = kind(name).ok_or_else(|| {
            let names: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
            Error::Invalid(format!(
                "'{}' is not a shape; use {}",
                shortened(name),
                names.join(", ")
            ))
        })?;
        let (numbers, at_shares) = match (bounds, numbers.split_once('=')) {
            (Some(bounds), Some((axis, shares))) if ["plane", "slab"].contains(&name) => {
                let numbers = at_shares(name, axis, shares, bounds);
                let numbers =
                    numbers.map_err(|what| Error::Invalid(format!("'{bare}': {what}")))?;
                (numbers, true)
            }
            (Some(bounds), None) if numbers.contains('%') => {
                let numbers = with_shares(kind, numbers, bounds);
                let numbers =
                    numbers.map_err(|what| Error::Invalid(format!("'{bare}': {what}")))?;
                (numbers, true)
            }
            _ => (self::numbers(numbers)?, false),
        };
        let shape = Self::new(kind.solid(&numbers)?)?;
        let shape = if outside { shape.complement() } else { shape };
        Ok((shape, at_shares))
    }
}

/// A share in percent, as a part of 1.
fn share(text: &str) -> Option<f64> {
    let percent = number(text.trim().strip_suffix('%')?).ok()?;
    Some(percent / 100.0)
}

fn between([low, high]: [f64; 2], share: f64) -> f64 {
    low + (high - low) * share
}

/// The numbers of a solid of which some are shares of the bounds.
fn with_shares(kind: &Kind, text: &str, bounds: &Bounds) -> Result<Vec<f64>> {
    let roles = kind.parameters.iter().map(|(.., role)| *role);
    let places = roles.flat_map(|role| (0..role.count()).map(move |index| Some((role, index))));
    // There may be too many numbers, which is for the kind to say.
    let places = places.chain(std::iter::repeat(None));
    let number = |(text, place): (&str, Option<(Role, usize)>)| {
        let Some(share) = share(text) else {
            return number(text);
        };
        let ends = place.and_then(|(role, index)| role.share(index, bounds));
        let ends = ends.ok_or_else(|| {
            Error::Invalid(format!(
                "'{}' is not a point or a length, which alone can be shares of the scene",
                text.trim()
            ))
        })?;
        Ok(between(ends, share))
    };
    text.split(',').zip(places).map(number).collect()
}

/// The numbers of a plane, or of a slab, across an axis at shares of the bounds.
fn at_shares(
    name: &str,
    axis: &str,
    shares: &str,
    bounds: &Bounds,
) -> std::result::Result<Vec<f64>, &'static str> {
    // The other side is the outside of the shape.
    let axis = Axis::parse(axis.trim()).filter(|_| !axis.contains('!'));
    let along = axis
        .ok_or("expected one of the axes x, y, z, sagittal, coronal and axial")?
        .along;
    let ends = [bounds.min, bounds.max].map(|end| end.dot(along));
    let position = |text: &str| {
        share(text)
            .map(|share| between(ends, share))
            .ok_or("expected shares in percent, as in plane:x=40% or slab:x=40%..60%")
    };
    let place = match (name, shares.split_once("..")) {
        ("plane", None) => vec![-position(shares)?],
        ("plane", Some(_)) => return Err("a plane lies at one share; a slab lies between two"),
        (_, None) => return Err("a slab lies between two shares, as in slab:x=40%..60%"),
        (_, Some((from, to))) => match (position(from)?, position(to)?) {
            (from, to) if from < to => vec![-from, to - from],
            _ => return Err("the first share has to be the smaller one"),
        },
    };
    Ok(along.to_array().into_iter().chain(place).collect())
}

/// The text that it parses from.
impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (solid, not) = (self.solid(), if self.is_outside() { "!" } else { "" });
        let numbers = joined(&solid.numbers(), ",", f64::to_string);
        write!(f, "{not}{}:{numbers}", solid.name())
    }
}

/// Numbers between commas, all finite; blanks around them are allowed.
///
/// # Errors
/// [`Error::Invalid`] for anything else.
pub fn numbers(text: &str) -> Result<Vec<f64>> {
    text.split(',').map(number).collect()
}

/// So many of them.
///
/// # Errors
/// [`Error::Invalid`] for anything else.
pub fn numbers_of<const COUNT: usize>(text: &str) -> Result<[f64; COUNT]> {
    let list = numbers(text)?;
    let found = list.len();
    list.try_into().map_err(|_| {
        Error::Invalid(format!(
            "expected {COUNT} numbers with commas between them, found {found}"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused_and_says_what_is_missing() {
        for (text, words) in [
            ("", "not a shape"),
            ("plane", "not a shape"),
            ("plane:1,2,3", "4 numbers"),
            ("plane:0,0,0,1", "normal"),
            ("plane:nan,0,0,1", "'nan'"),
            ("slab:0,0,1,0,0", "thickness"),
            ("box:0,0,0,1,1", "6 numbers"),
            ("box:0,0,0,1,0,1", "above zero"),
            ("box:0,0,0,1,1,1,0,0,0,0", "quaternion"),
            ("sphere:0,0,0,-1", "above zero"),
            ("cylinder:0,0,0,0,0,0,1", "axis"),
            ("capsule:0,0,0,1", "7 numbers"),
            ("cone:0,0,0,1,1,1,0", "above zero"),
            ("torus:1", "plane, slab, box"),
        ] {
            let message = text.parse::<Shape>().unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
    }
}
