//! How far a Gaussian reaches.

use glam::{DMat3, DVec3};

/// A Gaussian, out to where it is faint.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    pub(super) centre: DVec3,
    /// The half axes of the ellipsoid, columns.
    pub(super) axes: DMat3,
}

impl Reach {
    /// How far it reaches from its centre along each axis of a camera.
    pub(super) fn across(&self, rotation: DMat3) -> DVec3 {
        let rows = (rotation * self.axes).transpose();
        DVec3::new(
            rows.x_axis.length(),
            rows.y_axis.length(),
            rows.z_axis.length(),
        )
    }

    /// How far it reaches from its centre along a direction, by the length of that.
    pub(super) fn along(&self, direction: DVec3) -> f64 {
        (self.axes.transpose() * direction).length()
    }

    /// How far it reaches from a point along the axis on which it is farthest.
    pub(super) fn farthest(&self, from: DVec3) -> f64 {
        let off = (self.centre - from).abs() + self.across(DMat3::IDENTITY);
        off.max_element()
    }
}
