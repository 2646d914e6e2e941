//! Quadrics: which side of one a Gaussian is on, whole boxes of Gaussians, and what it is in a Gaussian's unit space.

use glam::DVec3;

use super::region_surface::RegionSurface;
use super::{Ellipsoid, HalfSpace, Side};
use crate::real::{Real, Vec3, vec3};
use rara_scene::clip::Quadric;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symmetric<T> {
    /// xx, yy, zz.
    pub diagonal: Vec3<T>,
    /// xy, xz, yz.
    pub across: Vec3<T>,
}

impl<T: Real> Symmetric<T> {
    pub fn zero() -> Self {
        Self {
            diagonal: Vec3::zero(),
            across: Vec3::zero(),
        }
    }

    pub fn times(&self, v: Vec3<T>) -> Vec3<T> {
        let (d, a) = (self.diagonal, self.across);
        vec3(
            d.x * v.x + a.x * v.y + a.y * v.z,
            a.x * v.x + d.y * v.y + a.z * v.z,
            a.y * v.x + a.z * v.y + d.z * v.z,
        )
    }

    /// `v . (matrix v)`.
    pub fn form(&self, v: Vec3<T>) -> T {
        v.dot(self.times(v))
    }

    pub fn trace(&self) -> T {
        self.diagonal.x + self.diagonal.y + self.diagonal.z
    }

    /// The root of the sum of all squares, which no eigenvalue exceeds.
    pub fn norm(&self) -> T {
        (self.diagonal.squared() + T::of(2.0) * self.across.squared()).sqrt()
    }

    fn scaled(&self, factor: T) -> Self {
        Self {
            diagonal: self.diagonal * factor,
            across: self.across * factor,
        }
    }

    /// The inverse of this matrix with `shift` added to its diagonal, if that is positive definite.
    fn inverse_shifted(&self, shift: T) -> Option<Self> {
        let d = self.diagonal + vec3(shift, shift, shift);
        let a = self.across;
        let minors = vec3(
            d.y * d.z - a.z * a.z,
            d.x * d.z - a.y * a.y,
            d.x * d.y - a.x * a.x,
        );
        let across = vec3(
            a.y * a.z - a.x * d.z,
            a.x * a.z - a.y * d.y,
            a.x * a.y - a.z * d.x,
        );
        let determinant = d.x * minors.x + a.x * across.x + a.y * across.y;
        let zero = T::zero();
        let trace = d.x + d.y + d.z;
        let least = T::of(DEFINITE) * trace * trace * trace;
        (d.x > zero && minors.z > zero && determinant > least).then(|| {
            Self {
                diagonal: minors,
                across,
            }
            .scaled(T::one() / determinant)
        })
    }
}

/// A surface in a Gaussian's unit space: the point `mu + M u` is visible iff `offset + normal . u + u . bend u >= 0`. A
/// plane's does not bend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitSurface<T> {
    /// What it is to first order about the Gaussian's centre.
    pub half_space: HalfSpace<T>,
    /// `M^T A M`, with A the quadric's matrix; the layer's units.
    pub bend: Symmetric<T>,
}

impl<T: Real> UnitSurface<T> {
    /// The same surface with its numbers divided by the largest one of its slopes.
    pub(crate) fn scaled(&self) -> Self {
        let bend = self.bend.diagonal.largest().max(self.bend.across.largest());
        let size = self.half_space.normal.largest().max(bend);
        let has_slope = size > T::zero();
        if !has_slope {
            return *self;
        }
        let factor = T::one() / size;
        Self {
            half_space: HalfSpace {
                normal: self.half_space.normal * factor,
                offset: self.half_space.offset * factor,
            },
            bend: self.bend.scaled(factor),
        }
    }

    /// The function of a point of the unit space, positive on the visible side.
    pub(crate) fn at(&self, point: Vec3<T>) -> T {
        self.half_space.distance(point) + self.bend.form(point)
    }

    /// Its gradient there.
    pub(crate) fn gradient(&self, point: Vec3<T>) -> Vec3<T> {
        self.half_space.normal + self.bend.times(point) * T::of(2.0)
    }

    pub(crate) fn is_flat(&self) -> bool {
        self.bend == Symmetric::zero()
    }
}

/// How often the bound of a quadratic function over a ball is improved at most, and from which step on no more, as a share.
const STEPS: usize = 16;
const STEP: f64 = 0.01;
/// The least shift as a share of the bend, and the least determinant as a share of the trace's cube: closer to a singular
/// matrix rounding would make a bound of nothing. What is left of its error is taken off.
const LEAST_SHIFT: f64 = 0.02;
const DEFINITE: f64 = 1e-4;
const ERROR: f64 = 1.01;

/// The side of a Gaussian whose band reaches `deviations` standard deviations: that of the ball of this radius.
///
/// The least value of a quadratic function over a ball is that of its dual, the greatest `g - s K^2 - a . (Q + s I)^-1 a / 4`
/// over all s >= 0 for which the matrix is positive definite. Each such s gives a bound, so that the answer is conservative
/// wherever the search for the best one ends.
pub(super) fn gaussian_side<T: Real>(surface: &UnitSurface<T>, deviations: T) -> Side {
    let UnitSurface { half_space, bend } = surface;
    let slope = half_space.normal.length();
    let norm = bend.norm();
    let support = deviations * (slope + deviations * norm);
    let (sign, side) = match half_space.offset < T::zero() {
        true => (-T::one(), Side::Invisible),
        false => (T::one(), Side::Visible),
    };
    if half_space.offset.abs() >= support {
        return side;
    }
    if norm == T::zero() {
        return Side::Cutoff;
    }
    let (offset, bend) = (half_space.offset.abs(), bend.scaled(sign));
    // The point of the ball that the slope leads to is on the other side for most Gaussians that are cut.
    let downhill = half_space.normal * (deviations / slope);
    if offset - deviations * slope + bend.form(downhill) <= T::zero() {
        return Side::Cutoff;
    }
    let margin = T::of(1e-5) * support;
    // Here the matrix is positive definite, and the nearest point is inside the ball.
    let mut shift = slope / (deviations + deviations) + norm;
    for _ in 0..STEPS {
        let Some(inverse) = bend.inverse_shifted(shift) else {
            break;
        };
        let nearest = inverse.times(half_space.normal) * T::of(-0.5 * sign.wide());
        let length = nearest.length();
        // a . (Q + s I)^-1 a / 4 is half of -a . u.
        let taken = T::of(-0.5 * ERROR) * sign * half_space.normal.dot(nearest);
        if offset - shift * deviations * deviations - taken > margin {
            return side;
        }
        // Newton's step for 1/|u| = 1/K.
        let step = length * length * (length - deviations)
            / (deviations * inverse.form(nearest).max(T::of(1e-30)));
        let next = (shift + step).max(T::of(LEAST_SHIFT) * norm);
        if (next - shift).abs() <= T::of(STEP) * shift {
            break;
        }
        shift = match bend.inverse_shifted(next) {
            Some(_) => next,
            None => T::of(0.5) * (shift + next),
        };
    }
    Side::Cutoff
}

impl RegionSurface for Quadric {
    fn gaussian_side<T: Real>(&self, ellipsoid: &Ellipsoid<T>, deviations: T) -> Side {
        gaussian_side(&self.unit_surface(ellipsoid), deviations)
    }

    fn box_side(&self, middle: DVec3, half: DVec3, support: f64) -> Side {
        let half = half + support;
        let value = self.distance(middle);
        let slope = self.gradient(middle).abs().dot(half);
        let matrix = self.matrix();
        let diagonal = DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z);
        let squares = half * half;
        let across = 2.0
            * (matrix.y_axis.x.abs() * half.x * half.y
                + matrix.z_axis.x.abs() * half.x * half.z
                + matrix.z_axis.y.abs() * half.y * half.z);
        let least = value - slope + diagonal.min(DVec3::ZERO).dot(squares) - across;
        let greatest = value + slope + diagonal.max(DVec3::ZERO).dot(squares) + across;
        if least > 0.0 {
            Side::Visible
        } else if greatest < 0.0 {
            Side::Invisible
        } else {
            Side::Cutoff
        }
    }

    fn unit_surface<T: Real>(&self, ellipsoid: &Ellipsoid<T>) -> UnitSurface<T> {
        let &Ellipsoid { centre, axes } = ellipsoid;
        let columns = self.matrix().to_cols_array_2d();
        let element = |i: usize, j: usize| T::of(columns[j][i]);
        let matrix = Symmetric {
            diagonal: vec3(element(0, 0), element(1, 1), element(2, 2)),
            across: vec3(element(0, 1), element(0, 2), element(1, 2)),
        };
        let turned = axes.map(|axis| matrix.times(axis));
        UnitSurface {
            half_space: HalfSpace::of_plane(
                ellipsoid,
                self.gradient(centre),
                self.distance(centre),
            ),
            bend: Symmetric {
                diagonal: vec3(
                    axes[0].dot(turned[0]),
                    axes[1].dot(turned[1]),
                    axes[2].dot(turned[2]),
                ),
                across: vec3(
                    axes[0].dot(turned[1]),
                    axes[0].dot(turned[2]),
                    axes[1].dot(turned[2]),
                ),
            },
        }
    }

    /// There are none, one or two.
    fn crossings(&self, start: DVec3, step: DVec3) -> Vec<f64> {
        let a = step.dot(self.matrix() * step);
        let b = self.gradient(start).dot(step);
        let c = self.distance(start);
        let square = b * b - 4.0 * a * c;
        if square < 0.0 {
            return Vec::new();
        }
        let sum = -0.5 * (b + square.sqrt().copysign(b));
        [sum / a, c / sum]
            .into_iter()
            .filter(|t| t.is_finite())
            .collect()
    }
}

#[cfg(test)]
mod tests;
