//! A plane, which keeps a half-space.

use glam::DVec3;

use super::surface_kind::SurfaceKind;
use crate::placement::Placement;
use rara_base::error::{Error, Result};

/// A half-space: the points x with `normal . x + offset >= 0` are visible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    /// A plane from any non-zero normal; both are divided by the normal's length, in f64.
    pub fn new(normal: DVec3, offset: f64) -> Result<Self> {
        // The largest component is divided out first, so that normals of 1e-300 or 1e300 do not under- or overflow.
        let largest = normal.abs().max_element();
        if !(largest > 0.0 && normal.is_finite() && offset.is_finite()) {
            return Err(Error::Invalid(format!(
                "the clip plane {},{},{},{offset} needs a finite, non-zero normal and a finite distance",
                normal.x, normal.y, normal.z
            )));
        }
        // A unit vector stays as it is, so that what is written of a plane is read as the same plane.
        let is_unit = (normal.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON;
        let (scaled, largest) = if is_unit {
            (normal, 1.0)
        } else {
            (normal / largest, largest)
        };
        let length = if is_unit { 1.0 } else { scaled.length() };
        let offset = offset / largest / length;
        if !offset.is_finite() {
            return Err(Error::Invalid(
                "the clip plane's distance overflows when its normal is made a unit vector; give a longer normal or a smaller distance".into(),
            ));
        }
        Ok(Self {
            normal: scaled / length,
            offset,
        })
    }

    /// The unit normal; it points to the visible side.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The distance term of `normal . x + offset`, world units.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// The plane that keeps the other side.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self {
            normal: -self.normal,
            offset: -self.offset,
        }
    }

    /// Signed distance of a point, positive on the visible side, world units.
    pub fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point) + self.offset
    }

    /// Returns the plane in the space of a scene that has this placement.
    #[must_use]
    pub fn in_scene(&self, placement: &Placement) -> Self {
        if *placement == Placement::IDENTITY {
            return *self; // to the bit
        }
        let normal = placement.rotation().inverse() * self.normal();
        let offset = self.distance(placement.position()) / placement.scale();
        Self::new(normal, offset).unwrap_or(*self)
    }
}

impl SurfaceKind for Plane {
    fn complement(&self) -> Self {
        self.flipped()
    }

    fn gradient(&self, _: DVec3) -> DVec3 {
        self.normal
    }

    fn numbers(&self) -> Vec<f64> {
        let [x, y, z] = self.normal.to_array();
        vec![x, y, z, self.offset]
    }
}
