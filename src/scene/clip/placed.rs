//! Regions and shapes that are moved, turned and scaled.

use glam::DVec3;

use super::parameter::Parameter;
use super::{Clip, Expression, Plane, Shape};
use crate::placement::Placement;
use rara_base::error::Result;

impl Clip {
    /// Returns the clip in the space of a scene that has this placement.
    #[must_use]
    pub fn in_scene(&self, placement: &Placement) -> Self {
        self.map(&|surface| surface.in_scene(placement))
    }
}

impl Shape {
    /// Returns the shape after it was scaled, then turned, then moved, as a scene with this placement is.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Placement, Shape, glam::{DQuat, DVec3}};
    ///
    /// let ball: Shape = "sphere:1,0,0,.5".parse()?;
    /// let twice = Placement::new(DVec3::Y, DQuat::IDENTITY, 2.0)?;
    /// assert_eq!(ball.placed(&twice)?.to_string(), "sphere:2,1,0,1");
    /// # Ok::<(), rara::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Shape::new`], where numbers overflow or a size becomes zero.
    pub fn placed(&self, placement: &Placement) -> Result<Self> {
        let values = self.solid().values().into_iter();
        self.with(values.map(|value| value.placed(placement)))
    }

    /// The solid's middle, world units: halfway along the axis of one that has ends. Planes and slabs have none; theirs is the
    /// point nearest to `near`, halfway between the sides of a slab.
    pub fn middle(&self, near: DVec3) -> DVec3 {
        match self.solid().values()[..] {
            [Parameter::Plane(plane)] => near - plane.normal() * plane.distance(near),
            [Parameter::Plane(plane), Parameter::Size(thickness)] => {
                near - plane.normal() * (plane.distance(near) - thickness / 2.0)
            }
            [Parameter::Point(from), Parameter::Point(to), ..] => from.midpoint(to),
            [Parameter::Point(centre), ..] => centre,
            _ => near,
        }
    }
}

impl Expression {
    /// Returns the region after it was scaled, then turned, then moved, as a scene with this placement is.
    ///
    /// # Errors
    /// The errors of [`Shape::placed`].
    pub fn placed(&self, placement: &Placement) -> Result<Self> {
        let mut placed = self.clone();
        for leaf in placed.leaves_mut() {
            match leaf {
                Self::Shape(shape) => *shape = shape.placed(placement)?,
                Self::Prism(prism) => *prism = prism.placed(placement)?,
                Self::Mesh(mesh) => *mesh = mesh.placed(placement)?,
                Self::All(_) | Self::Any(_) | Self::Not(_) => {}
            }
        }
        Ok(placed)
    }
}

impl Parameter {
    fn placed(self, placement: &Placement) -> Result<Self> {
        let (turn, scale) = (placement.rotation(), placement.scale());
        Ok(match self {
            Self::Plane(plane) => {
                let normal = turn * plane.normal();
                let offset = scale * plane.offset() - normal.dot(placement.position());
                Self::Plane(Plane::new(normal, offset)?)
            }
            Self::Point(point) => Self::Point(placement.to_world(point)),
            Self::Sizes(sizes) => Self::Sizes(scale * sizes),
            Self::Size(size) => Self::Size(scale * size),
            Self::Rotation(rotation) => Self::Rotation(turn * rotation),
        })
    }
}

#[cfg(test)]
pub(super) mod tests;
