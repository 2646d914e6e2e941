//! One Gaussian seen by the camera: the EWA footprint of 3D Gaussian Splatting, and whether it is in view.
//!
//! A point of the Gaussian is `x = mu + M u` with `u ~ N(0, I)` and `M = R(q) S` (the paper, section 3.3: the map
//! from the unit sphere to the ellipsoid). To first order, u moves the point's image by `(b1 . u, b2 . u)` pixels,
//! where b1 and b2 are the rows of J W M in the paper's equation 9. 3DGS widens that image by a Gaussian of
//! a [low-pass](Gaussians::low_pass) of L px^2, so the footprint's covariance is `B B^T + L I`.
//!
//! Pixels are `f X / w + c`, with the homogeneous coordinate w: the depth Z in perspective, and 1 in an orthographic view.
//! By u, w changes by m3 or not at all, and `b = f / w (m - X / w dw/du)` holds for both.

use glam::{Quat, Vec3 as Point};

use super::real::{Real, Vec3, vec3};
use super::view::ViewTransform;
use rara_base::limits::{ALPHA_MIN_INVERSE, COMPENSATION_SQUARE_MIN, THINNEST};
use rara_scene::Gaussians;
use rara_scene::camera::Projection;

/// How a splat's image moves by u, b1 and b2, pixels, and by how much the low-pass widens it, px^2.
#[derive(Debug, Clone, Copy)]
pub struct Gradients<T> {
    pub b: [Vec3<T>; 2],
    pub low_pass: T,
}

/// A Gaussian in view, from which every later stage computes.
#[derive(Debug, Clone, Copy)]
pub struct Footprint<T> {
    /// Columns of M: the Gaussian's half axes in its layer, one standard deviation long.
    pub axes: [Vec3<T>; 3],
    /// Rows of M in camera axes, m1, m2 and m3: the derivatives of the point's X, Y and Z by u, scene units.
    pub rows: [Vec3<T>; 3],
    /// The centre relative to the eye, the layer's axes and units.
    pub relative: Vec3<T>,
    /// The centre in camera axes (X, Y, Z), scene units.
    pub view_centre: Vec3<T>,
    /// Units of the scene in one of the layer's.
    pub unit: T,
    pub projection: Projection,
    /// Image derivatives of the footprint, evaluated at the clamped direction.
    pub gradients: Gradients<T>,
    /// True when that direction was clamped.
    pub clamped: bool,
    /// How much farther from the centre, in deviations, a pixel can be by the true direction than by the clamped one: at
    /// least 1, and 1 where nothing was clamped.
    pub stretch: T,
    /// The centre on the screen (not clamped), pixels.
    pub screen_centre: [T; 2],
    /// The Cholesky factor k0, k1, k2 of the footprint's inverse covariance, 1/pixels: see [`power`](Self::power).
    pub conic: [T; 3],
    /// Opacity at the centre, 0 to 1; of antialiased Gaussians as much as makes up for the low-pass.
    pub opacity: T,
    /// K: the standard deviations out to which the splat counts, `opacity exp(-K^2 / 2) = 1/255`.
    pub extent: T,
    /// The same with the Gaussian's own opacity, which decides what cuts it. It is `extent` where nothing makes up for the
    /// low-pass, and no less.
    pub reach: T,
    /// Half the sides of the footprint's box, pixels.
    pub half_sides: [T; 2],
}

impl<T: Real> Footprint<T> {
    /// The footprint of one Gaussian, or nothing if it is culled: it is nearer than the [near cut](super::view::ViewTransform::near_cut) or behind the eye, or
    /// fainter than 1/255 even at its centre, or its box holds no pixel centre of the picture.
    ///
    /// The opacity of an antialiased one is multiplied by the root of `det B B^T / det (B B^T + L I)`: then the
    /// footprint that the low-pass has made larger has as much light in it as the one without (the 2D Mip filter of
    /// Yu et al. 2024). Trainers bound the ratio from below ([`COMPENSATION_SQUARE_MIN`]).
    pub fn new(scene: &Gaussians, index: usize, view: &ViewTransform<T>) -> Option<Self> {
        let relative = view.relative(scene.positions()[index]);
        let view_centre = view.turn(relative);
        let whole = T::of(f64::from(scene.opacities()[index]));
        let brightness = |opacity: T| opacity * T::of(f64::from(ALPHA_MIN_INVERSE));
        if !(view_centre.z >= view.near_cut && brightness(whole) >= T::one()) {
            return None;
        }

        let axes = half_axes(scene.scales()[index], scene.rotations()[index]);
        let rows = view
            .rows
            .map(|row| vec3(row.dot(axes[0]), row.dot(axes[1]), row.dot(axes[2])));
        let seen = ProjectedCentre::new(view.projection, &rows, view_centre);
        let slopes = seen.slopes;
        let clamp = |axis: usize| {
            slopes[axis]
                .max(view.slope_min[axis])
                .min(view.slope_max[axis])
        };
        let clamped = [clamp(0), clamp(1)];
        let low_pass = T::of(f64::from(scene.low_pass()));
        let seen_at = |slopes| Gradients {
            b: seen.gradients(view.focal, slopes),
            low_pass,
        };
        let gradients = seen_at(clamped);
        let (conic, deviations) = factorise(gradients);

        let opacity = match scene.is_antialiased() {
            true => whole * compensation(gradients),
            false => whole,
        };
        if brightness(opacity) < T::one() {
            return None;
        }
        let contour = |opacity: T| (T::of(2.0) * brightness(opacity).ln()).sqrt();
        let extent = contour(opacity);
        let footprint = Self {
            axes,
            rows,
            relative,
            view_centre,
            unit: view.unit,
            projection: view.projection,
            gradients,
            clamped: clamped != slopes,
            stretch: if clamped == slopes {
                T::one()
            } else {
                stretch(gradients, seen_at(slopes).b)
            },
            screen_centre: [0, 1]
                .map(|axis| view.focal[axis] * slopes[axis] + view.principal[axis]),
            conic,
            opacity,
            extent,
            reach: contour(whole),
            half_sides: deviations.map(|deviation| extent * deviation),
        };
        let holds_a_pixel =
            (0..2).all(|axis| footprint.span(axis, view.size[axis], T::zero()).is_some());
        let drawable = conic.iter().all(|k| k.is_finite()); // f32 only: deviations beyond its range
        (holds_a_pixel && drawable).then_some(footprint)
    }

    /// Image derivatives at the centre's true direction, for computations along true rays.
    pub fn true_gradients(&self, view: &ViewTransform<T>) -> Gradients<T> {
        let seen = self.seen();
        Gradients {
            b: seen.gradients(view.focal, seen.slopes),
            ..self.gradients
        }
    }

    /// The lean e, by how much the lines of sight of a pixel to the right and of a pixel below lean against the
    /// splat's own: `(b1 - dx e) . u = dx` and `(b2 - dy e) . u = dy` are those of the pixel at (dx, dy). It is
    /// `m3 / Z` in perspective and zero where all are parallel.
    pub fn lean(&self) -> Vec3<T> {
        let seen = self.seen();
        seen.w_gradient * (T::one() / seen.w)
    }

    /// True when the eye's plane reaches into the splat, whose part behind it must not count. Parallel lines of sight
    /// have no eye.
    pub fn holds_the_eye(&self) -> bool {
        self.projection == Projection::Perspective
            && self.view_centre.z < self.reach * self.rows[2].length()
    }

    fn seen(&self) -> ProjectedCentre<T> {
        ProjectedCentre::new(self.projection, &self.rows, self.view_centre)
    }

    /// The exponent q of the footprint `exp(-q / 2)` at an offset from its centre, pixels. It is a sum of two squares:
    /// the three coefficients of the inverse covariance would cancel for needles.
    pub fn power(&self, dx: T, dy: T) -> T {
        let [k0, k1, k2] = self.conic;
        let (u, v) = (k0 * dx, k1 * dx + k2 * dy);
        u * u + v * v
    }

    /// First and last pixel whose centres the box covers along an axis, widened by `padding` pixels.
    pub fn span(&self, axis: usize, size: u32, padding: T) -> Option<(u32, u32)> {
        let half = T::of(0.5);
        let (centre, half) = (
            self.screen_centre[axis] - half,
            self.half_sides[axis] + padding,
        );
        if !centre.is_finite() || half.is_nan() {
            return None;
        }
        let first = (centre - half).ceil().max(T::zero());
        let last = (centre + half).floor().min(T::of(f64::from(size) - 1.0));
        (first <= last).then(|| (first.wide() as u32, last.wide() as u32))
    }
}

/// The largest ratio of two covariances' deviations is at most the root of the trace of one by the other's inverse. The
/// trace is a sum of squares: `xx yy' - 2 xy xy' + yy xx'` would cancel for needles.
fn stretch<T: Real>(clamped: Gradients<T>, [c1, c2]: [Vec3<T>; 2]) -> T {
    let ([b1, b2], low_pass) = (clamped.b, clamped.low_pass);
    let lengths = c1.dot(c1) + c2.dot(c2);
    let across = c1.cross(c2);
    let determinant = across.dot(across) + low_pass * (lengths + low_pass);
    let apart = |u: T, v: T| {
        let difference = c2 * u + c1 * (T::zero() - v);
        difference.dot(difference)
    };
    let squares = apart(b1.x, b2.x) + apart(b1.y, b2.y) + apart(b1.z, b2.z);
    let rest = low_pass * (b1.dot(b1) + b2.dot(b2) + lengths + T::of(2.0) * low_pass);
    ((squares + rest) / determinant).sqrt().max(T::one())
}

/// Columns of R(q) S, with a thickness for discs.
pub fn half_axes<T: Real>(scale: Point, rotation: Quat) -> [Vec3<T>; 3] {
    let [x, y, z, w] = rotation.to_array().map(|v| T::of(f64::from(v)));
    let scale = scale.max(Point::splat(THINNEST * scale.max_element()));
    let [sx, sy, sz] = scale.to_array().map(|v| T::of(f64::from(v)));
    let (one, two) = (T::one(), T::of(2.0));
    [
        vec3(
            one - two * (y * y + z * z),
            two * (x * y + w * z),
            two * (x * z - w * y),
        ) * sx,
        vec3(
            two * (x * y - w * z),
            one - two * (x * x + z * z),
            two * (y * z + w * x),
        ) * sy,
        vec3(
            two * (x * z + w * y),
            two * (y * z - w * x),
            one - two * (x * x + y * y),
        ) * sz,
    ]
}

/// A centre in homogeneous coordinates, and how they change by u.
struct ProjectedCentre<T> {
    /// X / w and Y / w.
    slopes: [T; 2],
    w: T,
    /// m1 and m2.
    rows: [Vec3<T>; 2],
    w_gradient: Vec3<T>,
}

impl<T: Real> ProjectedCentre<T> {
    fn new(projection: Projection, &[m1, m2, m3]: &[Vec3<T>; 3], centre: Vec3<T>) -> Self {
        let (w, w_gradient) = match projection {
            Projection::Perspective => (centre.z, m3),
            Projection::Orthographic => (T::one(), Vec3::zero()),
        };
        Self {
            slopes: [centre.x / w, centre.y / w],
            w,
            rows: [m1, m2],
            w_gradient,
        }
    }

    /// Derivatives of the pixel position `f X / w` by u: `f / w (m - slope dw/du)`. In an orthographic view
    /// they are `f m`, whatever the slope.
    fn gradients(&self, focal: [T; 2], slopes: [T; 2]) -> [Vec3<T>; 2] {
        [0, 1]
            .map(|axis| (self.rows[axis] - self.w_gradient * slopes[axis]) * (focal[axis] / self.w))
    }
}

/// Scales image derivatives and low-pass together so that their products stay in single precision's range; returns
/// the scaled derivatives, the factor (also that of pixel offsets) and the scaled low-pass.
pub(super) fn scaled<T: Real>(gradients: Gradients<T>) -> ([Vec3<T>; 2], T, T) {
    let [b1, b2] = gradients.b;
    let factor = T::one() / T::one().max(b1.largest()).max(b2.largest());
    let low_pass = gradients.low_pass * factor * factor;
    ([b1 * factor, b2 * factor], factor, low_pass)
}

/// Determinant of the footprint's covariance: `|b1|^2 |b2|^2 - (b1 . b2)^2` and the low-pass, written with the cross
/// product `c = b1 x b2` as a sum of terms that are not negative.
pub(super) fn determinant<T: Real>([b1, b2]: [Vec3<T>; 2], c: Vec3<T>, low_pass: T) -> T {
    c.squared() + low_pass * (b1.squared() + b2.squared()) + low_pass * low_pass
}

/// What keeps the light of a footprint as it is without the low-pass.
fn compensation<T: Real>(gradients: Gradients<T>) -> T {
    let ([b1, b2], _, low_pass) = scaled(gradients);
    let across = b1.cross(b2);
    let share = across.squared() / determinant([b1, b2], across, low_pass);
    share.max(T::of(f64::from(COMPENSATION_SQUARE_MIN))).sqrt()
}

/// The conic, the factors of `q = (k0 dx)^2 + (k1 dx + k2 dy)^2`, and the standard deviations along x and y, pixels.
fn factorise<T: Real>(gradients: Gradients<T>) -> ([T; 3], [T; 2]) {
    let ([b1, b2], factor, low_pass) = scaled(gradients);
    let (xx, yy) = (b1.squared() + low_pass, b2.squared() + low_pass);
    let deviation = determinant([b1, b2], b1.cross(b2), low_pass).sqrt();
    let sx = xx.sqrt();
    // q = dx^2 / xx + (dy - xy/xx dx)^2 xx/det: the marginal of x, then y given x.
    let k2 = sx / deviation;
    let conic = [T::one() / sx, -(b1.dot(b2) / xx) * k2, k2];
    (conic.map(|k| k * factor), [sx / factor, yy.sqrt() / factor])
}
