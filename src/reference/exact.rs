//! The weight of mode `exact`: the visible share of a cut Gaussian in a pixel, low-pass included.
//!
//! Seen from a Gaussian's unit space (u ~ N(0, I)), a pixel at offset delta from the splat's centre is an observation
//! of two linear functions of u: `(b1 . u, b2 . u) = delta + noise`, where the noise is the low-pass that 3DGS adds
//! to each footprint. The evidence of that observation is the footprint `exp(-q / 2)` itself, and given it, the
//! function `g + a . u` of a half-space is again a normal variable. Its mean is affine in delta and its variance does not
//! depend on delta: conditioning a Gaussian on a linear observation (the update of a Kalman filter). The share of
//! the splat on the visible side is therefore `Phi(mean / deviation)`, and alpha times that share is what EWA
//! splatting (the paper's equation 9) makes of the truncated Gaussian, filtered like every other splat.

use super::footprint::{Footprint, Gradients, determinant, scaled};
use super::real::{Real, Vec3};
use super::region::{HalfSpace, share};
use super::threshold::{Direction, Threshold};
use super::view::ViewTransform;
use rara_scene::clip::ClipOp;

/// The function of a half-space given a pixel: normal with mean `mean[0] + mean[1] dx + mean[2] dy`.
#[derive(Debug, Clone, Copy)]
struct Conditional<T> {
    mean: [T; 3],
    deviation: T,
    far: bool,
    direction: Direction<T>,
}

/// Conditions the function of a half-space on a pixel whose image derivatives are b1 and b2.
///
/// With `c = b1 x b2` (the ray's direction in unit space) and L the low-pass, the textbook expressions
/// `k = Sigma'^-1 B a` and `s^2 = |a|^2 - (B a)^T Sigma'^-1 (B a)` become sums of terms that do not cancel:
/// `s^2 det = (a . c)^2 + L (|a x b1|^2 + |a x b2|^2) + L^2 |a|^2`, which keeps needles and grazing planes accurate in
/// single precision.
fn condition<T: Real>(gradients: Gradients<T>, half_space: &HalfSpace<T>) -> Conditional<T> {
    let largest = half_space.normal.largest();
    let unit = if largest > T::zero() {
        T::one() / largest
    } else {
        T::one()
    };
    let (a, g) = (half_space.normal * unit, half_space.offset * unit);
    let ([b1, b2], factor, low_pass) = scaled(gradients);
    let c = b1.cross(b2);
    let det = determinant([b1, b2], c, low_pass);
    let (ab1, ab2) = (a.cross(b1), a.cross(b2));
    let spread = low_pass.sqrt();
    let direction = Direction {
        along: a.dot(c),
        across: [ab1 * spread, ab2 * spread, a * low_pass],
    };
    let variance = direction.squared();
    let kx = c.dot(ab2) + low_pass * a.dot(b1);
    let ky = low_pass * a.dot(b2) - c.dot(ab1);
    Conditional {
        mean: [g, kx * factor / det, ky * factor / det],
        deviation: (variance / det).sqrt(),
        far: keeps_far(direction.along, a),
        direction: if variance > T::zero() {
            direction * (T::one() / variance.sqrt())
        } else {
            direction
        },
    }
}

/// True when a half-space keeps the farther side of a ray, from `along = a . c`.
///
/// c points away from the eye: the depth changes along it by `m3 . c = fx fy / Z^2 det(M)`, which is not negative for
/// a rotation and scales that are not negative. Flat Gaussians have `a . c = 0` for every half-space: any rule
/// will do then that gives opposite answers for one and its complement.
fn keeps_far<T: Real>(along: T, a: Vec3<T>) -> bool {
    let signs = [along, a.x, a.y, a.z];
    signs
        .iter()
        .find(|&&v| v != T::zero())
        .is_none_or(|&v| v > T::zero())
}

/// A half-space that a surface keeps of a cut splat, in the affine form: `w = Phi(z[0] + z[1] dx + z[2] dy)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AffinePlane<T> {
    /// Coefficients of the argument; dx and dy in pixels from the splat's centre.
    pub z: [T; 3],
    /// True when the visible side is the farther one.
    pub far: bool,
    /// The direction that correlates it with others.
    pub direction: Direction<T>,
}

impl<T: Real> AffinePlane<T> {
    /// The form for a half-space and the footprint's own image derivatives.
    pub fn new(gradients: Gradients<T>, half_space: &HalfSpace<T>) -> Self {
        let Conditional {
            mean,
            deviation,
            far,
            direction,
        } = condition(gradients, half_space);
        // Without a deviation the Gaussian is a point, wholly on one side (the boundary itself is visible).
        let z = if deviation > T::zero() {
            mean.map(|m| m / deviation)
        } else if mean[0] >= T::zero() {
            [T::infinity(), T::zero(), T::zero()]
        } else {
            [T::neg_infinity(), T::zero(), T::zero()]
        };
        Self { z, far, direction }
    }

    /// The threshold at an offset from the splat's centre, pixels.
    pub fn threshold(&self, dx: T, dy: T) -> Threshold<T> {
        let [z0, zx, zy] = self.z;
        Threshold {
            z: z0 + zx * dx + zy * dy,
            far: self.far,
            direction: self.direction,
        }
    }
}

/// A cut splat in the perspective form.
///
/// A pixel's ray is the intersection of two planes through the eye: `fx (X + m1 . u) = px (Z + m3 . u)` with px
/// counted from the principal point, and the same for y. Divided by Z these read `(b1 - dx e) . u = dx` and
/// `(b2 - dy e) . u = dy` with `e = m3 / Z`. So the affine form becomes exact for every size of splat by taking those
/// derivatives, per pixel, with b1 and b2 at the centre's true direction. In an orthographic view e is zero, and the affine
/// form is exact itself.
#[derive(Debug, Clone)]
pub struct Beam<T> {
    /// Image derivatives at the centre's true direction.
    pub gradients: Gradients<T>,
    /// The lean `e = m3 / Z`.
    pub lean: Vec3<T>,
    /// The half-spaces that the surfaces keep of the splat that they cut.
    pub half_spaces: Vec<HalfSpace<T>>,
    pub op: ClipOp,
    /// The half-space in front of the eye, if the eye is within the splat.
    pub front: Option<HalfSpace<T>>,
}

impl<T: Real> Beam<T> {
    /// The form for a splat and the half-spaces that surfaces keep of it.
    pub fn new(
        footprint: &Footprint<T>,
        view: &ViewTransform<T>,
        half_spaces: Vec<HalfSpace<T>>,
        op: ClipOp,
    ) -> Self {
        Self {
            gradients: footprint.true_gradients(view),
            lean: footprint.lean(),
            half_spaces,
            op,
            front: footprint.holds_the_eye().then_some(HalfSpace {
                normal: footprint.rows[2],
                offset: footprint.view_centre.z,
            }),
        }
    }

    /// The visible share at an offset from the splat's centre, pixels.
    pub fn weight(&self, dx: T, dy: T) -> T {
        let [b1, b2] = self.gradients.b;
        let ray = Gradients {
            b: [b1 - self.lean * dx, b2 - self.lean * dy],
            ..self.gradients
        };
        let threshold =
            |half_space: &HalfSpace<T>| AffinePlane::new(ray, half_space).threshold(dx, dy);
        let thresholds = self.half_spaces.iter().map(threshold);
        match &self.front {
            Some(front) => in_front(self.op, thresholds, threshold(front).z),
            None => share(self.op, thresholds),
        }
    }
}

/// The [`share`] where the eye is within the splat: of the part in front of the eye, beyond `front` on the ray, how much
/// is kept.
///
/// Such a splat is so large that the low-pass is nothing. On one ray every plane is a threshold in the same normal
/// variable: far planes keep what lies beyond theirs, near ones what lies before. Only the strictest of each kind matters,
/// and the eye is one more far threshold.
fn in_front<T: Real>(op: ClipOp, planes: impl Iterator<Item = Threshold<T>>, front: T) -> T {
    let (zero, one) = (T::zero(), T::one());
    let of = |planes: &mut dyn Iterator<Item = Threshold<T>>| {
        let (mut far, mut gone) = (one, zero);
        for plane in planes {
            if plane.far {
                far = far.min(tail_ratio(plane.z, front));
            } else {
                gone = gone.max(tail_ratio(-plane.z, front));
            }
        }
        (far - gone).max(zero)
    };
    match op {
        ClipOp::And => of(&mut { planes }),
        ClipOp::Or => one - of(&mut planes.map(Threshold::complement)),
    }
}

/// `Phi(z) / Phi(front)`, at most 1, however little of the normal distribution is left.
pub(super) fn tail_ratio<T: Real>(z: T, front: T) -> T {
    if z >= front {
        return T::one();
    }
    let (z, front) = (z.wide(), front.wide());
    T::of(if front > -30.0 {
        z.phi() / front.phi()
    } else {
        // Mills's ratio, of which the next term is 3 / x^4.
        let mills = |x: f64| (1.0 - 1.0 / (x * x)) / x;
        (0.5 * (front - z) * (front + z)).exp() * mills(-z) / mills(-front)
    })
}
