//! The numbers of a scene's Gaussians: of two that are equally deep, the one of the smaller number is in front.

use super::Layer;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// The numbers that the Gaussians of a layer have in its scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Numbers<'a> {
    /// The number of the set's first Gaussian, which the layer is a part of or the whole.
    first: u32,
    /// For each Gaussian its number in the set; `None` where the layer is the whole of it.
    in_set: Option<&'a [u32]>,
}

impl<'a> Numbers<'a> {
    /// Numbers that follow each other.
    pub fn of_whole(first: u32) -> Self {
        Self {
            first,
            in_set: None,
        }
    }

    pub(super) fn of_part(first: u32, in_set: &'a [u32]) -> Self {
        Self {
            first,
            in_set: Some(in_set),
        }
    }

    /// The number of one of the layer's Gaussians.
    pub fn of(&self, index: u32) -> u32 {
        self.first + self.in_set.map_or(index, |numbers| numbers[index as usize])
    }

    /// The set that a layer with these numbers is a part of, by its first number; `None` where the layer is the whole of it.
    pub fn set(&self) -> Option<u32> {
        self.in_set.map(|_| self.first)
    }
}

/// Checks that the Gaussians of layers, with room for `room` in all, have numbers below that, and each its own.
///
/// # Errors
/// [`Error::Invalid`] names the layer, and what is wrong with its numbers.
pub(super) fn check(layers: &[Layer<'_>], room: u64) -> Result<()> {
    if layers.iter().all(|layer| layer.numbers.is_none()) {
        return Ok(());
    }
    let mut taken = vec![false; room as usize];
    let mut before = 0;
    for layer in layers {
        let (name, own) = (layer.name(), layer.gaussians().len());
        let (first, in_set) = match layer.numbers {
            Some((first, numbers)) => (u64::from(first), Some(numbers)),
            None => (before, None),
        };
        before += u64::from(layer.room());
        if let Some(numbers) = in_set.filter(|numbers| numbers.len() != own) {
            return Err(Error::Invalid(format!(
                "layer '{name}' has {} and {} for them; give one each",
                counted(own, "Gaussian"),
                counted(numbers.len(), "number")
            )));
        }
        for index in 0..own {
            let number = first + in_set.map_or(index as u64, |numbers| numbers[index].into());
            let place = usize::try_from(number).ok();
            match place.and_then(|place| taken.get_mut(place)) {
                Some(taken) if !*taken => *taken = true,
                found => {
                    let problem = match found {
                        Some(_) => "which another has too".to_owned(),
                        None => format!("and the scene's {room} have those below {room}"),
                    };
                    return Err(Error::Invalid(format!(
                        "Gaussian {index} of layer '{name}' has number {number}, {problem}; number the layers by the sets \
                         that they are parts of, and give all parts of each"
                    )));
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
