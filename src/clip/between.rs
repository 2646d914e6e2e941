//! Regions between two others of the same form, for cuts that move.

use std::mem::discriminant;

use glam::{DQuat, DVec3};

use super::{Expression, Plane, Shape, Solid};
use crate::error::{Error, Result};

impl Expression {
    /// The region at a share of the way from this one to another, which has the same shapes in the same places: 0 is this one,
    /// 1 the other. Points, sizes and radii move evenly along straight lines, rotations and planes' normals along the
    /// shortest arcs. Planes that have a line in common keep it.
    ///
    /// ```
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
        let point = |from: DVec3, to: DVec3| from.lerp(to, share);
        let solid = self.solid().of_both(
            other.solid(),
            |from, to| from.between(&to, share),
            point,
            point,
            |from, to| from + (to - from) * share,
            |from, to| from.slerp(to, share),
        )?;
        let solid = solid.ok_or_else(|| unlike(self, other))?;
        let between = Self::new(solid)?;
        Ok(match self.is_outside() {
            true => between.complement(),
            false => between,
        })
    }
}

impl Solid {
    /// A solid of whose parts each is made of those of two solids of a kind; `None` where they are of two kinds.
    pub(super) fn of_both(
        self,
        other: Self,
        plane: impl Fn(Plane, Plane) -> Result<Plane>,
        point: impl Fn(DVec3, DVec3) -> DVec3,
        sizes: impl Fn(DVec3, DVec3) -> DVec3,
        size: impl Fn(f64, f64) -> f64,
        rotation: impl Fn(DQuat, DQuat) -> DQuat,
    ) -> Result<Option<Self>> {
        Ok(Some(match (self, other) {
            (Self::Plane(from), Self::Plane(to)) => Self::Plane(plane(from, to)?),
            (
                Self::Slab {
                    plane: from,
                    thickness,
                },
                Self::Slab {
                    plane: to,
                    thickness: other,
                },
            ) => Self::Slab {
                plane: plane(from, to)?,
                thickness: size(thickness, other),
            },
            (
                Self::Cuboid {
                    centre,
                    half,
                    rotation: turn,
                },
                Self::Cuboid {
                    centre: c,
                    half: h,
                    rotation: r,
                },
            ) => Self::Cuboid {
                centre: point(centre, c),
                half: sizes(half, h),
                rotation: rotation(turn, r),
            },
            (
                Self::Sphere { centre, radius },
                Self::Sphere {
                    centre: c,
                    radius: r,
                },
            ) => Self::Sphere {
                centre: point(centre, c),
                radius: size(radius, r),
            },
            (
                Self::Ellipsoid {
                    centre,
                    radii,
                    rotation: turn,
                },
                Self::Ellipsoid {
                    centre: c,
                    radii: h,
                    rotation: r,
                },
            ) => Self::Ellipsoid {
                centre: point(centre, c),
                radii: sizes(radii, h),
                rotation: rotation(turn, r),
            },
            (
                Self::Cylinder { from, to, radius },
                Self::Cylinder {
                    from: f,
                    to: t,
                    radius: r,
                },
            ) => Self::Cylinder {
                from: point(from, f),
                to: point(to, t),
                radius: size(radius, r),
            },
            (
                Self::Capsule { from, to, radius },
                Self::Capsule {
                    from: f,
                    to: t,
                    radius: r,
                },
            ) => Self::Capsule {
                from: point(from, f),
                to: point(to, t),
                radius: size(radius, r),
            },
            (
                Self::Cone { apex, base, radius },
                Self::Cone {
                    apex: a,
                    base: b,
                    radius: r,
                },
            ) => Self::Cone {
                apex: point(apex, a),
                base: point(base, b),
                radius: size(radius, r),
            },
            _ => return Ok(None),
        }))
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
