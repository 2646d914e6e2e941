//! Selections: Gaussians that fulfil a predicate become Gaussians of their own, which a scene has as a layer.

use std::ffi::c_char;
use std::sync::Arc;

use rara::scene::{Predicate, Property};
use rara::{Error, Placement, Result};

use crate::boundary::{RaraResult, guard, invalid, list};
use crate::gaussians::RaraGaussians;
use crate::handles::{alone, create};
use crate::numbering::SetPart;
use crate::placement::RaraPlacement;
use crate::text::text;

/// Gives each Gaussian a number of the host's own, such as a label, for the predicates of rara_gaussians_select: a property
/// of this name, in place of one that it had. `count` is that of the Gaussians. The values are copied; one that is no number
/// fulfils no comparison.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_set_property(
    gaussians: *mut RaraGaussians,
    name: *const c_char,
    values: *const f64,
    count: usize,
) -> RaraResult {
    guard(|| {
        let mut gaussians = alone(gaussians, "gaussians")?;
        let name = text(name, "name")?;
        if name.trim().is_empty() {
            return invalid("name is empty: name the property as predicates will");
        }
        if count != gaussians.gaussians.len() {
            return invalid(format!(
                "count is {count}, and there are {} Gaussians: give a value for each",
                gaussians.gaussians.len()
            ));
        }
        let values = list(values, count, "values")?.to_vec();
        gaussians.properties.retain(|own| own.name != name);
        gaussians.properties.push(Property::new(name, values));
        Ok(())
    })
}

/// Takes the Gaussians that fulfil a predicate out of others: `gaussians` keeps the rest, and `*taken`, which the host
/// destroys as any, has those that were taken; there may be none. Each becomes a layer of a scene, with a state (hidden,
/// faded, moved) and a clip of its own. In that scene, Gaussians of both that are equally deep are drawn in the order in
/// which they were before, whichever layer they are in, so that a selection by itself changes no picture. Either may be
/// selected from again.
///
/// `predicate` is what the program's `--select` takes: comparisons as "opacity>0.5", "size<=0.01", "red>0.6" and "label in
/// 3,4,7..9", where label is a property of rara_gaussians_load or rara_gaussians_set_property, and
/// "inside(sphere:0,0,0,1)", which takes any expression of rara_clip_parse; joined by `and`, `or`, `not` and ( ).
/// RARA_ERROR_INVALID says what is wrong and in which column, and names a property that is not there.
///
/// Clips and sizes are the scene's: `placement` is that of the layer that the Gaussians will be, and null leaves it where
/// it was made. After an error `gaussians` is as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_select(
    gaussians: *mut RaraGaussians,
    predicate: *const c_char,
    placement: *const RaraPlacement,
    taken: *mut *mut RaraGaussians,
) -> RaraResult {
    create(taken, "taken", || {
        let mut gaussians = alone(gaussians, "gaussians")?;
        let predicate = parse(text(predicate, "predicate")?, "predicate")?;
        let placement = match placement.as_ref() {
            Some(placement) => placement.placement()?,
            None => Placement::IDENTITY,
        };
        gaussians.select(&predicate, &placement)
    })
}

impl RaraGaussians {
    /// Takes out what fulfils a predicate.
    fn select(&mut self, predicate: &Predicate, placement: &Placement) -> Result<Self> {
        for name in predicate.properties() {
            if self.properties.iter().all(|own| own.name != name) {
                return invalid(format!(
                    "the predicate compares the property '{name}', which the Gaussians have not: load them by \
                     rara_gaussians_load and this predicate, or give values by rara_gaussians_set_property"
                ));
            }
        }
        let is_taken = predicate.select(&self.gaussians, &self.properties, placement)?;
        let part_of: Vec<u32> = is_taken.iter().copied().map(u32::from).collect();
        let count = self.gaussians.len();
        let mut parts = self.gaussians.divide(&part_of, 2)?.into_iter();
        let [rest, taken] = [(); 2].map(|()| parts.next().unwrap_or_default());
        let set = match &self.part {
            Some(whole) => whole.set.clone(),
            None => Arc::new(count),
        };
        let whole = self.part.take();
        let part = |mut numbers: Vec<u32>| {
            if let Some(whole) = &whole {
                for number in &mut numbers {
                    *number = whole.numbers[*number as usize];
                }
            }
            let set = set.clone();
            Some(SetPart { set, numbers })
        };
        let properties = self.properties_of(&taken.numbers);
        self.properties = self.properties_of(&rest.numbers);
        (self.gaussians, self.part) = (rest.gaussians, part(rest.numbers));
        Ok(Self {
            properties,
            part: part(taken.numbers),
            ..taken.gaussians.into()
        })
    }

    /// The properties of Gaussians that come from these.
    pub(crate) fn properties_of(&self, sources: &[u32]) -> Vec<Property> {
        let properties = self.properties.iter();
        properties.map(|one| one.of(sources)).collect()
    }

    /// Appends the values of another set's properties; one that either of them has not goes.
    pub(crate) fn append_properties(&mut self, other: &Self) {
        self.properties.retain_mut(|own| {
            let more = other.properties.iter().find(|more| more.name == own.name);
            if let Some(more) = more {
                own.values.extend_from_slice(&more.values);
                own.single &= more.single;
            }
            more.is_some()
        });
    }
}

/// Reads a predicate, which `name` names in messages.
pub(crate) fn parse(predicate: &str, name: &str) -> Result<Predicate> {
    let parsed = predicate.parse();
    parsed.map_err(|error: Error| Error::Invalid(format!("{name}: {error}")))
}

#[cfg(test)]
mod tests;
