//! The questions that the stages ask of a surface. Each kind answers in a file of its own, as a [`RegionSurface`].

use glam::DVec3;

use super::region_surface::RegionSurface;
use super::{Ellipsoid, HalfSpace, Side, UnitSurface};
use crate::real::Real;
use rara_scene::clip::Surface;
use rara_scene::each_surface;
use rara_scene::settings::{Mode, Settings};

/// On which side of a surface a Gaussian is that has a band of `deviations` standard deviations. A hard clip asks for the centre alone.
pub(crate) fn surface_gaussian_side<T: Real>(
    surface: &Surface,
    ellipsoid: &Ellipsoid<T>,
    deviations: T,
    settings: &Settings,
) -> Side {
    if settings.mode == Mode::Hard {
        return match surface.distance(ellipsoid.centre) >= 0.0 {
            true => Side::Visible,
            false => Side::Invisible,
        };
    }
    if settings.trace_all {
        return Side::Cutoff;
    }
    each_surface!(surface, surface => surface.gaussian_side(ellipsoid, deviations))
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

/// A surface in the unit space of a Gaussian.
pub(crate) fn unit_surface<T: Real>(surface: &Surface, ellipsoid: &Ellipsoid<T>) -> UnitSurface<T> {
    each_surface!(surface, surface => surface.unit_surface(ellipsoid))
}

/// The half-space that a surface keeps of a Gaussian that it cuts, to first order about the Gaussian's centre.
pub(crate) fn surface_half_space<T: Real>(
    surface: &Surface,
    ellipsoid: &Ellipsoid<T>,
) -> HalfSpace<T> {
    unit_surface(surface, ellipsoid).half_space
}

/// The crossings of the line of points `start + t step` with a surface: all such t, in any order. No shader asks this;
/// the truth does, which uses none of the renderer's formulas.
pub(crate) fn surface_crossings(surface: &Surface, start: DVec3, step: DVec3) -> Vec<f64> {
    each_surface!(surface, surface => surface.crossings(start, step))
}
