//! What one plane keeps of a standard normal distribution, in closed form.
//!
//! Only the direction of the plane's normal matters: across it nothing changes. Along it the distribution is truncated
//! (Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, volume 1, section 13.10.1).

use glam::{DMat3, DVec3};

use super::child::Part;

/// The half-space of the points u with `normal . u >= beta`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfLine {
    /// A unit vector.
    normal: DVec3,
    /// Deviations from the centre.
    beta: f64,
}

impl HalfLine {
    pub(super) fn new(normal: DVec3, beta: f64) -> Self {
        Self { normal, beta }
    }

    /// A point just inside, the nearest one to the centre.
    pub(super) fn inside(&self) -> DVec3 {
        self.normal * (self.beta + 1e-6)
    }

    /// A point just outside.
    pub(super) fn outside(&self) -> DVec3 {
        self.normal * (self.beta - 1e-6)
    }

    pub(super) fn complement(self) -> Self {
        Self {
            normal: -self.normal,
            beta: -self.beta,
        }
    }

    /// What it keeps, in parts of equal mass along the normal, from the plane inwards.
    pub(super) fn parts(&self, count: usize) -> Vec<Part> {
        let mass = phi(-self.beta);
        let mut from = self.beta;
        let part = |number: usize| {
            let rest = mass * (count - number - 1) as f64 / count as f64;
            let to = if rest > 0.0 {
                quantile_above(rest)
            } else {
                f64::INFINITY
            };
            let (mass, mean, variance) = interval(from, to);
            from = to;
            let squeezed = DMat3::from_cols(
                self.normal * self.normal.x,
                self.normal * self.normal.y,
                self.normal * self.normal.z,
            ) * (1.0 - variance);
            Part {
                mass,
                mean: self.normal * mean,
                covariance: DMat3::IDENTITY - squeezed,
            }
        };
        (0..count).map(part).collect()
    }
}

/// Mass, mean and variance of the standard normal distribution between two numbers.
fn interval(from: f64, to: f64) -> (f64, f64, f64) {
    // The tail that loses no digits.
    let mass = if from > 0.0 {
        phi(-from) - phi(-to)
    } else {
        phi(to) - phi(from)
    };
    if to == f64::INFINITY {
        let mean = density(from) / mass;
        return (mass, mean, 1.0 - mean * (mean - from));
    }
    let mean = (density(from) - density(to)) / mass;
    let second = 1.0 + (from * density(from) - to * density(to)) / mass;
    (mass, mean, second - mean * mean)
}

/// The standard normal distribution function.
pub(super) fn phi(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

fn density(x: f64) -> f64 {
    (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt()
}

/// The number above which a share of the distribution lies, by bisection.
fn quantile_above(share: f64) -> f64 {
    let (mut low, mut high) = (-40.0, 40.0);
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if phi(-middle) > share {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
