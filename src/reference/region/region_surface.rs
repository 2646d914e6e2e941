//! The trait of every kind of surface: the questions that the stages and the truth ask of it.

use glam::DVec3;

use super::{Ellipsoid, Side, UnitSurface};
use crate::real::Real;

/// A kind of surface.
pub(super) trait RegionSurface {
    /// The side of a Gaussian whose band reaches `deviations` standard deviations.
    fn gaussian_side<T: Real>(&self, ellipsoid: &Ellipsoid<T>, deviations: T) -> Side;

    /// The side of all Gaussians whose centres lie in a box and that reach at most `support` from them.
    fn box_side(&self, middle: DVec3, half: DVec3, support: f64) -> Side;

    /// The surface seen from inside a Gaussian. Its value at the centre is taken in double precision and rounded even in f32:
    /// far from the world's origin its terms cancel, and the GPU computes it in two floats for that reason.
    fn unit_surface<T: Real>(&self, ellipsoid: &Ellipsoid<T>) -> UnitSurface<T>;

    /// The crossings of the line of points `start + t step` with the surface: all such t, in any order.
    fn crossings(&self, start: DVec3, step: DVec3) -> Vec<f64>;
}
