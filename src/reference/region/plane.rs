//! The first shape: a half-space, whose unit normal points to what it keeps.

use glam::DVec3;

use super::{HalfSpace, Side};
use crate::real::{Real, Vec3, vec3};
use rara_scene::Gaussians;
use rara_scene::clip::Plane;

/// The plane seen from inside Gaussian `index`. The distance is taken in double precision and rounded even in f32: far
/// from the world's origin its two terms cancel, and the GPU computes it in two floats for that reason.
pub(super) fn half_space<T: Real>(
    plane: &Plane,
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
) -> HalfSpace<T> {
    let n = Vec3::of(plane.normal());
    HalfSpace {
        normal: vec3(axes[0].dot(n), axes[1].dot(n), axes[2].dot(n)),
        offset: T::of(plane.distance(scene.positions()[index].as_dvec3())),
    }
}

/// The length of the normal in the Gaussian's unit space is the standard deviation along the normal.
pub(super) fn gaussian_side<T: Real>(
    plane: &Plane,
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
    deviations: T,
) -> Side {
    let HalfSpace { normal, offset } = half_space(plane, scene, index, axes);
    let support = deviations * normal.length();
    if offset >= support {
        Side::Visible
    } else if offset <= -support {
        Side::Invisible
    } else {
        Side::Cutoff
    }
}

pub(super) fn box_side(plane: &Plane, middle: DVec3, half: DVec3, support: f64) -> Side {
    let margin = plane.normal().abs().dot(half) + support;
    match plane.distance(middle) {
        distance if distance > margin => Side::Visible,
        distance if distance < -margin => Side::Invisible,
        _ => Side::Cutoff,
    }
}

/// There is one crossing, or none where the line runs along the plane.
pub(super) fn crossings(plane: &Plane, start: DVec3, step: DVec3) -> Vec<f64> {
    let at = -plane.distance(start) / plane.normal().dot(step);
    if at.is_finite() { vec![at] } else { Vec::new() }
}
