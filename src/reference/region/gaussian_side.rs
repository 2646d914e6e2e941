//! On which side of the region a Gaussian is (the paper, section 3.2).

use super::Side;
use super::sides::combined;
use super::surface::surface_gaussian_side;
use crate::real::{Real, Vec3};
use rara_scene::Gaussians;
use rara_scene::clip::Clip;
use rara_scene::settings::{Mode, Settings};

/// The side of Gaussian `index`, which has the half axes `axes` and a band of `deviations` standard deviations. It is never
/// [`Side::Culled`].
pub fn gaussian_side<T: Real>(
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
    deviations: T,
    clip: &Clip,
    settings: &Settings,
) -> Side {
    if clip.is_everything() || settings.mode == Mode::None {
        return Side::Visible;
    }
    combined(clip, &|surface| {
        surface_gaussian_side(surface, scene, index, axes, deviations, settings)
    })
}
