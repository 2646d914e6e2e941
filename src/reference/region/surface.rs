//! The questions that the stages ask of a surface. Each kind answers in a file of its own, as a [`RegionSurface`].

use glam::DVec3;

use super::region_surface::RegionSurface;
use super::{HalfSpace, Side, UnitSurface};
use crate::real::{Real, Vec3};
use rara_scene::Gaussians;
use rara_scene::clip::Surface;
use rara_scene::each_surface;
use rara_scene::settings::{Mode, Settings};

/// On which side of a surface Gaussian `index` is, which has the half axes `axes` and a band of `deviations` standard
/// deviations. A hard clip asks for the centre alone.
pub(crate) fn surface_gaussian_side<T: Real>(
    surface: &Surface,
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
    deviations: T,
    settings: &Settings,
) -> Side {
    if settings.mode == Mode::Hard {
        return match surface.distance(scene.positions()[index].as_dvec3()) >= 0.0 {
            true => Side::Visible,
            false => Side::Invisible,
        };
    }
    if settings.trace_all {
        return Side::Cutoff;
    }
    each_surface!(surface, surface => surface.gaussian_side(scene, index, axes, deviations))
}

/// On which side all Gaussians are whose centres lie in a box and that reach at most `support` from them, the layer's units.
pub(super) fn surface_box_side(
    surface: &Surface,
    middle: DVec3,
    half: DVec3,
    support: f64,
) -> Side {
    each_surface!(surface, surface => surface.box_side(middle, half, support))
}

/// A surface in the unit space of Gaussian `index`.
pub(crate) fn unit_surface<T: Real>(
    surface: &Surface,
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
) -> UnitSurface<T> {
    each_surface!(surface, surface => surface.unit_surface(scene, index, axes))
}

/// The half-space that a surface keeps of Gaussian `index`, which it cuts, to first order about the Gaussian's centre.
pub(crate) fn surface_half_space<T: Real>(
    surface: &Surface,
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
) -> HalfSpace<T> {
    unit_surface(surface, scene, index, axes).half_space
}

/// The crossings of the line of points `start + t step` with a surface: all such t, in any order. No shader asks this;
/// the truth does, which uses none of the renderer's formulas.
pub(crate) fn surface_crossings(surface: &Surface, start: DVec3, step: DVec3) -> Vec<f64> {
    each_surface!(surface, surface => surface.crossings(start, step))
}
