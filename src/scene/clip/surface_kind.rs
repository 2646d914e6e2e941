//! The trait of every kind of surface.

use glam::DVec3;

use crate::placement::Placement;

/// What every kind of surface says of itself.
pub(super) trait SurfaceKind: Copy {
    /// The surface that keeps what this one does not.
    #[must_use]
    fn complement(&self) -> Self;

    /// As [`Surface::distance`](super::Surface::distance).
    fn distance(&self, point: DVec3) -> f64;

    /// As [`Surface::gradient`](super::Surface::gradient).
    fn gradient(&self, point: DVec3) -> DVec3;

    /// The same surface as a scene with this placement sees it.
    #[must_use]
    fn in_scene(&self, placement: &Placement) -> Self;

    /// The numbers in which it may differ from another of its kind.
    fn numbers(&self) -> Vec<f64>;
}
