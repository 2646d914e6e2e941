//! The shape of a clip: a half-space, whose unit normal points to what it keeps.

use super::Side;
use crate::reference::real::{Real, Vec3, vec3};
use crate::{Gaussians, Mode, Plane, Settings};

/// A clip plane in a Gaussian's unit space: the point `mu + M u` is visible iff `offset + normal . u >= 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitPlane<T> {
    /// `a = M^T n`, world units.
    pub normal: Vec3<T>,
    /// `g = n . mu + d`: the signed distance of the Gaussian's centre, world units.
    pub offset: T,
}

impl<T: Real> UnitPlane<T> {
    /// The plane seen from inside Gaussian `index`. The distance is taken in double precision and rounded even in
    /// f32: far from the world's origin its two terms cancel, and the GPU computes it in two floats for that reason.
    pub fn new(scene: &Gaussians, index: usize, axes: &[Vec3<T>; 3], plane: &Plane) -> Self {
        let n = Vec3::of(plane.normal());
        Self {
            normal: vec3(axes[0].dot(n), axes[1].dot(n), axes[2].dot(n)),
            offset: T::of(plane.distance(scene.positions()[index].as_dvec3())),
        }
    }

    /// On which side a Gaussian is whose band reaches so many standard deviations.
    pub fn gaussian_side(&self, deviations: T, settings: &Settings) -> Side {
        if settings.mode == Mode::Hard {
            return match self.offset >= T::zero() {
                true => Side::Visible,
                false => Side::Invisible,
            };
        }
        let half = deviations * self.normal.length();
        if settings.trace_all {
            Side::Cutoff
        } else if self.offset >= half {
            Side::Visible
        } else if self.offset <= -half {
            Side::Invisible
        } else {
            Side::Cutoff
        }
    }
}
