//! Regions between two others of the same form, for cuts that move.

use std::mem::discriminant;

use super::parameter::Parameter;
use super::{Expression, Plane, Shape};
use rara_base::error::{Error, Result};

impl Expression {
    /// The region at a share of the way from this one to another, which has the same shapes in the same places: 0 is this one,
    /// 1 the other. Points, sizes and radii move evenly along straight lines, rotations and planes' normals along the
    /// shortest arcs. Planes that have a line in common keep it.
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
            (Self::Not(from), Self::Not(to)) => Self::Not(Box::new(from.between(to, share)?)),
            _ => return Err(unlike(self, other)),
        })
    }
}

fn unlike(from: &impl std::fmt::Display, to: &impl std::fmt::Display) -> Error {
    Error::Invalid(format!(
        "nothing lies between '{from}' and '{to}': give two regions with the same shapes in the same places"
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
                    "nothing lies between numbers of two roles".into(),
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
mod tests {
    use super::*;
    use glam::DVec3;

    fn between(from: &str, to: &str, share: f64) -> Result<Expression> {
        let [from, to] = [from, to].map(|text| text.parse::<Expression>().expect("an expression"));
        from.between(&to, share)
    }

    #[test]
    fn every_kind_of_shape_moves_evenly() {
        for (from, to, middle) in [
            ("plane:0,0,1,2", "plane:0,0,1,4", "plane:0,0,1,3"),
            ("!slab:1,0,0,0,1", "!slab:1,0,0,2,3", "!slab:1,0,0,1,2"),
            ("box:0,0,0,1,1,1", "box:2,0,0,1,3,1", "box:1,0,0,1,2,1"),
            ("sphere:0,0,0,1", "sphere:0,0,4,2", "sphere:0,0,2,1.5"),
            (
                "ellipsoid:0,0,0,1,1,1",
                "ellipsoid:0,0,0,3,1,1",
                "ellipsoid:0,0,0,2,1,1",
            ),
            (
                "cylinder:0,0,0,0,1,0,1",
                "cylinder:0,0,0,0,3,0,2",
                "cylinder:0,0,0,0,2,0,1.5",
            ),
            (
                "capsule:0,0,0,0,1,0,1",
                "capsule:1,0,0,1,1,0,1",
                "capsule:0.5,0,0,0.5,1,0,1",
            ),
            (
                "cone:0,0,0,0,1,0,1",
                "cone:0,0,0,0,1,0,2",
                "cone:0,0,0,0,1,0,1.5",
            ),
            (
                "all(sphere:0,0,0,1, not(any(plane:1,0,0,0, sphere:0,0,0,2)))",
                "all(sphere:0,0,0,3, not(any(plane:1,0,0,1, sphere:0,0,0,2)))",
                "all(sphere:0,0,0,2, not(any(plane:1,0,0,0.5, sphere:0,0,0,2)))",
            ),
        ] {
            let middle = middle.parse::<Expression>().expect("an expression");
            assert_eq!(between(from, to, 0.5).expect("a region"), middle);
            assert_eq!(
                between(from, to, 0.0).expect("a region"),
                from.parse().expect("an expression")
            );
            assert_eq!(
                between(from, to, 1.0).expect("a region"),
                to.parse().expect("an expression")
            );
        }
    }

    #[test]
    fn planes_turn_about_what_they_have_in_common() {
        let share = 0.3;
        // Both hold the line through (2, 3, z).
        let turned = between("plane:1,0,0,-2", "plane:0,1,0,-3", share)
            .expect("a plane")
            .clip();
        let plane = turned.surfaces[0].as_plane().expect("a plane");
        assert!(plane.distance(DVec3::new(2.0, 3.0, 7.0)).abs() < 1e-12);
        let angle = plane.normal().dot(DVec3::X).acos();
        assert!((angle - share * std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn other_forms_are_refused() {
        for (from, to) in [
            ("sphere:0,0,0,1", "box:0,0,0,1,1,1"),
            ("sphere:0,0,0,1", "!sphere:0,0,0,1"),
            ("all(sphere:0,0,0,1)", "any(sphere:0,0,0,1)"),
            ("all(sphere:0,0,0,1, plane:1,0,0,0)", "all(sphere:0,0,0,1)"),
        ] {
            for share in [0.0, 0.5, 1.0] {
                let error = between(from, to, share).expect_err(from).to_string();
                assert!(error.contains("the same shapes"), "{share}: {error}");
            }
        }
        let error = between("plane:1,0,0,0", "plane:-1,0,0,0", 0.5).expect_err("opposed");
        assert!(error.to_string().contains("180 degrees"), "{error}");
        // The two discs of a cylinder pass through each other.
        assert!(between("cylinder:0,0,0,0,1,0,1", "cylinder:0,0,0,0,-1,0,1", 0.5).is_err());
    }
}
