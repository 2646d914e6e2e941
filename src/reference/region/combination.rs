//! The share of a splat that several surfaces keep together, whatever they are and however they combine.
//!
//! Where at most three crossings are open in a pixel, the share is the sum of the chances of all combinations of their
//! sides that the region keeps, by the chances of one, two and three half-spaces at once. Otherwise the stretches between
//! crossings are added up, each of which the region keeps or not, of the line of sight and of lines beside it: exact
//! without low-pass.

use super::UnitSurface;
use super::crossing::{PHI_ONE, Sight, SurfaceCrossing};
use crate::orthant::{Threshold, both, orthant};
use crate::real::{Real, Vec3};
use rara_scene::clip::ClipOp;
use rara_scene::clip::postfix::answer;

/// The surfaces that cut a splat, and how they combine.
#[derive(Debug, Clone, PartialEq)]
pub struct Combination<T>(pub Vec<(UnitSurface<T>, Vec<ClipOp>)>);

/// A stretch of a line, and whether a surface keeps it or the rest.
#[derive(Debug, Clone, Copy)]
struct Stretch<T> {
    start: T,
    end: T,
    between: bool,
}

impl<T: Real> Stretch<T> {
    fn from_crossing(crossed: &SurfaceCrossing<T>) -> Self {
        let place = |z: T, first: bool| match (crossed.first.far, first) {
            (true, true) | (false, false) => -z,
            (false, true) | (true, false) => z,
        };
        let first = place(crossed.first.z, true);
        match crossed.second {
            Some(second) => {
                let second = place(second.z, false);
                Self {
                    start: first.min(second),
                    end: first.max(second),
                    between: crossed.between,
                }
            }
            None if crossed.first.far => Self {
                start: first,
                end: T::infinity(),
                between: true,
            },
            None => Self {
                start: T::neg_infinity(),
                end: first,
                between: true,
            },
        }
    }

    fn keeps(&self, t: T) -> bool {
        (t >= self.start && t <= self.end) == self.between
    }
}

impl<T: Real> Combination<T> {
    fn answer(&self, kept: &dyn Fn(usize) -> bool) -> bool {
        let answers = self.0.iter().enumerate();
        let answers = answers.map(|(i, (_, operators))| (kept(i), operators.iter().copied()));
        answer(answers, true, |op, a, b| match op {
            ClipOp::And => a && b,
            ClipOp::Or => a || b,
        })
    }

    /// True when the region keeps a point of the unit space.
    pub(crate) fn keeps(&self, point: Vec3<T>) -> bool {
        self.answer(&|i| self.0[i].0.at(point) >= T::zero())
    }

    /// The measure of what is kept of a line from `start` to `end`, by the measure of a stretch.
    pub(crate) fn measure(
        &self,
        sight: &Sight<T>,
        (start, end): (T, T),
        measure: &dyn Fn(T, T) -> T,
    ) -> T {
        let stretches: Vec<_> = self
            .0
            .iter()
            .map(|(surface, _)| Stretch::from_crossing(&sight.crossed(surface)))
            .collect();
        self.walked(&stretches, (start, end), measure)
    }

    fn walked(
        &self,
        stretches: &[Stretch<T>],
        (start, end): (T, T),
        measure: &dyn Fn(T, T) -> T,
    ) -> T {
        let ends = stretches.iter().flat_map(|s| [s.start, s.end]);
        let mut ends: Vec<T> = ends.filter(|&t| t > start && t < end).collect();
        ends.extend([start, end]);
        ends.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        let one = T::one();
        let mut total = T::zero();
        for pair in ends.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let middle = match (low.is_finite(), high.is_finite()) {
                (true, true) => T::of(0.5) * (low + high),
                (true, false) => low + one,
                (false, true) => high - one,
                (false, false) => T::zero(),
            };
            if self.answer(&|i| stretches[i].keeps(middle)) {
                total = total + measure(low, high);
            }
        }
        total
    }

    /// The share that is kept in a pixel.
    pub(crate) fn share(&self, sight: &Sight<T>) -> T {
        if let [(surface, _)] = &self.0[..] {
            return sight.share(surface);
        }
        let crossed: Vec<_> = self.0.iter().map(|(s, _)| sight.crossed(s)).collect();
        let mut open: Vec<Threshold<T>> = Vec::new();
        let is_open = |t: &Threshold<T>| t.z.abs() < T::of(PHI_ONE);
        // Of each surface: which of the open crossings it has, or its answer.
        let places: Vec<_> = crossed
            .iter()
            .map(|crossed| {
                let mut place = |t: &Threshold<T>| {
                    is_open(t).then(|| {
                        open.push(*t);
                        open.len() - 1
                    })
                };
                let first = place(&crossed.first);
                let second = crossed.second.as_ref().and_then(&mut place);
                (first, second)
            })
            .collect();
        let kept = |i: usize, sides: usize| {
            let (first, second) = places[i];
            let side = |place: Option<usize>, z: T| {
                place.map_or(z > T::zero(), |place| sides >> place & 1 == 1)
            };
            let crossed = &crossed[i];
            let by_first = side(first, crossed.first.z);
            match crossed.second {
                None => by_first,
                Some(t) if crossed.between => by_first && side(second, t.z),
                Some(t) => by_first || side(second, t.z),
            }
        };
        let answer = |sides: usize| match self.answer(&|i| kept(i, sides)) {
            true => T::one(),
            false => T::zero(),
        };
        let share = match open[..] {
            [] => answer(0),
            [a] => {
                let p = a.z.phi();
                answer(0) * (T::one() - p) + answer(1) * p
            }
            [a, b] => {
                let (p, q, r) = (a.z.phi(), b.z.phi(), both(&a, &b));
                answer(3) * r
                    + answer(1) * (p - r)
                    + answer(2) * (q - r)
                    + answer(0) * (T::one() - p - q + r)
            }
            [a, b, c] => {
                let (p, q, r) = (a.z.phi(), b.z.phi(), c.z.phi());
                let (pq, pr, qr) = (both(&a, &b), both(&a, &c), both(&b, &c));
                let all = orthant([a, b, c].into_iter());
                answer(7) * all
                    + answer(3) * (pq - all)
                    + answer(5) * (pr - all)
                    + answer(6) * (qr - all)
                    + answer(1) * (p - pq - pr + all)
                    + answer(2) * (q - pq - qr + all)
                    + answer(4) * (r - pr - qr + all)
                    + answer(0) * (T::one() - p - q - r + pq + pr + qr - all)
            }
            _ => {
                let ends = (T::neg_infinity(), T::infinity());
                let lines = sight.beside().into_iter();
                lines.fold(T::zero(), |sum, (line, weight)| {
                    let kept = self.measure(&line, ends, &|low, high| high.phi() - low.phi());
                    sum + weight * kept
                })
            }
        };
        share.max(T::zero()).min(T::one())
    }
}
