//! Regions between two others of the same form, for cuts that move.

use std::mem::discriminant;

use super::parameter::Parameter;
use super::{Expression, Plane, Shape};
use rara_base::error::{Error, Result};

impl Expression {
    /// Returns the region at a share of the way from this one to another: 0 is this one, 1 the other. Both must have the same
    /// kinds of shapes in the same order, prisms as many corners, and meshes the same faces. Points, sizes and radii are interpolated linearly, and rotations and normals of
    /// planes along the shortest arcs. Planes that have a line in common keep it.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::clip::Expression;
    ///
    /// let [from, to]: [Expression; 2] = ["sphere:0,0,0,1".parse()?, "sphere:2,0,0,3".parse()?];
    /// assert_eq!(from.between(&to, 0.5)?.to_string(), "sphere:1,0,0,2");
    /// # Ok::<(), rara::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] where the two have another form, whatever the share, and between them where normals are opposed, so that no arc is the shortest, and where
    /// what lies between is no shape.
    pub fn between(&self, other: &Self, share: f64) -> Result<Self> {
        let each = |from: &[Self], to: &[Self]| -> Result<Vec<Self>> {
            from.iter()
                .zip(to)
                .map(|(a, b)| a.between(b, share))
                .collect()
        };
        Ok(match (self, other) {
            (Self::Shape(from), Self::Shape(to)) => Self::Shape(from.between(to, share)?),
            (Self::All(from), Self::All(to)) if from.len() == to.len() => {
                Self::All(each(from, to)?)
            }
            (Self::Any(from), Self::Any(to)) if from.len() == to.len() => {
                Self::Any(each(from, to)?)
            }
            (Self::Prism(from), Self::Prism(to)) => {
                let made = from.between(to, share);
                let made = made.ok_or_else(|| unlike(self, other))?;
                match share {
                    0.0 => self.clone(),
                    1.0 => other.clone(),
                    _ => Self::Prism(made?),
                }
            }
            (Self::Mesh(from), Self::Mesh(to)) => {
                let made = from.between(to, share);
                Self::Mesh(made.ok_or_else(|| unlike(self, other))??)
            }
            (Self::Not(from), Self::Not(to)) => Self::Not(Box::new(from.between(to, share)?)),
            _ => return Err(unlike(self, other)),
        })
    }
}

fn unlike(from: &impl std::fmt::Display, to: &impl std::fmt::Display) -> Error {
    Error::Invalid(format!(
        "'{from}' cannot change into '{to}' step by step: give two clips that have the same kinds of shapes in the same order"
    ))
}

impl Shape {
    /// The shape at a share of the way to another of its kind, as [`Expression::between`].
    fn between(&self, other: &Self, share: f64) -> Result<Self> {
        let kind = |shape: &Self| (discriminant(&shape.solid()), shape.is_outside());
        if kind(self) != kind(other) {
            return Err(unlike(self, other));
        }
        if share == 0.0 || share == 1.0 {
            return Ok(*if share == 0.0 { self } else { other });
        }
        let pairs = self
            .solid()
            .values()
            .into_iter()
            .zip(other.solid().values());
        self.with(pairs.map(|(from, to)| from.between(to, share)))
    }
}

impl Parameter {
    /// The parameter at a share of the way to another of its role.
    fn between(self, other: Self, share: f64) -> Result<Self> {
        Ok(match (self, other) {
            (Self::Plane(from), Self::Plane(to)) => Self::Plane(from.between(&to, share)?),
            (Self::Point(from), Self::Point(to)) => Self::Point(from.lerp(to, share)),
            (Self::Sizes(from), Self::Sizes(to)) => Self::Sizes(from.lerp(to, share)),
            (Self::Size(from), Self::Size(to)) => Self::Size(from + (to - from) * share),
            (Self::Rotation(from), Self::Rotation(to)) => Self::Rotation(from.slerp(to, share)),
            (
                Self::Plane(_)
                | Self::Point(_)
                | Self::Sizes(_)
                | Self::Size(_)
                | Self::Rotation(_),
                _,
            ) => {
                return Err(Error::Invalid(
                    "the two shapes have parameters of different kinds; give shapes of the same kind".into(),
                ));
            }
        })
    }
}

impl Plane {
    /// The plane at a share of the way to another. With `n(s) = a n(0) + b n(1)` on the arc between the normals, the offset
    /// is `a d(0) + b d(1)`, so that a point on both planes stays on the plane.
    fn between(&self, other: &Self, share: f64) -> Result<Self> {
        let (from, to) = (self.normal(), other.normal());
        // The sine of an angle by the cross product is exact for small angles, where its cosine is not.
        let angle = from.cross(to).length().atan2(from.dot(to));
        let sine = angle.sin();
        let (a, b) = match angle {
            _ if std::f64::consts::PI - angle < 1e-6 => {
                return Err(Error::Invalid(
                    "a plane cannot turn to the opposite one: no way is the shortest; turn it by less than 180 degrees".into(),
                ));
            }
            _ if sine < 1e-9 => (1.0 - share, share),
            _ => (
                ((1.0 - share) * angle).sin() / sine,
                (share * angle).sin() / sine,
            ),
        };
        Self::new(a * from + b * to, a * self.offset() + b * other.offset())
    }
}

#[cfg(test)]
mod tests;
