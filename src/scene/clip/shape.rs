//! Shapes: what people cut with, each of which is a region of one or more surfaces.

use glam::{DQuat, DVec3};

use super::outline::Pen;
use super::parameter::Parameter;
use super::quadric::unit;
use super::solid::Solid;
use super::{Clip, ClipOp, Plane};
use crate::camera::Camera;
use rara_base::error::Result;

/// A solid, of which the inside or the outside stays visible. It parses from text, as `sphere:0,0,0,1`; a leading `!` keeps
/// the outside.
///
/// ```
/// # use rara_scene as rara;
/// use rara::{Clip, ClipOp, Shape};
///
/// let shapes: Vec<Shape> = vec!["plane:0,0,1,-2".parse()?, "box:0,0,3,1,1,1".parse()?];
/// let clip = Clip::of_shapes(&shapes, ClipOp::And);
/// assert_eq!(clip.surfaces.len(), 7);
/// # Ok::<(), rara::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    solid: Solid,
    outside: bool,
}

impl Shape {
    /// The inside of a solid, whose rotation is made a unit quaternion.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara_base::error::Error::Invalid) for numbers that are not finite, sizes that are not above zero, rotations that are zero and axes
    /// without length.
    pub fn new(solid: Solid) -> Result<Self> {
        let values = solid.values().into_iter();
        let solid = solid.kind().with(values.map(|value| match value {
            Parameter::Rotation(rotation) => unit(rotation).map(Parameter::Rotation),
            Parameter::Plane(_)
            | Parameter::Point(_)
            | Parameter::Sizes(_)
            | Parameter::Size(_) => Ok(value),
        }))?;
        solid.region()?;
        Ok(Self {
            solid,
            outside: false,
        })
    }

    /// The inside of a box: its centre, half its sizes along its own axes, and its rotation.
    ///
    /// # Errors
    /// The errors of [`Shape::new`].
    pub fn cuboid(centre: DVec3, half: DVec3, rotation: DQuat) -> Result<Self> {
        Self::new(Solid::Cuboid {
            centre,
            half,
            rotation,
        })
    }

    /// The inside of a sphere.
    ///
    /// # Errors
    /// The errors of [`Shape::new`].
    pub fn sphere(centre: DVec3, radius: f64) -> Result<Self> {
        Self::new(Solid::Sphere { centre, radius })
    }

    /// The plane, if the shape is a half-space.
    pub fn as_plane(&self) -> Option<Plane> {
        match self.solid {
            Solid::Plane { plane } if self.outside => Some(plane.flipped()),
            Solid::Plane { plane } => Some(plane),
            _ => None,
        }
    }

    /// The solid.
    pub fn solid(&self) -> Solid {
        self.solid
    }

    /// True when the outside is kept.
    pub fn is_outside(&self) -> bool {
        self.outside
    }

    /// The region that the shape keeps.
    pub fn clip(&self) -> Clip {
        // A solid that was accepted makes a region.
        let inside = self.solid.region().unwrap_or_default();
        match self.outside {
            true => inside.complement(),
            false => inside,
        }
    }

    /// Lines on its surface as a camera sees it, world units, whose ends lie on the surface: the edges of boxes; three great
    /// ellipses of spheres and ellipsoids, and where they turn away from the eye; the circles of cylinders, cones and capsules,
    /// and the lines of their sides where those turn away. An eye within such a side sees four of its lines. Planes are
    /// squares of half the size `reach` around the point nearest to `near`.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Camera, Shape, glam::DVec3};
    ///
    /// let eye = DVec3::new(3.0, 2.0, -4.0);
    /// let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64))?;
    /// let block: Shape = "box:0,0,0,1,1,1".parse()?;
    /// assert_eq!(block.outline(&camera, DVec3::ZERO, 1.0).len(), 12);
    /// # Ok::<(), rara::Error>(())
    /// ```
    pub fn outline(&self, camera: &Camera, near: DVec3, reach: f64) -> Vec<[DVec3; 2]> {
        let mut pen = Pen::new(camera, near, reach);
        self.solid.draw(&mut pen);
        pen.lines
    }

    /// One with other parameters, on the same side.
    pub(super) fn with(&self, values: impl Iterator<Item = Result<Parameter>>) -> Result<Self> {
        let inside = Self::new(self.solid.kind().with(values)?)?;
        Ok(Self {
            outside: self.outside,
            ..inside
        })
    }

    /// The shape that keeps what this one does not.
    #[must_use]
    pub fn complement(self) -> Self {
        Self {
            outside: !self.outside,
            ..self
        }
    }
}

impl From<Plane> for Shape {
    fn from(plane: Plane) -> Self {
        Self {
            solid: Solid::Plane { plane },
            outside: false,
        }
    }
}

impl Clip {
    /// The clip that shapes make together: visible in all of them, or in any.
    pub fn of_shapes(shapes: &[Shape], op: ClipOp) -> Self {
        match shapes {
            [] => Self::default(),
            shapes => Self::joined(shapes.iter().map(Shape::clip), op),
        }
    }
}

#[cfg(test)]
mod tests;
