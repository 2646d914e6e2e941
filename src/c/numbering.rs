//! The numbers that Gaussians have in a scene of divided sets: of two that are equally deep, the one of the smaller number is
//! in front.

use std::borrow::Cow;
use std::sync::Arc;

/// A part of a set of Gaussians: which set it is, and their numbers in it, which ascend.
#[derive(Clone)]
pub(crate) struct SetPart {
    /// How many Gaussians the whole set has. Parts of one set share it, and thereby are known.
    pub(crate) set: Arc<usize>,
    pub(crate) numbers: Vec<u32>,
}

/// What the Gaussians of a layer are numbered by: the number of Gaussians before their set, and their numbers in the set.
pub(crate) type Numbers<'a> = Option<(u32, Cow<'a, [u32]>)>;

/// Numbers the layers of a scene, of each of which is known how many Gaussians it has and of what they are a part. Sets follow
/// one another in the order of their first layers. Where parts of a set are not in the scene the others close up, and a part
/// that is there again begins the set anew.
pub(crate) fn numbers<'a>(layers: &[(usize, Option<&'a SetPart>)]) -> Vec<Numbers<'a>> {
    let mut numbered: Vec<Numbers<'a>> = vec![None; layers.len()];
    if layers.iter().all(|(_, part)| part.is_none()) {
        return numbered;
    }
    let mut first = 0;
    for set in sets(layers) {
        let count: usize = set.iter().map(|&layer| layers[layer].0).sum();
        // More than 32 bits can say are refused with the scene.
        let begin = u32::try_from(first).unwrap_or(u32::MAX);
        let parts = || {
            let part = |&layer: &usize| Some((layer, layers[layer].1?));
            set.iter().filter_map(part)
        };
        match parts().next() {
            None => {
                for &layer in &set {
                    // Such layers number on from what is before them, if they are not told otherwise.
                    let before: usize = layers[..layer].iter().map(|(count, _)| count).sum();
                    if before != first {
                        numbered[layer] = Some((begin, (0..count as u32).collect()));
                    }
                }
            }
            Some((_, part)) if *part.set == count => {
                for (layer, part) in parts() {
                    numbered[layer] = Some((begin, Cow::Borrowed(&part.numbers[..])));
                }
            }
            Some(_) => {
                let numbers = |(layer, part): (usize, &'a SetPart)| {
                    part.numbers.iter().map(move |&number| (number, layer))
                };
                let mut all: Vec<_> = parts().flat_map(numbers).collect();
                all.sort_unstable();
                let mut ranks = vec![Vec::new(); layers.len()];
                for (rank, (_, layer)) in all.into_iter().enumerate() {
                    ranks[layer].push(rank as u32);
                }
                for (layer, _) in parts() {
                    numbered[layer] = Some((begin, std::mem::take(&mut ranks[layer]).into()));
                }
            }
        }
        first += count;
    }
    numbered
}

/// The layers of each set, of which one that is no part has one.
fn sets(layers: &[(usize, Option<&SetPart>)]) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for (index, (_, part)) in layers.iter().enumerate() {
        let of_part = |part: &SetPart| {
            sets.iter().rposition(|set: &Vec<usize>| {
                let mut others = set.iter().filter_map(|&layer| layers[layer].1).peekable();
                let is_same = |other: &&SetPart| Arc::ptr_eq(&other.set, &part.set);
                others.peek().is_some_and(is_same) && !others.any(|other| std::ptr::eq(other, part))
            })
        };
        match part.and_then(of_part) {
            Some(set) => sets[set].push(index),
            None => sets.push(vec![index]),
        }
    }
    sets
}

#[cfg(test)]
mod tests;
