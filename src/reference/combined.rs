//! The weight of a splat that surfaces cut which bend, or that combine in some other way than a list of planes does.

use super::chord::missed_share;
use super::exact::tail_ratio;
use super::footprint::Gradients;
use super::real::{Real, Vec3};
use super::region::{Combination, HalfSpace, Sight, Symmetric, UnitSurface};
use rara_scene::settings::Miss;

/// A cut splat and its surfaces.
#[derive(Debug, Clone)]
pub struct CombinedCut<T> {
    /// Image derivatives at the splat's centre.
    pub gradients: Gradients<T>,
    /// By how much they change a pixel, `m3 / Z`; nothing where the weight is that of the footprint.
    pub lean: Vec3<T>,
    /// The surfaces, and how they combine.
    pub surfaces: Combination<T>,
    /// The half-space in front of the eye, where that counts.
    pub front: Option<HalfSpace<T>>,
    /// The radius of the ellipsoid that mode `rara` traces, and what a pixel keeps whose ray misses it.
    pub chord: Option<(T, Miss)>,
}

impl<T: Real> CombinedCut<T> {
    /// The visible share at an offset from the splat's centre, pixels.
    pub fn weight(&self, dx: T, dy: T) -> T {
        let [b1, b2] = self.gradients.b;
        let b = [b1 - self.lean * dx, b2 - self.lean * dy];
        if let Some((sigma, miss)) = self.chord {
            return self.chord_share(b, [dx, dy], sigma, miss);
        }
        let gradients = Gradients {
            b,
            ..self.gradients
        };
        let sight = Sight::new(gradients, [dx, dy]);
        let (Some(half_space), Some(front)) = (self.front, self.front_of(&sight)) else {
            return self.surfaces.share(&sight);
        };
        // The eye is at -front on lines across its plane, and what is beyond t is this share of what is beyond the eye.
        let beyond = |t: T| tail_ratio(-t, front);
        let ends = (-front, T::infinity());
        let kept = |low, high| beyond(low) - beyond(high);
        let surfaces = &self.surfaces;
        let share = surfaces.measure_across(&sight, half_space.normal, ends, &kept);
        share.max(T::zero()).min(T::one())
    }

    fn front_of(&self, sight: &Sight<T>) -> Option<T> {
        self.front.map(|half_space| {
            let plane = UnitSurface {
                half_space,
                bend: Symmetric::zero(),
            };
            sight.plane_z(&plane.scaled())
        })
    }

    /// The share of the chord that is kept (the paper, section 3.4).
    fn chord_share(&self, gradients: [Vec3<T>; 2], delta: [T; 2], sigma: T, miss: Miss) -> T {
        let Some(sight) = Sight::unfiltered(gradients, delta) else {
            // A needle or a point has no chord, and its centre is as dense as any.
            let is_kept = self.surfaces.keeps(Vec3::zero());
            return missed_share(miss, is_kept);
        };
        let squared = sigma * sigma - sight.mean.squared();
        let half = squared.max(T::zero()).sqrt();
        let start = self
            .front_of(&sight)
            .map_or(-half, |front| (-front).max(-half));
        let whole = half - start;
        if !(squared > T::zero() && whole > T::zero()) {
            return missed_share(miss, self.surfaces.keeps(sight.mean));
        }
        let kept =
            self.surfaces
                .measure_line((sight.mean, sight.line()), (start, half), &|low, high| {
                    high - low
                });
        (kept / whole).max(T::zero()).min(T::one())
    }
}
