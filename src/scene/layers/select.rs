//! Selections: splats of a layer that become a layer of their own.

use std::str::FromStr;

use rara_base::error::{Error, Result};

use super::region::Region;
use super::{LayerEntry, Selection};
use crate::gaussians::Gaussians;
use crate::parts::Part;
use crate::predicate::Predicate;
use crate::property::Property;

/// A selection as text: `[LAYER/]NAME=PREDICATE`.
#[derive(Debug, Clone, PartialEq)]
pub struct SelectionRequest {
    /// The layers that it takes from; none for every file's own.
    pub layer: Option<String>,
    /// The name of the layers that it makes.
    pub name: String,
    /// What it takes.
    pub predicate: Region<Predicate>,
}

impl FromStr for SelectionRequest {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let refused = |what: &str| Error::Invalid(what.into());
        let Some((target, predicate)) = text.split_once('=') else {
            return Err(refused(
                "expected NAME=PREDICATE, as in 'vessels=label in 3,4'",
            ));
        };
        let predicate = predicate.parse()?;
        let (layer, name) = match target.rsplit_once('/') {
            Some((layer, name)) => (Some(layer.to_owned()), name.trim()),
            None => (None, target.trim()),
        };
        if name.is_empty() {
            return Err(refused("a name for the layer goes before the ="));
        }
        Ok(Self {
            layer,
            name: name.into(),
            predicate,
        })
    }
}

impl SelectionRequest {
    /// Adds the selection to each layer that it takes from; false if there is none.
    #[must_use]
    pub fn add_to(&self, entries: &mut [LayerEntry]) -> bool {
        let mut found = false;
        for entry in entries {
            let sources: Vec<_> = match &self.layer {
                None => vec![0],
                Some(layer) => {
                    let names = entry.names().enumerate();
                    names
                        .filter(|(_, name)| name == layer)
                        .map(|(at, _)| at)
                        .collect()
                }
            };
            for from in sources {
                found = true;
                let (name, predicate) = (self.name.clone(), self.predicate.clone());
                let mut selected = Selection::new(name, predicate, entry);
                if let Some(source) = from.checked_sub(1).map(|at| &entry.selected[at]) {
                    (selected.state, selected.clip) = (source.state, source.clip.clone());
                }
                entry.selected.push(Selection { from, ..selected });
            }
        }
        found
    }
}

/// The names of the properties that selections compare, each once, as [`LoadOptions`](crate::LoadOptions) takes them.
pub fn compared(selected: &[Selection]) -> Vec<&str> {
    let mut names: Vec<_> = selected
        .iter()
        .flat_map(|one| one.predicate.example().properties())
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Divides a file's Gaussians by what its selections take: what is left of them, then what each selection has taken.
pub(super) fn divide(
    gaussians: Gaussians,
    properties: &[Property],
    (entry, predicates): (&LayerEntry, &[Predicate]),
) -> Result<Vec<Part>> {
    let mut part_of = vec![0; gaussians.len()];
    for (number, (selected, predicate)) in entry.selected.iter().zip(predicates).enumerate() {
        let taken = predicate.select(&gaussians, properties, &entry.state.placement)?;
        for (part, taken) in part_of.iter_mut().zip(taken) {
            if taken && *part as usize == selected.from {
                *part = number as u32 + 1;
            }
        }
    }
    gaussians.into_parts(&part_of, 1 + entry.selected.len())
}

/// How many Gaussians are in the files before a part of a file, and its Gaussians' numbers in the file.
pub type FileNumbers = (u32, Vec<u32>);

/// What has become of a layer's Gaussians.
#[derive(Debug)]
pub struct LayerRemains {
    /// The place of the layer in the files, where it was a part of one.
    pub numbers: Option<FileNumbers>,
    /// How many Gaussians it had.
    pub count: usize,
    /// Those that remain.
    pub gaussians: Gaussians,
    /// For each of them, the number in the layer of the one that it comes from.
    pub sources: Vec<u32>,
}

/// Joins what has become of layers to one set, with the number of each Gaussian in all files. Where selections have divided files, it
/// is in the files' order, as if they had not: Gaussians that are equally deep are drawn in that order.
pub fn joined(layers: Vec<LayerRemains>) -> Part {
    let mut joined = Gaussians::default();
    let mut before = 0_u32;
    let numbers = layers.iter().map(|layer| {
        let number = |&source: &u32| match &layer.numbers {
            Some((first, numbers)) => first.saturating_add(numbers[source as usize]),
            None => before.saturating_add(source),
        };
        let own: Vec<u32> = layer.sources.iter().map(number).collect();
        before = before.saturating_add(layer.count as u32);
        own
    });
    let numbers: Vec<_> = numbers.collect();
    if layers.iter().all(|layer| layer.numbers.is_none()) {
        for layer in layers {
            joined.append(&layer.gaussians);
        }
        return Part {
            gaussians: joined,
            numbers: numbers.concat(),
        };
    }
    let mut places = Vec::new();
    for (at, own) in numbers.into_iter().enumerate() {
        let own = own.into_iter().enumerate();
        places.extend(own.map(|(index, number)| (number, at, index)));
    }
    places.sort_unstable();
    let degree = layers.iter().map(|layer| layer.gaussians.sh_degree()).max();
    // All are trained alike.
    let mut all = layers.iter().map(|layer| &layer.gaussians);
    if let Some(first) = all.find(|layer| !layer.is_empty()) {
        joined = first.empty_like();
    }
    joined.set_sh_degree(degree.unwrap_or(0));
    let mut sh = vec![0.0; 3 * joined.sh_coefficients()];
    for &(_, at, index) in &places {
        let from = &layers[at].gaussians;
        let own = from.sh_of(index);
        sh.fill(0.0);
        sh[..own.len()].copy_from_slice(own);
        joined.push(
            (from.positions()[index].as_dvec3() + from.shift_to(&joined)).as_vec3(),
            from.scales()[index],
            from.rotations()[index],
            from.opacities()[index],
            &sh,
        );
    }
    Part {
        gaussians: joined,
        numbers: places.into_iter().map(|(number, ..)| number).collect(),
    }
}

#[cfg(test)]
mod tests;
