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
    /// For each of them its number in the set, ascending.
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
    /// As of that.
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
mod tests {
    use super::*;
    use crate::{Kind, generate};

    #[test]
    fn parts_hold_every_gaussian_once_and_in_order() {
        let mut whole = generate(Kind::General, 1_000, 3);
        whole.set_antialiased(true);
        let part_of: Vec<u32> = (0..1_000_u32)
            .map(|i| i.wrapping_mul(2_654_435_761) % 3)
            .collect();
        let parts = whole.clone().into_parts(&part_of, 4).unwrap();
        assert!(parts[3].gaussians.is_empty());
        let mut found = 0;
        for (number, part) in parts.iter().enumerate() {
            assert!(part.numbers.is_sorted());
            assert_eq!(part.gaussians.sh_degree(), whole.sh_degree());
            assert!(part.gaussians.is_antialiased());
            for (index, &source) in part.numbers.iter().enumerate() {
                let source = source as usize;
                assert_eq!(part_of[source] as usize, number);
                let mut one = Gaussians::default();
                one.set_sh_degree(whole.sh_degree());
                let mut other = one.clone();
                one.push_from(&part.gaussians, index);
                other.push_from(&whole, source);
                assert_eq!(one, other);
                found += 1;
            }
        }
        assert_eq!(found, 1_000);
    }

    #[test]
    fn what_divides_nothing_is_refused() {
        let whole = generate(Kind::General, 2, 3);
        for (part_of, parts, words) in [
            (&[0][..], 1, "one each"),
            (&[0, 1], 1, "Gaussian 1 goes to part 1 of 1"),
            (&[0, 0], 0, "part 0 of 0"),
        ] {
            let mut set = whole.clone();
            let error = set.divide(part_of, parts).expect_err(words);
            assert!(error.to_string().contains(words), "{error}");
            assert_eq!(set, whole, "as it was");
        }
        let none = Gaussians::default().into_parts(&[], 2).unwrap();
        assert_eq!(none, vec![Part::default(); 2]);
    }
}
