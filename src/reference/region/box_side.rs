//! On which side of the region all Gaussians are whose centres lie in a box.

use glam::DVec3;

use super::Side;
use super::sides::combined;
use super::surface::surface_box_side;
use rara_scene::clip::Clip;
use rara_scene::settings::{Mode, Settings};

/// Gaussians whose centres lie in a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The box's middle, the layer's units.
    pub middle: DVec3,
    /// Half its sides, the layer's units.
    pub half: DVec3,
    /// The farthest that the contour of 1/255 of one lies from its centre, the layer's units.
    pub reach: f64,
    /// The largest standard deviation of one, the layer's units.
    pub sigma: f64,
}

/// The side that all of them have; [`Side::Cutoff`] where they may differ. It is conservative: a box has a side only where
/// each Gaussian alone has it.
pub fn box_side(bounds: &Bounds, clip: &Clip, settings: &Settings) -> Side {
    if clip.is_everything() || settings.mode == Mode::None {
        return Side::Visible;
    }
    if settings.trace_all && settings.mode != Mode::Hard {
        return Side::Cutoff;
    }
    let support = match settings.mode {
        Mode::Hard | Mode::None => 0.0,
        Mode::Rara => bounds.reach.max(f64::from(settings.sigma) * bounds.sigma),
        Mode::Exact => bounds.reach,
    };
    combined(clip, &|surface| {
        surface_box_side(surface, bounds.middle, bounds.half, support)
    })
}
