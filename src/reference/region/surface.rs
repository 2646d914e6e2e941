//! The questions that the stages ask of a surface. Each kind answers in a file of its own.

use glam::DVec3;

use super::{HalfSpace, Side, plane};
use crate::reference::real::{Real, Vec3};
use crate::{Gaussians, Mode, Settings, Surface};

/// On which side of a surface Gaussian `index` is, which has the half axes `axes` and a band of `deviations` standard
/// deviations. A hard clip asks for the centre alone.
pub(in crate::reference) fn surface_gaussian_side<T: Real>(
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
    match surface {
        Surface::Plane(plane) => plane::gaussian_side(plane, scene, index, axes, deviations),
    }
}

/// On which side all Gaussians are whose centres lie in a box and that reach at most `support` from them, the layer's units.
pub(super) fn surface_box_side(
    surface: &Surface,
    middle: DVec3,
    half: DVec3,
    support: f64,
) -> Side {
    match surface {
        Surface::Plane(plane) => plane::box_side(plane, middle, half, support),
    }
}

/// The half-space that a surface keeps of Gaussian `index`, which it cuts.
pub(in crate::reference) fn surface_half_space<T: Real>(
    surface: &Surface,
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
) -> HalfSpace<T> {
    match surface {
        Surface::Plane(plane) => plane::half_space(plane, scene, index, axes),
    }
}

/// The crossings of the line of points `start + t step` with a surface: all such t, in any order. No shader asks this;
/// the truth does, which uses none of the renderer's formulas.
pub(in crate::reference) fn surface_crossings(
    surface: &Surface,
    start: DVec3,
    step: DVec3,
) -> Vec<f64> {
    match surface {
        Surface::Plane(plane) => plane::crossings(plane, start, step),
    }
}
