//! Stage `clip` finds the side of each Gaussian, whatever the camera sees of it (the paper, section 3.2).
//!
//! Perspective widens the band of splats that follow each pixel's true ray, by how much depends on the camera. Stage
//! [`classify`](super::classify) asks the same question again for those.

use super::footprint::half_axes;
use super::real::Real;
use super::region::{Ellipsoid, Side, gaussian_side};
use rara_base::limits::ALPHA_MIN_INVERSE;
use rara_scene::Gaussians;
use rara_scene::clip::Clip;
use rara_scene::settings::{Mode, Settings};

/// The side of every Gaussian of the scene; none is [`Side::Culled`].
pub fn clip<T: Real>(scene: &Gaussians, clip: &Clip, settings: &Settings) -> Vec<Side> {
    let side = |index: usize| {
        let axes = half_axes(scene.scales()[index], scene.rotations()[index]);
        let ellipsoid = Ellipsoid::new(scene, index, axes);
        let brightness = T::of(f64::from(scene.opacities()[index]) * f64::from(ALPHA_MIN_INVERSE));
        let reach = (T::of(2.0) * brightness.ln()).max(T::zero()).sqrt();
        gaussian_side(&ellipsoid, band(reach, settings), clip, settings)
    };
    (0..scene.len()).map(side).collect()
}

/// Half width of the band in which a surface cuts, standard deviations. The paper's chord can be longer than the
/// visible footprint; a splat is then cut as soon as its traced ellipsoid is.
pub(super) fn band<T: Real>(reach: T, settings: &Settings) -> T {
    match settings.mode {
        Mode::Rara => reach.max(T::of(f64::from(settings.sigma))),
        Mode::None | Mode::Hard | Mode::Exact => reach,
    }
}
