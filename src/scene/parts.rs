//! A set of Gaussians in parts, each of which becomes a layer.

use super::{GaussianArrays, Gaussians};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// Gaussians that are a part of a set, as [`Gaussians::into_parts`] and [`Predicate::split`](super::Predicate::split) make
/// them; [`Layer::numbered`](super::Layer::numbered) makes a layer of one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// The Gaussians, in the set's order.
    pub gaussians: Gaussians,
    /// For each Gaussian its number in the set, ascending.
    pub numbers: Vec<u32>,
}

impl Gaussians {
    /// Divides the set into `parts` parts, some of which may be empty: `part_of` says for each Gaussian which it goes to,
    /// from 0. Beside the set, the parts from the second on are in memory meanwhile.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless `part_of` has one number for each Gaussian, all of them below `parts`; [`Error::Memory`] for
    /// parts that do not fit.
    pub fn into_parts(self, part_of: &[u32], parts: usize) -> Result<Vec<Part>> {
        let mut set = self;
        set.divide(part_of, parts)
    }

    /// Divides the set as [`into_parts`](Self::into_parts) does, and leaves it empty; after an error it is as it was.
    ///
    /// # Errors
    /// The errors of [`into_parts`](Self::into_parts).
    pub fn divide(&mut self, part_of: &[u32], parts: usize) -> Result<Vec<Part>> {
        if part_of.len() != self.len() {
            return Err(Error::Invalid(format!(
                "{} cannot be divided by {} of parts; give one each",
                counted(self.len(), "Gaussian"),
                counted(part_of.len(), "number")
            )));
        }
        let mut counts = vec![0; parts];
        for (index, &part) in part_of.iter().enumerate() {
            match counts.get_mut(part as usize) {
                Some(count) => *count += 1,
                None => {
                    return Err(Error::Invalid(format!(
                        "Gaussian {index} goes to part {part} of {parts}; parts are numbered from 0"
                    )));
                }
            }
        }
        let room = |(part, &count): (usize, &usize)| {
            let mut made = Part::default();
            made.numbers.try_reserve_exact(count).ok()?;
            // The first part is what the others leave in place.
            let count = if part == 0 { 0 } else { count };
            made.gaussians = Gaussians::with_room(count, self.sh_degree())?;
            made.gaussians.append(&self.empty_like());
            Some(made)
        };
        let made: Option<Vec<Part>> = counts.iter().enumerate().map(room).collect();
        let mut made = made.ok_or_else(|| {
            Error::Memory(format!(
                "no memory for {} of {}; free some or select fewer",
                counted(parts, "part"),
                counted(self.len(), "Gaussian")
            ))
        })?;
        for (index, &part) in part_of.iter().enumerate() {
            let part_of_it = &mut made[part as usize];
            part_of_it.numbers.push(index as u32);
            if part > 0 {
                part_of_it.gaussians.push_from(self, index);
            }
        }
        if let Some(first) = made.first_mut() {
            let mut arrays = std::mem::take(self).into_arrays();
            arrays.keep(&first.numbers);
            first.gaussians = Gaussians::of_fitting(arrays);
        }
        Ok(made)
    }

    fn push_from(&mut self, other: &Self, index: usize) {
        self.push(
            other.positions()[index],
            other.scales()[index],
            other.rotations()[index],
            other.opacities()[index],
            other.sh_of(index),
        );
    }
}

impl GaussianArrays {
    /// Drops all but those of these numbers, which ascend.
    pub(super) fn keep(&mut self, numbers: &[u32]) {
        keep(&mut self.positions, numbers, 1);
        keep(&mut self.scales, numbers, 1);
        keep(&mut self.rotations, numbers, 1);
        keep(&mut self.opacities, numbers, 1);
        keep(
            &mut self.sh,
            numbers,
            3 * super::sh_coefficients(self.sh_degree),
        );
    }
}

/// The numbers below a count but for these, which ascend.
#[cfg(feature = "formats")]
pub fn without(numbers: &[u32], count: usize) -> Vec<u32> {
    let mut numbers = numbers.iter().peekable();
    (0..count as u32)
        .filter(|number| numbers.next_if_eq(&number).is_none())
        .collect()
}

/// Drops all but the elements of these numbers, which ascend; each is so many long.
pub(super) fn keep<T: Copy>(array: &mut Vec<T>, numbers: &[u32], each: usize) {
    for (to, &from) in numbers.iter().enumerate() {
        let from = from as usize * each;
        array.copy_within(from..from + each, to * each);
    }
    array.truncate(numbers.len() * each);
    array.shrink_to_fit();
}

#[cfg(test)]
mod tests;
