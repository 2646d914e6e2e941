//! The share of a splat that several surfaces keep together, whatever they are and however they combine.
//!
//! Where at most three crossings are open in a pixel, the share is the sum of the chances of all combinations of their
//! sides that the region keeps, by the chances of one, two and three half-spaces at once. Otherwise the stretches between
//! crossings are added up, each of which the region keeps or not, of lines that cross the surfaces as steeply as one direction
//! can, at the points of a lattice: exact without low-pass. Open planes of a list are weighed as the polytope that they bound.

use super::RestSurface;
use super::crossing::Sight;
use super::reduced::list_op;
use super::share::share;
use crate::orthant::{both, orthant};
use crate::real::{Real, Vec3, vec3};
use crate::threshold::{PHI_ONE, Threshold};
use rara_scene::clip::ClipOp;
use rara_scene::clip::postfix::answer;

/// The surfaces that cut a splat, and how they combine.
#[derive(Debug, Clone, PartialEq)]
pub struct Combination<T>(pub Vec<(RestSurface<T>, Vec<ClipOp>)>);

/// What a function of this gradient changes by for each deviation.
pub(super) fn among<T: Real>(deviations: &[Vec3<T>; 3], gradient: Vec3<T>) -> Vec3<T> {
    let [x, y, z] = deviations.map(|deviation| gradient.dot(deviation));
    vec3(x, y, z)
}

impl<T: Real> Combination<T> {
    pub(super) fn answer(&self, kept: &dyn Fn(usize) -> bool) -> bool {
        let answers = self.0.iter().enumerate();
        let answers = answers.map(|(i, (_, operators))| (kept(i), operators.iter().copied()));
        answer(answers, true, |op, a, b| match op {
            ClipOp::And => a && b,
            ClipOp::Or => a || b,
        })
    }

    /// True when the region keeps a point of the unit space.
    pub(crate) fn keeps(&self, point: Vec3<T>) -> bool {
        self.answer(&|i| match &self.0[i].0 {
            RestSurface::Smooth(surface) => surface.at(point) >= T::zero(),
            RestSurface::Inside(inside) => inside.keeps(point),
        })
    }

    /// The share that is kept in a pixel.
    pub(crate) fn share(&self, sight: &Sight<T>) -> T {
        match &self.0[..] {
            [(RestSurface::Smooth(surface), _)] => return sight.share(surface),
            [(RestSurface::Inside(inside), _)] => {
                if let Some(share) = inside.share(sight.mean, sight.deviations()) {
                    return share;
                }
            }
            _ => {}
        }
        let ends = (-T::of(PHI_ONE), T::of(PHI_ONE));
        let mass = |low: T, high: T| high.phi() - low.phi();
        let by_lines = || self.measure_through(sight, ends, &mass);
        let smooth = self.0.iter().map(|(surface, _)| surface.as_smooth());
        let Some(smooth) = smooth.collect::<Option<Vec<_>>>() else {
            return by_lines().max(T::zero()).min(T::one());
        };
        let crossed: Vec<_> = smooth
            .iter()
            .map(|surface| sight.crossed(surface))
            .collect();
        let bent = crossed.iter().position(|crossed| crossed.bends);
        let mut open: Vec<Threshold<T>> = Vec::new();
        let is_open = |t: &Threshold<T>| t.z.abs() < T::of(PHI_ONE);
        // Of each surface: which of the open crossings it has, or its answer.
        let places: Vec<_> = crossed
            .iter()
            .map(|crossed| {
                if crossed.bends {
                    open.push(crossed.first);
                    return (Some(open.len() - 1), None);
                }
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
                _ if crossed.bends => by_first,
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
            _ if bent.is_some() && open.len() > 1 => by_lines(),
            [] => answer(0),
            [a] => {
                let p = bent.map_or_else(|| a.z.phi(), |bent| sight.share(smooth[bent]));
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
            _ => match list_op(&self.0) {
                Some(op) => share(op, crossed.iter().map(|crossed| crossed.first)),
                None => by_lines(),
            },
        };
        share.max(T::zero()).min(T::one())
    }
}
