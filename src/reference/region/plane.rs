//! The first shape: a half-space, whose unit normal points to what it keeps.

use glam::DVec3;

use super::quadric::Symmetric;
use super::region_surface::RegionSurface;
use super::{Ellipsoid, HalfSpace, Side, UnitSurface};
use crate::real::Real;
use rara_scene::clip::Plane;

impl RegionSurface for Plane {
    /// The length of the normal in the Gaussian's unit space is the standard deviation along the normal.
    fn gaussian_side<T: Real>(&self, ellipsoid: &Ellipsoid<T>, deviations: T) -> Side {
        let HalfSpace { normal, offset } = self.unit_surface(ellipsoid).half_space;
        let support = deviations * normal.length();
        if offset >= support {
            Side::Visible
        } else if offset <= -support {
            Side::Invisible
        } else {
            Side::Cutoff
        }
    }

    fn box_side(&self, middle: DVec3, half: DVec3, support: f64) -> Side {
        let margin = self.normal().abs().dot(half) + support;
        match self.distance(middle) {
            distance if distance > margin => Side::Visible,
            distance if distance < -margin => Side::Invisible,
            _ => Side::Cutoff,
        }
    }

    fn unit_surface<T: Real>(&self, ellipsoid: &Ellipsoid<T>) -> UnitSurface<T> {
        let distance = self.distance(ellipsoid.centre);
        UnitSurface {
            half_space: HalfSpace::of_plane(ellipsoid, self.normal(), distance),
            bend: Symmetric::zero(),
        }
    }

    /// There is one crossing, or none where the line runs along the plane.
    fn crossings(&self, start: DVec3, step: DVec3) -> Vec<f64> {
        let at = -self.distance(start) / self.normal().dot(step);
        if at.is_finite() { vec![at] } else { Vec::new() }
    }
}
