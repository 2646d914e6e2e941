//! The half-space that a surface keeps of a Gaussian that it cuts.

use crate::real::{Real, Vec3};

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
