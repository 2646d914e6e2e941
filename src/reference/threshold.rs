//! A plane on a pixel's line of sight: a threshold in a normal variable.

use super::real::{Real, Vec3};

/// Beyond this Phi is taken for 0 or 1.
pub(super) const PHI_ONE: f64 = 4.5;

/// A plane in a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold<T> {
    /// Mean over deviation of the plane's distance.
    pub z: T,
    /// True when the visible side is the farther one along the ray.
    pub far: bool,
    /// The half-space's direction among what the pixel leaves open of the Gaussian: a unit vector of ten components.
    pub direction: Direction<T>,
}

/// A unit vector: its component along the ray, and three vectors of components that the low-pass leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction<T> {
    /// `a . c`.
    pub along: T,
    /// `sqrt(L) a x b1`, `sqrt(L) a x b2` and `L a`.
    pub across: [Vec3<T>; 3],
}

impl<T: Real> Direction<T> {
    pub fn squared(&self) -> T {
        self.dot(self)
    }

    pub fn dot(&self, other: &Self) -> T {
        let across = self.across.iter().zip(&other.across);
        across.fold(self.along * other.along, |sum, (a, b)| sum + a.dot(*b))
    }
}

impl<T: Real> std::ops::Mul<T> for Direction<T> {
    type Output = Self;
    fn mul(self, factor: T) -> Self {
        Self {
            along: self.along * factor,
            across: self.across.map(|a| a * factor),
        }
    }
}

impl<T: Real> std::ops::Sub for Direction<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let [a, b, c] = self.across;
        let [d, e, f] = other.across;
        Self {
            along: self.along - other.along,
            across: [a - d, b - e, c - f],
        }
    }
}

impl<T: Real> Threshold<T> {
    pub fn complement(self) -> Self {
        Self {
            z: -self.z,
            far: !self.far,
            direction: self.direction * -T::one(),
        }
    }
}
