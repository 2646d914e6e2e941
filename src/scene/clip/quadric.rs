//! Quadrics: spheres, ellipsoids, and the sides of cylinders and cones.

use glam::{DMat3, DQuat, DVec3};

use super::surface_kind::SurfaceKind;
use crate::placement::Placement;
use rara_base::error::{Error, Result};

/// The side of a quadric surface that is kept: the points x with `constant + linear . p + p . matrix p >= 0`, where
/// `p = x - anchor`.
///
/// The function is scaled so that its gradient on the surface is of the order of 1: it is a measure of how far a point is
/// from the surface. The anchor is a point near the surface or the scene, where the numbers do not cancel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadric {
    anchor: DVec3,
    matrix: DMat3,
    linear: DVec3,
    constant: f64,
}

impl Quadric {
    /// Makes the inside of a sphere.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a centre that is not finite and a radius that is not above zero.
    pub fn sphere(centre: DVec3, radius: f64) -> Result<Self> {
        Self::ellipsoid(centre, DVec3::splat(radius), DQuat::IDENTITY)
    }

    /// The inside of an ellipsoid: its centre, its radii along its own axes, and its rotation.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not finite, radii that are not above zero and a rotation that is zero.
    pub fn ellipsoid(centre: DVec3, radii: DVec3, rotation: DQuat) -> Result<Self> {
        let axes = DMat3::from_quat(unit(rotation)?);
        let scale = 0.5 * radii.min_element();
        // Ratios of radii stay in range where their squares would not.
        let shares = (radii.min_element() / radii).powf(2.0) / (2.0 * radii.min_element());
        Self::centred(centre, axes, -shares, scale, radii.min_element())
    }

    /// Makes the inside of an endless cylinder around the line through two points.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not finite, a radius that is not above zero and points that are one.
    pub fn cylinder(from: DVec3, to: DVec3, radius: f64) -> Result<Self> {
        let axes = around(to - from)?;
        let share = -0.5 / radius;
        Self::centred(
            from,
            axes,
            DVec3::new(share, share, 0.0),
            0.5 * radius,
            radius,
        )
    }

    /// The inside of an endless cone on both sides of its apex, around the line from there to the centre of a disc.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not finite, a radius that is not above zero and an apex in the disc.
    pub fn cone(apex: DVec3, base: DVec3, radius: f64) -> Result<Self> {
        let axes = around(base - apex)?;
        let slope = radius / (base - apex).length();
        let share = 0.5 / radius;
        let shares = DVec3::new(-share, -share, share * slope * slope);
        Self::centred(apex, axes, shares, 0.0, radius)
    }

    /// `constant + sum of shares y^2`, with y the coordinates along axes from the centre.
    fn centred(
        centre: DVec3,
        axes: DMat3,
        shares: DVec3,
        constant: f64,
        least_radius: f64,
    ) -> Result<Self> {
        let matrix = axes * DMat3::from_diagonal(shares) * axes.transpose();
        let is_finite = matrix.is_finite() && constant.is_finite() && centre.is_finite();
        if !(is_finite && least_radius > 0.0) {
            return Err(Error::Invalid(
                "a curved clip shape needs finite numbers and radii above zero".into(),
            ));
        }
        Ok(Self {
            anchor: centre,
            matrix,
            linear: DVec3::ZERO,
            constant,
        })
    }

    /// Returns the point that the numbers of the quadric are relative to.
    pub fn anchor(&self) -> DVec3 {
        self.anchor
    }

    /// Returns the symmetric matrix of the factors of the squares and products of coordinates, in 1/world units.
    pub fn matrix(&self) -> DMat3 {
        self.matrix
    }

    /// Returns the gradient at the anchor, which has no unit.
    pub fn linear(&self) -> DVec3 {
        self.linear
    }

    /// Returns the value at the anchor, in world units.
    pub fn constant(&self) -> f64 {
        self.constant
    }

    /// Returns the quadric that keeps the other side.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self {
            anchor: self.anchor,
            matrix: self.matrix * -1.0,
            linear: -self.linear,
            constant: -self.constant,
        }
    }

    /// Returns the value of the function at a point, which is positive on the visible side. Near the surface it is about the
    /// distance, in world units.
    pub fn distance(&self, point: DVec3) -> f64 {
        let p = point - self.anchor;
        self.constant + p.dot(self.linear + self.matrix * p)
    }

    /// Returns the gradient of the quadric's function at a point.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        self.linear + 2.0 * (self.matrix * (point - self.anchor))
    }

    /// The same quadric with its numbers relative to another point.
    #[doc(hidden)]
    #[must_use]
    pub fn anchored(&self, anchor: DVec3) -> Self {
        Self {
            anchor,
            matrix: self.matrix,
            linear: self.gradient(anchor),
            constant: self.distance(anchor),
        }
    }

    /// The quadric that keeps the points x of which this one keeps `from + scale * rotation x`.
    #[doc(hidden)]
    #[must_use]
    pub fn seen_from(&self, from: DVec3, rotation: DQuat, scale: f64) -> Self {
        let turn = DMat3::from_quat(rotation);
        let back = turn.transpose();
        Self {
            anchor: back * (self.anchor - from) / scale,
            matrix: back * self.matrix * turn * scale,
            linear: back * self.linear,
            constant: self.constant / scale,
        }
    }

    /// Returns the quadric in the space of a scene that has this placement.
    #[must_use]
    pub fn in_scene(&self, placement: &Placement) -> Self {
        if *placement == Placement::IDENTITY {
            return *self; // to the bit
        }
        self.seen_from(
            placement.position(),
            placement.rotation(),
            placement.scale(),
        )
    }
}

/// Axes of which the third has this direction.
fn around(direction: DVec3) -> Result<DMat3> {
    let largest = direction.abs().max_element();
    if !(largest > 0.0 && direction.is_finite()) {
        return Err(Error::Invalid(
            "the two points of a clip shape's axis are one; give it a length".into(),
        ));
    }
    let axis = (direction / largest).normalize();
    let (first, second) = axis.any_orthonormal_pair();
    Ok(DMat3::from_cols(first, second, axis))
}

/// A quaternion of length one.
///
/// # Errors
/// [`Error::Invalid`] for one that is zero or not finite.
pub(super) fn unit(rotation: DQuat) -> Result<DQuat> {
    let largest = rotation.to_array().into_iter().map(f64::abs);
    let largest = largest.fold(0.0, f64::max);
    if !(largest > 0.0 && rotation.is_finite()) {
        return Err(Error::Invalid(
            "a clip shape's quaternion is finite and not zero".into(),
        ));
    }
    // One that has this length stays as it is, so that what is written of a shape is read as the same shape.
    if (rotation.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Ok(rotation);
    }
    // The largest component is divided out first, which keeps the squares of tiny and huge ones in range.
    Ok(DQuat::from_array(rotation.to_array().map(|v| v / largest)).normalize())
}

impl SurfaceKind for Quadric {
    fn complement(&self) -> Self {
        self.flipped()
    }

    fn gradient(&self, point: DVec3) -> DVec3 {
        Quadric::gradient(self, point)
    }

    fn numbers(&self) -> Vec<f64> {
        let mut numbers = self.matrix().to_cols_array().to_vec();
        numbers.extend(self.linear().to_array());
        numbers.extend(self.anchor().to_array());
        numbers.push(self.constant());
        numbers
    }
}

#[cfg(test)]
mod tests;
