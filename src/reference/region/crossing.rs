//! Where a surface that bends stands on a pixel's line of sight.
//!
//! Given the pixel, the point u of the Gaussian's unit space is a normal variable with mean m and covariance
//! `C = I - B^T S^-1 B` (see [`exact`](crate::exact)). A surface's function there is
//! `F(m + x) = F(m) + h . x + x . Q x`, with the gradient h at m. It varies most along the direction `w = C h / n`, with
//! `n^2 = h . C h`; along it, `x = tau w` with tau ~ N(0, 1), it is a quadratic function of tau, whose two crossings are
//! found exactly. In the other directions it varies to second order alone: its mean moves by what the trace of Q C has
//! beyond `w . Q w`. Without low-pass w is the line of sight itself, and all of this is exact; for a plane Q is zero, and it
//! is the plane's z.

use crate::footprint::{Gradients, determinant, scaled};
use crate::real::{Real, Vec3};
use crate::region::UnitSurface;
use crate::threshold::{Direction, PHI_ONE, Threshold};

/// Beyond this nothing is left of a splat, and no chord is as long.
pub(super) const FAR_AWAY: f64 = 40.0;
/// How much the mean may move by a surface's bend across `w`, in deviations, before the bend is integrated over.
const BENT: f64 = 0.05;

/// A pixel's line of sight in a Gaussian's unit space.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sight<T> {
    gradients: [Vec3<T>; 2],
    c: Vec3<T>,
    low_pass: T,
    det: T,
    /// The mean m, given the pixel.
    pub(crate) mean: Vec3<T>,
}

/// A surface on a line of sight: its nearest crossing, and the other one where it counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceCrossing<T> {
    /// The half-space that the surface keeps where it is crossed first.
    pub(super) first: Threshold<T>,
    /// The one where it is crossed again.
    pub(super) second: Option<Threshold<T>>,
    /// True when what is kept lies between the two, false when it lies outside.
    pub(super) between: bool,
    /// True when the surface is near and bends across the direction in which it varies most.
    pub(super) bends: bool,
}

impl<T: Real> Sight<T> {
    /// The line of sight at an offset from the splat's centre, pixels.
    pub(crate) fn new(gradients: Gradients<T>, delta: [T; 2]) -> Self {
        let (gradients, factor, low_pass) = scaled(gradients);
        Self::from_gradients(gradients, delta.map(|d| d * factor), low_pass)
    }

    /// The line itself without what the low-pass adds, and its point nearest the centre. Gaussians without thickness may
    /// have none.
    pub(crate) fn unfiltered(gradients: [Vec3<T>; 2], delta: [T; 2]) -> Option<Self> {
        let [b1, b2] = gradients;
        let largest = b1.largest().max(b2.largest()).max(T::of(1e-30));
        let factor = T::one() / largest;
        let gradients = [b1 * factor, b2 * factor];
        let is_line = gradients[0].cross(gradients[1]).squared() > T::zero();
        is_line.then(|| Self::from_gradients(gradients, delta.map(|d| d * factor), T::zero()))
    }

    fn from_gradients([b1, b2]: [Vec3<T>; 2], [dx, dy]: [T; 2], low_pass: T) -> Self {
        let c = b1.cross(b2);
        let det = determinant([b1, b2], c, low_pass);
        let (dx, dy) = (dx / det, dy / det);
        let along = b2.cross(c) * dx + c.cross(b1) * dy;
        Self {
            gradients: [b1, b2],
            c,
            low_pass,
            det,
            mean: along + (b1 * dx + b2 * dy) * low_pass,
        }
    }

    /// `C v`.
    fn spread(&self, v: Vec3<T>) -> Vec3<T> {
        let [b1, b2] = self.gradients;
        let across =
            v * (b1.squared() + b2.squared() + self.low_pass) - b1 * b1.dot(v) - b2 * b2.dot(v);
        (self.c * self.c.dot(v) + across * self.low_pass) * (T::one() / self.det)
    }

    /// The direction of the line, a unit vector.
    pub(crate) fn line(&self) -> Vec3<T> {
        self.c * (T::one() / self.c.length().max(T::of(1e-30)))
    }

    /// `a . C a`, as a sum of squares.
    fn variance(&self, a: Vec3<T>) -> T {
        let [b1, b2] = self.gradients;
        let across = a.cross(b1).squared() + a.cross(b2).squared() + self.low_pass * a.squared();
        let along = a.dot(self.c);
        (along * along + self.low_pass * across) / self.det
    }

    /// The trace of `Q C`.
    fn trace(&self, surface: &UnitSurface<T>) -> T {
        let [b1, b2] = self.gradients;
        let bend = &surface.bend;
        let size = b1.squared() + b2.squared() + self.low_pass;
        let across = bend.trace() * size - bend.form(b1) - bend.form(b2);
        (bend.form(self.c) + self.low_pass * across) / self.det
    }

    /// The mean of the Gaussian given the pixel.
    pub(super) fn mean(&self) -> Vec3<T> {
        self.mean
    }

    /// Its deviations along the line and in two directions across it, none of which depends on another.
    pub(super) fn deviations(&self) -> [Vec3<T>; 3] {
        let [b1, b2] = self.gradients;
        let wider = if b1.squared() < b2.squared() { b2 } else { b1 };
        let p = wider * (T::one() / wider.length().max(T::of(1e-30)));
        let q = self.line().cross(p);
        let covariance = |v: Vec3<T>| {
            let line = self.line();
            self.spread(v) - line * line.dot(v)
        };
        let root = |v: Vec3<T>| {
            let moved = covariance(v);
            let variance = v.dot(moved);
            match variance > T::zero() {
                true => (moved * (T::one() / variance.sqrt()), variance),
                false => (Vec3::zero(), T::one()),
            }
        };
        let (first, variance) = root(p);
        let (second, _) = root(q - p * (q.dot(covariance(p)) / variance));
        [self.line(), first, second]
    }

    /// The deviation of a function with this gradient, and the direction in which it varies most: the line of sight itself
    /// where it does not vary.
    fn steepest(&self, gradient: Vec3<T>) -> (T, Vec3<T>) {
        let n = self.variance(gradient).sqrt();
        let along = match n > T::zero() {
            true => self.spread(gradient) * (T::one() / n),
            false => self.line(),
        };
        (n, along)
    }

    fn threshold(&self, z: T, a: Vec3<T>) -> Threshold<T> {
        let [b1, b2] = self.gradients;
        let root = self.low_pass.sqrt();
        let direction = Direction {
            along: a.dot(self.c),
            across: [a.cross(b1) * root, a.cross(b2) * root, a * self.low_pass],
        };
        let size = direction.squared().sqrt();
        let signs = [direction.along, a.x, a.y, a.z];
        let first = signs.iter().find(|&&v| v != T::zero());
        Threshold {
            z,
            far: first.is_none_or(|&v| v > T::zero()),
            direction: if size > T::zero() {
                direction * (T::one() / size)
            } else {
                direction
            },
        }
    }

    /// The crossings of a surface.
    pub(super) fn crossed(&self, surface: &UnitSurface<T>) -> SurfaceCrossing<T> {
        let (value, gradient) = (surface.at(self.mean), surface.gradient(self.mean));
        let (n, along) = self.steepest(gradient);
        let bend = surface.bend.form(along);
        let shift = self.trace(surface) - bend;
        let value = value + shift;
        // A function's square has its value at PHI_ONE there, less 1.
        let squares = T::of(PHI_ONE * PHI_ONE - 1.0) * (bend.abs() + shift.abs());
        let is_near = (value + bend).abs() <= T::of(PHI_ONE) * n + squares;
        let bends = shift.abs() > T::of(BENT) * n && is_near;
        let (two, four) = (T::of(2.0), T::of(4.0));
        let square = n * n - four * bend * value;
        let far_away = T::of(FAR_AWAY).copysign(value);
        let alone = |z: T, gradient| SurfaceCrossing {
            first: self.threshold(z, gradient),
            second: None,
            between: true,
            bends,
        };
        let sum = n + square.max(T::zero()).sqrt();
        let is_crossed = square >= T::zero() && sum > T::zero();
        if !is_crossed {
            return alone(far_away, gradient);
        }
        let across = surface.bend.times(along) * two;
        let z = (two * value / sum)
            .max(T::of(-FAR_AWAY))
            .min(T::of(FAR_AWAY));
        // The second crossing is at tau = -sum / (2 bend), and z is tau there, whichever side it keeps.
        let first = self.threshold(z, gradient - across * z);
        let other = -sum / (two * bend);
        let is_near = other.abs() < T::of(FAR_AWAY);
        if !is_near {
            return SurfaceCrossing {
                first,
                second: None,
                between: true,
                bends,
            };
        }
        SurfaceCrossing {
            first,
            second: Some(self.threshold(other, gradient + across * other)),
            between: bend < T::zero(),
            bends,
        }
    }

    /// The share of the splat that a single surface keeps.
    pub(super) fn share(&self, surface: &UnitSurface<T>) -> T {
        let gradient = surface.gradient(self.mean);
        let (n, along) = self.steepest(gradient);
        let across = self.trace(surface) - surface.bend.form(along);
        if across.abs() > T::of(BENT) * n {
            return self.bent_share(surface, gradient);
        }
        self.crossed(surface).share()
    }

    /// A plane's z.
    pub(crate) fn plane_z(&self, plane: &UnitSurface<T>) -> T {
        let n = self.variance(plane.half_space.normal).sqrt();
        plane.half_space.distance(self.mean) / n.max(T::of(1e-30))
    }

    /// The same of a surface that bends across the direction in which it varies most: its function is taken as one of two
    /// variables, along the line of sight and across it, of which one is integrated over in closed form and the other by
    /// nodes.
    fn bent_share(&self, surface: &UnitSurface<T>, gradient: Vec3<T>) -> T {
        let length = self.c.length();
        let is_line = length > T::zero();
        if !is_line {
            return if surface.at(self.mean) >= T::zero() {
                T::one()
            } else {
                T::zero()
            };
        }
        let line = self.c * (T::one() / length);
        let slope = gradient.dot(line);
        let aside = self.spread(gradient) - line * slope;
        let lateral = gradient.dot(aside).max(T::zero()).sqrt();
        // Where nothing varies across the line, any direction across it will do.
        let aside = if lateral > T::of(1e-6) * gradient.length() {
            aside * (T::one() / lateral)
        } else {
            let [b1, b2] = self.gradients;
            let widest = if b1.squared() < b2.squared() { b1 } else { b2 };
            let aside = self.spread(widest) - line * widest.dot(line);
            aside * (T::one() / widest.dot(aside).max(T::of(1e-30)).sqrt())
        };
        let (a, e, g) = (
            surface.bend.form(line),
            T::of(2.0) * line.dot(surface.bend.times(aside)),
            surface.bend.form(aside),
        );
        let value = surface.at(self.mean) + self.trace(surface) - a - g;
        // Nodes go along the direction in which the function varies less.
        let along = slope * slope + T::of(2.0) * a * a;
        let across = lateral * lateral + T::of(2.0) * g * g;
        let (steep, bend, flat, flat_bend) = if along >= across {
            (slope, a, lateral, g)
        } else {
            (lateral, g, slope, a)
        };
        NODES.iter().fold(T::zero(), |sum, &(node, weight)| {
            let x = T::of(node);
            let at = value + x * (flat + x * flat_bend);
            sum + T::of(weight) * interval_share(at, steep + e * x, bend)
        })
    }
}

impl<T: Real> SurfaceCrossing<T> {
    /// The share that the surface keeps by itself.
    pub(super) fn share(&self) -> T {
        match self.second {
            None => self.first.z.phi(),
            Some(second) if self.between => (self.first.z.phi() - (-second.z).phi()).max(T::zero()),
            Some(second) => (self.first.z.phi() + second.z.phi()).min(T::one()),
        }
    }
}

/// Gauss and Hermite's nodes and weights for a normal variable.
const NODES: [(f64, f64); 7] = [
    (-3.750_439_717_725_742, 5.482_688_559_722_18e-4),
    (-2.366_759_410_734_541, 3.075_712_396_758_65e-2),
    (-1.154_405_394_739_968, 0.240_123_178_605_012_7),
    (0.0, 0.457_142_857_142_857_1),
    (1.154_405_394_739_968, 0.240_123_178_605_012_7),
    (2.366_759_410_734_541, 3.075_712_396_758_65e-2),
    (3.750_439_717_725_742, 5.482_688_559_722_18e-4),
];

/// The chance that `at + slope t + bend t^2` is positive for a normal t.
fn interval_share<T: Real>(at: T, slope: T, bend: T) -> T {
    let (zero, one, two) = (T::zero(), T::one(), T::of(2.0));
    let square = slope * slope - T::of(4.0) * bend * at;
    let sum = slope.abs() + square.max(zero).sqrt();
    let is_crossed = square >= zero && sum > zero;
    if !is_crossed {
        return if at >= zero { one } else { zero };
    }
    let near = (two * at / sum).phi();
    let other = -sum / (two * bend);
    let is_near = other.abs() < T::of(9.0);
    if !is_near {
        return near;
    }
    if bend < zero {
        (near - (-other).phi()).max(zero)
    } else {
        (near + other.phi()).min(one)
    }
}
