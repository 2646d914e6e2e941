//! The share of a splat that four and more planes keep together: the chance that three normal variables are in a polytope.
//!
//! What a pixel leaves open of a Gaussian varies in three directions. The first variable is the one across the strictest plane. In
//! it the polytope has two ends, at which its chords along the second one, across which planes turn away most, end like roots: the
//! integral is a sum at Chebyshev's places between them. Chords are exact. Little depends on the third variable, or nothing for a prism: its integral is a sum of slices at equal distances.

use super::real::Real;
use super::threshold::{Direction, PHI_ONE, Threshold};

/// Chords of a slice, and slices on either side of the mean.
const CHORDS: usize = 16;
const SLICES: i32 = 11;
/// How far slices are apart, deviations.
const APART: f64 = 0.37;
/// Planes that turn away from the strictest one by less, as a sine, make no polytope with ends, but a bent plane.
const NARROW: f64 = 0.5;
/// A plane is along a chord where it changes by less along that than aside.
const LEAST_ALONG: f64 = 1e-6;

/// The chance that all variables are positive, of which the strictest comes first.
pub(super) fn polytope<T: Real>(planes: &[Threshold<T>]) -> T {
    let (zero, one) = (T::zero(), T::one());
    let g = planes[0].direction;
    let (h, most) = farthest(planes, |d| d - g * d.dot(&g));
    // Planes that hardly turn away from the strictest one are crossed along its normal.
    let is_narrow = most < T::of(NARROW * NARROW);
    let (g, h) = if is_narrow { (h, g) } else { (g, h) };
    let (third, most) = farthest(planes, |d| d - g * d.dot(&g) - h * d.dot(&h));
    let is_prism = most <= T::of(1e-6);
    let slices = if is_prism { 0 } else { SLICES };
    let (mut share, mut weights) = (zero, zero);
    for slice in -slices..=slices {
        let t = T::of(APART * f64::from(slice));
        let weight = (-T::of(0.5) * t * t).exp();
        weights = weights + weight;
        let edges = planes.iter().map(|&Threshold { z, direction, .. }| Edge {
            along: direction.dot(&h),
            aside: direction.dot(&g),
            offset: z + t * direction.dot(&third),
        });
        share = share + weight * slice_share(&edges.collect::<Vec<_>>());
    }
    (share / weights).min(one)
}

/// The unit vector of the longest of what is left of the planes' directions, and the square of its length: 0 where nothing is left.
fn farthest<T: Real>(
    planes: &[Threshold<T>],
    left: impl Fn(Direction<T>) -> Direction<T>,
) -> (Direction<T>, T) {
    let left = planes.iter().map(|plane| left(plane.direction));
    let squares = left.map(|direction| (direction, direction.squared()));
    let longest = squares.reduce(|most, one| if one.1 > most.1 { one } else { most });
    let (longest, square) = longest.expect("several planes");
    let inverse = match square > T::of(1e-12) {
        true => T::one() / square.sqrt(),
        false => T::zero(),
    };
    (longest * inverse, square)
}

/// A plane in a slice of the polytope.
struct Edge<T> {
    along: T,
    aside: T,
    offset: T,
}

/// The chord at u, from low to high, and by how much its length changes with u.
fn chord<T: Real>(edges: &[Edge<T>], u: T) -> (T, T, T) {
    let mut ends = [(T::of(-9.0), T::zero()), (T::of(9.0), T::zero())];
    for edge in edges {
        if edge.along.abs() > T::of(LEAST_ALONG) * edge.aside.abs() {
            let slope = -edge.aside / edge.along;
            let end = (slope * u - edge.offset / edge.along, slope);
            if edge.along > T::zero() && end.0 > ends[0].0 {
                ends[0] = end;
            } else if edge.along < T::zero() && end.0 < ends[1].0 {
                ends[1] = end;
            }
        }
    }
    (ends[0].0, ends[1].0, ends[1].1 - ends[0].1)
}

/// The chance that two normal variables are in a polygon.
fn slice_share<T: Real>(edges: &[Edge<T>]) -> T {
    let (zero, half) = (T::zero(), T::of(0.5));
    if edges.iter().all(|edge| edge.aside == zero) {
        let (from, to, _) = chord(edges, zero);
        return (to.phi() - from.phi()).max(zero);
    }
    let mut ends = [-T::of(PHI_ONE), T::of(PHI_ONE)];
    for edge in edges {
        if edge.along.abs() <= T::of(LEAST_ALONG) * edge.aside.abs() {
            let end = -edge.offset / edge.aside;
            match edge.aside > zero {
                true => ends[0] = ends[0].max(end),
                false => ends[1] = ends[1].min(end),
            }
        }
    }
    for (end, inwards) in ends.iter_mut().zip([T::one(), -T::one()]) {
        // The length of a chord is a concave function of its place, so that no step of Newton's goes too far.
        for _ in 0..40 {
            let (low, high, opening) = chord(edges, *end);
            if low <= high {
                break;
            }
            if opening * inwards <= zero {
                return zero;
            }
            *end = *end + (low - high) / opening;
        }
    }
    let [low, high] = ends;
    let half_width = half * (high - low).max(zero);
    let step = T::of(std::f64::consts::PI / CHORDS as f64);
    let sum = (0..CHORDS).fold(zero, |sum, place| {
        let angle = step * T::of(place as f64 + 0.5);
        let u = half * (low + high) - half_width * angle.cos();
        let (from, to, _) = chord(edges, u);
        let kept = (to.phi() - from.phi()).max(zero);
        sum + angle.sin() * (-half * u * u).exp() * kept
    });
    sum * step * half_width / T::of(std::f64::consts::TAU.sqrt())
}
