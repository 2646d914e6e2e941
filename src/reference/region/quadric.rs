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
        let gradient = Vec3::of(self.gradient(centre));
        let columns = self.matrix().to_cols_array_2d();
        let element = |i: usize, j: usize| T::of(columns[j][i]);
        let matrix = Symmetric {
            diagonal: vec3(element(0, 0), element(1, 1), element(2, 2)),
            across: vec3(element(0, 1), element(0, 2), element(1, 2)),
        };
        let turned = axes.map(|axis| matrix.times(axis));
        UnitSurface {
            half_space: HalfSpace {
                normal: vec3(
                    axes[0].dot(gradient),
                    axes[1].dot(gradient),
                    axes[2].dot(gradient),
                ),
                offset: T::of(self.distance(centre)),
            },
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
mod tests {
    use super::*;
    use rara_scene::Random;

    fn normal(random: &mut Random) -> f64 {
        (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
    }

    fn vector(random: &mut Random) -> Vec3<f64> {
        vec3(normal(random), normal(random), normal(random))
    }

    /// The least value of a surface's function in a ball, or close to it: by going downhill from many points.
    fn least(surface: &UnitSurface<f64>, radius: f64, sign: f64, random: &mut Random) -> f64 {
        let into_ball = |u: Vec3<f64>| match u.length() > radius {
            true => u * (radius / u.length()),
            false => u,
        };
        let mut least = f64::INFINITY;
        for _ in 0..12 {
            let mut point = into_ball(vector(random) * radius);
            let step = 0.4 / (surface.bend.norm() + surface.half_space.normal.length() / radius);
            for _ in 0..60 {
                point = into_ball(point - surface.gradient(point) * (sign * step));
            }
            least = least.min(sign * surface.at(point));
        }
        least
    }

    #[test]
    fn sides_are_conservative_and_tight() {
        let mut random = Random::new(31);
        let (mut cut, mut truly_cut) = (0, 0);
        for round in 0..6_000 {
            // Slopes of 1, and radii from a third of a deviation to hundreds.
            let bend = 1.5 * 0.5_f64.powi(round % 10);
            let squares = match round % 4 {
                0 => vec3(-1.0, -1.0, -1.0),
                1 => vec3(-1.0, -random.unit(), -0.01),
                2 => vec3(-1.0, -random.unit(), 0.0),
                _ => vector(&mut random),
            };
            let slope = vector(&mut random);
            let deviations = 1.0 + 2.3 * random.unit();
            let surface = UnitSurface {
                half_space: HalfSpace {
                    normal: slope * (1.0 / slope.length()),
                    offset: normal(&mut random) * 1.5 * deviations,
                },
                bend: Symmetric {
                    diagonal: squares,
                    across: vector(&mut random) * if round % 4 == 2 { 0.0 } else { 0.2 },
                }
                .scaled(bend),
            };
            let sign = if surface.half_space.offset < 0.0 {
                -1.0
            } else {
                1.0
            };
            let crosses = least(&surface, deviations, sign, &mut random) < 0.0;
            match gaussian_side(&surface, deviations) {
                Side::Cutoff => {
                    cut += 1;
                    truly_cut += u32::from(crosses);
                }
                side => {
                    assert!(!crosses, "{side:?} of {surface:?} at {deviations}");
                    assert_eq!(side == Side::Visible, sign > 0.0);
                }
            }
        }
        assert!(
            truly_cut > 1_000 && f64::from(cut) < 1.05 * f64::from(truly_cut),
            "{cut} {truly_cut}"
        );
    }

    /// Its matrix has no full rank, and rounding once made a bound of nothing. A tenth of the ball's surface is inside.
    #[test]
    fn a_cylinder_that_cuts_a_disc_from_its_side_is_not_beside_it() {
        let mut scene = rara_scene::Gaussians::default();
        let position = glam::Vec3::new(0.217_865_85, -0.212_699_22, 0.132_254_32);
        let scale = glam::Vec3::new(0.046_538_69, 0.081_522_67, 0.004_208_966);
        let turn = glam::Quat::from_xyzw(0.208_751_35, -0.504_046_74, 0.813_969_3, -0.199_534_07);
        scene.push(position, scale, turn, 0.919_330_36, &[0.0; 3]);
        let (from, to) = (DVec3::new(-0.4, -0.3, 0.0), DVec3::new(0.5, 0.4, 0.2));
        let quadric = Quadric::cylinder(from, to, 0.3).unwrap();
        let axes = crate::footprint::half_axes::<f64>(scene.scales()[0], scene.rotations()[0]);
        let surface = quadric.unit_surface(&Ellipsoid::new(&scene, 0, axes));
        let deviations = (2.0 * (255.0 * 0.919_330_36_f64).ln()).sqrt();
        assert_eq!(gaussian_side(&surface, deviations), Side::Cutoff);
    }

    #[test]
    fn boxes_have_a_side_only_where_their_points_do() {
        let mut random = Random::new(7);
        let mut settled = 0;
        for _ in 0..2_000 {
            let v = |random: &mut Random| DVec3::from_array([(); 3].map(|()| normal(random)));
            let (from, to) = (v(&mut random), v(&mut random));
            let quadric = match random.unit() {
                x if x < 0.5 => Quadric::sphere(from, 0.5 + random.unit()),
                x if x < 0.8 => Quadric::cylinder(from, to, 0.5 + random.unit()),
                _ => Quadric::cone(from, to, 0.5 + random.unit()),
            };
            let quadric = quadric.unwrap();
            let (middle, half) = (v(&mut random), v(&mut random).abs() * 0.3);
            let side = quadric.box_side(middle, half, 0.05);
            settled += u32::from(side != Side::Cutoff);
            for _ in 0..50 {
                let at = DVec3::from_array([(); 3].map(|()| 2.0 * random.unit() - 1.0));
                let value = quadric.distance(middle + at * (half + 0.028));
                assert!(side != Side::Visible || value > 0.0);
                assert!(side != Side::Invisible || value < 0.0);
            }
        }
        assert!(settled > 500, "{settled}: boxes would be of no use");
    }
}
