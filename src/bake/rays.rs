//! What any region keeps of a standard normal distribution, by a quadrature that asks only whether a point is kept.
//!
//! Along a ray from the centre a density of `r^2 exp(-r^2 / 2)` is kept between crossings, which has moments in closed
//! form. The rays go through the points of a spherical Fibonacci lattice and their opposites (Gonzalez, Measurement of
//! areas on a sphere using Fibonacci and latitude-longitude lattices, 2010).

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use glam::{DMat3, DVec3};

use super::child::Part;

/// Pairs of opposite rays.
const PAIRS: u32 = 512;
/// The farthest that a ray is followed, deviations: 1.5e-5 of the mass lies beyond, and counts as what is there.
const FARTHEST: f64 = 5.0;
/// Where it is asked on the way whether a point is kept. What begins and ends between two of these is not seen: parts
/// thinner than a fifth of a deviation.
const STEPS: u32 = 24;
/// Bisections that find a crossing between two steps, to 1e-8 of a deviation.
const BISECTIONS: u32 = 24;

/// The kept intervals of rays from the centre.
pub(super) struct Rays(Vec<(DVec3, [f64; 2])>);

impl Rays {
    /// The rays through a region.
    pub(super) fn through(kept: impl Fn(DVec3) -> bool) -> Self {
        let mut intervals = Vec::new();
        for direction in directions() {
            let is_kept = |r: f64| kept(direction * r);
            let mut from = is_kept(0.0).then_some(0.0);
            let mut before = 0.0;
            for step in 1..=STEPS {
                let r = FARTHEST * f64::from(step) / f64::from(STEPS);
                if is_kept(r) != from.is_some() {
                    let crossing = crossing(before, r, &is_kept);
                    match from.take() {
                        Some(start) => intervals.push((direction, [start, crossing])),
                        None => from = Some(crossing),
                    }
                }
                before = r;
            }
            if let Some(start) = from {
                intervals.push((direction, [start, f64::INFINITY]));
            }
        }
        Self(intervals)
    }

    /// What is kept, in parts of equal mass along the direction of its mean.
    pub(super) fn parts(&self, count: usize) -> Vec<Part> {
        let whole = self.between(DVec3::ZERO, f64::NEG_INFINITY, f64::INFINITY);
        let along = whole.mean.normalize_or_zero();
        if count == 1 || along == DVec3::ZERO {
            return vec![whole];
        }
        let mut edges = vec![f64::NEG_INFINITY];
        for number in 1..count {
            let wanted = whole.mass * number as f64 / count as f64;
            let (mut low, mut high) = (-FARTHEST, FARTHEST);
            for _ in 0..24 {
                let middle = 0.5 * (low + high);
                match self.between(along, f64::NEG_INFINITY, middle).mass < wanted {
                    true => low = middle,
                    false => high = middle,
                }
            }
            edges.push(0.5 * (low + high));
        }
        edges.push(f64::INFINITY);
        let parts = edges.windows(2);
        parts
            .map(|edge| self.between(along, edge[0], edge[1]))
            .collect()
    }

    /// What is kept between two planes across a direction.
    fn between(&self, along: DVec3, low: f64, high: f64) -> Part {
        let (mut mass, mut mean, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for &(direction, [from, to]) in &self.0 {
            let slope = along.dot(direction);
            let (mut from, mut to) = (from, to);
            if slope.abs() > 1e-12 {
                let (a, b) = (low / slope, high / slope);
                (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
            } else if !(low < 0.0 && high >= 0.0) {
                continue;
            }
            if from < to {
                let [m0, m1, m2] = std::array::from_fn(|i| radial(to)[i] - radial(from)[i]);
                mass += m0;
                mean += direction * m1;
                second += outer(direction) * m2;
            }
        }
        if mass <= 0.0 {
            return Part::default();
        }
        let mean = mean / mass;
        Part {
            mass: mass / f64::from(2 * PAIRS),
            mean,
            covariance: second * (1.0 / mass) - outer(mean),
        }
    }
}

/// Where the answer changes between two points of a ray.
fn crossing(mut low: f64, mut high: f64, is_kept: &impl Fn(f64) -> bool) -> f64 {
    let first = is_kept(low);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if is_kept(middle) == first {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The lattice's directions, each followed by its opposite, so that odd moments of the whole are zero.
fn directions() -> impl Iterator<Item = DVec3> {
    let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
    (0..PAIRS).flat_map(move |number| {
        let z = (f64::from(number) + 0.5) / f64::from(PAIRS);
        let (across, turn) = ((1.0 - z * z).sqrt(), golden_angle * f64::from(number));
        let direction = DVec3::new(across * turn.cos(), across * turn.sin(), z);
        [direction, -direction]
    })
}

/// The integrals of the distance's density `sqrt(2 / pi) r^2 exp(-r^2 / 2)` from zero to r, times 1, r and r^2.
fn radial(r: f64) -> [f64; 3] {
    let scale = (2.0 / PI).sqrt();
    if r == f64::INFINITY {
        return [1.0, 2.0 * scale, 3.0];
    }
    let (normal, fall) = (libm::erf(r * FRAC_1_SQRT_2), scale * (-0.5 * r * r).exp());
    [
        normal - r * fall,
        2.0 * scale - (r * r + 2.0) * fall,
        3.0 * normal - (r * r + 3.0) * r * fall,
    ]
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
