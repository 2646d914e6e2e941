//! The half-space that a surface keeps of a Gaussian that it cuts.

use glam::DVec3;

use super::Ellipsoid;
use crate::real::{Real, Vec3, vec3};

/// The half-space that a surface keeps of a Gaussian, in the Gaussian's unit space: the point `mu + M u` is visible iff
/// `offset + normal . u >= 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace<T> {
    /// `a = M^T n`, with n the surface's unit normal; the layer's units.
    pub normal: Vec3<T>,
    /// `g`: the signed distance of the Gaussian's centre, the layer's units.
    pub offset: T,
}

impl<T: Real> HalfSpace<T> {
    /// A plane as a Gaussian sees it, by its normal in the layer and the distance of the Gaussian's centre.
    pub(super) fn of_plane(ellipsoid: &Ellipsoid<T>, normal: DVec3, distance: f64) -> Self {
        let n = Vec3::of(normal);
        let [u, v, w] = ellipsoid.axes;
        Self {
            normal: vec3(u.dot(n), v.dot(n), w.dot(n)),
            offset: T::of(distance),
        }
    }

    /// The half-space that keeps the other side.
    pub(crate) fn complement(self) -> Self {
        Self {
            normal: -self.normal,
            offset: -self.offset,
        }
    }

    /// The signed distance of a point of the unit space, positive on the visible side.
    pub(crate) fn distance(&self, point: Vec3<T>) -> T {
        self.offset + self.normal.dot(point)
    }
}
