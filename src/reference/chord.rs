//! The weight of mode `rara`: the paper's length ratio along a pixel's ray (section 3.4 and Algorithm 1).
//!
//! The paper solves a quadratic for the ray's intersections with the ellipsoid, which loses every digit for needles in
//! single precision. The same chord follows from the two planes through the eye that meet in the ray: in unit space
//! they are `b1' . u = dx` and `b2' . u = dy` (see [`Beam`](super::exact::Beam)), so the ray runs along
//! `c = b1' x b2'`, its densest point (nearest to the centre) is `u* = p x c / |c|^2` with `p = dx b2' - dy b1'`, and
//! `|u*| = |p| / |c|`. Where the paper leaves a case open, the reading is the limit of the length ratio.

use super::real::{Real, Vec3};
use super::region::{HalfSpace, keeps};
use rara_scene::clip::ClipOp;
use rara_scene::settings::Miss;

/// A cut splat traced by mode `rara`.
#[derive(Debug, Clone)]
pub struct Chord<T> {
    /// Image derivatives at the centre's true direction, pixels.
    pub gradients: [Vec3<T>; 2],
    /// The lean e: zero in an orthographic view.
    pub lean: Vec3<T>,
    /// The half-space in front of the eye; none in an orthographic view.
    pub front: Option<HalfSpace<T>>,
    /// The half-spaces that the surfaces keep of the splat that they cut.
    pub half_spaces: Vec<HalfSpace<T>>,
    pub op: ClipOp,
    /// Radius of the traced ellipsoid, standard deviations.
    pub sigma: T,
    /// How much a pixel keeps whose ray misses it.
    pub miss: Miss,
}

/// The function of a half-space on the ray: `at_peak + slope tau`, tau counted from the densest point.
struct OnRay<T> {
    at_peak: T,
    slope: T,
}

impl<T: Real> Chord<T> {
    /// The visible share of the chord at an offset from the splat's centre, pixels.
    pub fn weight(&self, dx: T, dy: T) -> T {
        let [b1, b2] = self.gradients;
        let (b1, b2) = (b1 - self.lean * dx, b2 - self.lean * dy);
        let largest = b1.largest().max(b2.largest());
        let factor = if largest > T::zero() {
            T::one() / largest
        } else {
            T::one()
        };
        let (b1, b2, dx, dy) = (b1 * factor, b2 * factor, dx * factor, dy * factor);

        let c = b1.cross(b2);
        let length = c.length();
        if length <= T::zero() {
            return self.missed(Vec3::zero()); // a needle or a point: no chord, and the centre is as dense as any
        }
        let direction = c * (T::one() / length);
        let p = (b2 * dx - b1 * dy) * (T::one() / length);
        let peak = p.cross(direction);
        let squared = self.sigma * self.sigma - p.squared();
        if squared <= T::zero() {
            return self.missed(peak);
        }

        let half = squared.sqrt();
        let on_ray = |half_space: &HalfSpace<T>| OnRay {
            at_peak: half_space.distance(peak),
            slope: half_space.normal.dot(direction),
        };
        let chord = (-half, half);
        let front = self.front.as_ref().map(on_ray);
        let (start, end) = front.map_or(chord, |front| front.visible(chord));
        let whole = end - start;
        if whole <= T::zero() {
            return self.missed(peak);
        }
        let on_rays = self.half_spaces.iter().map(on_ray);
        let part = |(start, end): (T, T)| ((end - start) / whole).max(T::zero());
        match self.op {
            ClipOp::And => part(on_rays.fold((start, end), |part, one| one.visible(part))),
            // A union leaves out what all of them leave out.
            ClipOp::Or => {
                T::one() - part(on_rays.fold((start, end), |part, one| one.invisible(part)))
            }
        }
    }

    /// The share of a pixel whose ray has no chord in front of the eye.
    fn missed(&self, peak: Vec3<T>) -> T {
        let kept = self
            .half_spaces
            .iter()
            .map(|h| h.distance(peak) >= T::zero());
        missed_share(self.miss, keeps(self.op, kept))
    }
}

/// The share of a pixel whose ray has no chord, by whether the region keeps the ray's densest point.
pub(super) fn missed_share<T: Real>(miss: Miss, keeps_peak: bool) -> T {
    let is_kept = match miss {
        Miss::Keep => true,
        Miss::Drop => false,
        Miss::Peak => keeps_peak,
    };
    if is_kept { T::one() } else { T::zero() }
}

impl<T: Real> OnRay<T> {
    /// The part of an interval on which the function is not negative.
    fn visible(&self, (start, end): (T, T)) -> (T, T) {
        let root = -self.at_peak / self.slope;
        if self.slope > T::zero() {
            (start.max(root), end)
        } else if self.slope < T::zero() {
            (start, end.min(root))
        } else if self.at_peak >= T::zero() {
            (start, end)
        } else {
            (end, end)
        }
    }

    /// The part of an interval on which it is negative.
    fn invisible(&self, (start, end): (T, T)) -> (T, T) {
        let root = -self.at_peak / self.slope;
        if self.slope > T::zero() {
            (start, end.min(root))
        } else if self.slope < T::zero() {
            (start.max(root), end)
        } else if self.at_peak < T::zero() {
            (start, end)
        } else {
            (end, end)
        }
    }
}
