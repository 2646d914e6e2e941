//! On which side of the region a Gaussian is (the paper, section 3.2).

use super::sides::combined;
use super::surface::surface_gaussian_side;
use super::{Ellipsoid, Side};
use crate::real::Real;
use rara_scene::clip::Clip;
use rara_scene::settings::{Mode, Settings};

/// The side of a Gaussian that has a band of `deviations` standard deviations. It is never [`Side::Culled`].
pub fn gaussian_side<T: Real>(
    ellipsoid: &Ellipsoid<T>,
    deviations: T,
    clip: &Clip,
    settings: &Settings,
) -> Side {
    if clip.is_everything() || settings.mode == Mode::None {
        return Side::Visible;
    }
    combined(clip, &|surface| {
        surface_gaussian_side(surface, ellipsoid, deviations, settings)
    })
}
