//! The text of shapes, as `plane:nx,ny,nz,d` or `!sphere:cx,cy,cz,r`.

use std::fmt;
use std::str::FromStr;

use super::Shape;
use super::solid::{KINDS, Kind};
use rara_base::error::{Error, Result, shortened};

/// The kind of solids of this name.
pub(super) fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.iter().copied().find(|kind| kind.name == name)
}

/// The names of all kinds, for messages.
pub(super) fn names() -> String {
    let names: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
    names.join(", ")
}

impl FromStr for Shape {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let (bare, outside) = match text.trim().strip_prefix('!') {
            Some(bare) => (bare, true),
            None => (text.trim(), false),
        };
        let Some((name, numbers)) = bare.split_once(':') else {
            return Err(Error::Invalid(format!(
                "'{}' is no shape; give one like plane:1,0,0,-0.5 or sphere:0,0,0,1",
                shortened(bare)
            )));
        };
        let name = name.trim();
        let kind = kind(name).ok_or_else(|| {
            Error::Invalid(format!(
                "'{}' is not a shape; use {}",
                shortened(name),
                names()
            ))
        })?;
        let shape = Self::new(kind.solid(&self::numbers(numbers)?)?)?;
        Ok(if outside { shape.complement() } else { shape })
    }
}

/// The text that it parses from.
impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let solid = self.solid();
        let numbers = solid.numbers().into_iter().map(|number| number.to_string());
        let numbers: Vec<String> = numbers.collect();
        let not = if self.is_outside() { "!" } else { "" };
        write!(f, "{not}{}:{}", solid.name(), numbers.join(","))
    }
}

/// Numbers between commas, all finite; blanks around them are allowed.
///
/// # Errors
/// [`Error::Invalid`] for anything else.
pub fn numbers(text: &str) -> Result<Vec<f64>> {
    text.split(',')
        .map(|part| match part.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(Error::Invalid(format!(
                "'{}' is not a finite number",
                shortened(part)
            ))),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused_and_says_what_is_missing() {
        for (text, words) in [
            ("", "no shape"),
            ("plane", "no shape"),
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
