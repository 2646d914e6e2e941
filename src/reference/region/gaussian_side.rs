//! On which side of the region a Gaussian is (the paper, section 3.2).

use super::sides::combined;
use super::{Side, UnitPlane};
use crate::reference::real::{Real, Vec3};
use crate::{Clip, Gaussians, Mode, Settings, Surface};

/// The side of Gaussian `index`, whose half axes these are and whose band reaches so many standard deviations. None is
/// [`Side::Culled`].
pub fn gaussian_side<T: Real>(
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
    deviations: T,
    clip: &Clip,
    settings: &Settings,
) -> Side {
    if clip.surfaces.is_empty() || settings.mode == Mode::None {
        return Side::Visible;
    }
    let of_plane = |plane| UnitPlane::new(scene, index, axes, &plane);
    let planes = clip.surfaces.iter().filter_map(Surface::as_plane);
    let planes = planes.map(of_plane);
    combined(
        clip.op,
        planes.map(|plane| plane.gaussian_side(deviations, settings)),
    )
}
