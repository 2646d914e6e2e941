//! The number type of the reference, and vectors of it.

use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

use num_traits::Float;

/// `f64` (the truth that errors are measured against) or `f32` (the twin of the shaders).
pub trait Real: Float + Debug + Send + Sync + 'static {
    /// The nearest number to `x`.
    fn of(x: f64) -> Self;

    /// This number in double precision, exactly.
    fn wide(self) -> f64;

    /// The standard normal distribution function: the share of N(0, 1) below this number. It is accurate to the last
    /// digit or so on both sides, so that `phi(z) + phi(-z)` is 1 and far tails keep their leading digits.
    fn phi(self) -> Self {
        Self::of(0.5 * libm::erfc(-self.wide() * std::f64::consts::FRAC_1_SQRT_2))
    }
}

impl Real for f64 {
    fn of(x: f64) -> Self {
        x
    }

    fn wide(self) -> f64 {
        self
    }
}

impl Real for f32 {
    fn of(x: f64) -> Self {
        x as f32
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vec3<T> {
    pub x: T,
    pub y: T,
    pub z: T,
}

pub fn vec3<T>(x: T, y: T, z: T) -> Vec3<T> {
    Vec3 { x, y, z }
}

impl<T: Real> Vec3<T> {
    /// The nearest vector to one in double precision.
    pub fn of(v: glam::DVec3) -> Self {
        vec3(T::of(v.x), T::of(v.y), T::of(v.z))
    }

    pub fn zero() -> Self {
        vec3(T::zero(), T::zero(), T::zero())
    }

    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub fn cross(self, other: Self) -> Self {
        vec3(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    pub fn squared(self) -> T {
        self.dot(self)
    }

    /// A unit vector across a unit vector.
    pub fn perpendicular(self) -> Self {
        let (zero, one) = (T::zero(), T::one());
        let across = match self.x.abs() < T::of(0.7) {
            true => self.cross(vec3(one, zero, zero)),
            false => self.cross(vec3(zero, one, zero)),
        };
        across * (one / across.length())
    }

    pub fn length(self) -> T {
        self.squared().sqrt()
    }

    /// Largest component, by absolute value.
    pub fn largest(self) -> T {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }
}

impl<T: Real> Add for Vec3<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        vec3(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<T: Real> Sub for Vec3<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        vec3(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<T: Real> Mul<T> for Vec3<T> {
    type Output = Self;
    fn mul(self, factor: T) -> Self {
        vec3(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<T: Real> Neg for Vec3<T> {
    type Output = Self;
    fn neg(self) -> Self {
        vec3(-self.x, -self.y, -self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phi_has_its_known_values_and_keeps_its_tails() {
        assert_eq!(0.0_f64.phi(), 0.5);
        assert!((1.0_f64.phi() - 0.841_344_746_068_542_9).abs() < 1e-15);
        assert!(((-8.0_f64).phi() / 6.220_960_574_271_785e-16 - 1.0).abs() < 1e-13);
        assert_eq!(f64::INFINITY.phi(), 1.0);
        assert_eq!(f32::NEG_INFINITY.phi(), 0.0);
    }
}
