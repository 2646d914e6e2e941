//! The trait of every kind of surface.

use glam::DVec3;

/// What every kind of surface says of itself, beside its own `distance` and `in_scene`.
pub(super) trait SurfaceKind {
    /// The surface that keeps what this one does not.
    #[must_use]
    fn complement(&self) -> Self
    where
        Self: Sized;

    /// As [`Surface::gradient`](super::Surface::gradient).
    fn gradient(&self, point: DVec3) -> DVec3;

    /// The numbers in which it may differ from another of its kind.
    fn numbers(&self) -> Vec<f64>;
}
