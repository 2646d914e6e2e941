//! Shapes: what people cut with, each of which is a region of one or more surfaces.

use glam::{DQuat, DVec3};

use super::quadric::unit;
use super::{Clip, ClipOp, Plane, Quadric};
use crate::error::{Error, Result};

/// A solid, by the numbers that it is given with. Lengths are world units.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Solid {
    /// A half-space.
    Plane(Plane),
    /// What lies between a plane and another that is parallel to it.
    Slab {
        /// The side of it that the slab is on.
        plane: Plane,
        /// How thick the slab is.
        thickness: f64,
    },
    /// A box.
    Cuboid {
        /// Its centre.
        centre: DVec3,
        /// Half its sizes along its own axes.
        half: DVec3,
        /// Its rotation, a unit quaternion.
        rotation: DQuat,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        centre: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Its centre.
        centre: DVec3,
        /// Its radii along its own axes.
        radii: DVec3,
        /// Its rotation, a unit quaternion.
        rotation: DQuat,
    },
    /// A cylinder between two discs.
    Cylinder {
        /// The centre of one disc.
        from: DVec3,
        /// The centre of the other.
        to: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// All points within a distance of a stretch of a line.
    Capsule {
        /// One end of the stretch.
        from: DVec3,
        /// The other end.
        to: DVec3,
        /// The distance.
        radius: f64,
    },
    /// A cone.
    Cone {
        /// Its tip.
        apex: DVec3,
        /// The centre of the disc that it stands on.
        base: DVec3,
        /// The disc's radius.
        radius: f64,
    },
}

/// A solid, of which the inside or the outside stays visible. It parses from text, as `sphere:0,0,0,1`; a leading `!` keeps
/// the outside.
///
/// ```
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
    /// [`Error::Invalid`] for numbers that are not finite, sizes that are not above zero, rotations that are zero and axes
    /// without length.
    pub fn new(solid: Solid) -> Result<Self> {
        let solid = match solid {
            Solid::Cuboid {
                centre,
                half,
                rotation,
            } => Solid::Cuboid {
                centre,
                half,
                rotation: unit(rotation)?,
            },
            Solid::Ellipsoid {
                centre,
                radii,
                rotation,
            } => Solid::Ellipsoid {
                centre,
                radii,
                rotation: unit(rotation)?,
            },
            other => other,
        };
        region(&solid)?;
        Ok(Self {
            solid,
            outside: false,
        })
    }

    /// The inside of a box: its centre, half its sizes along its own axes, and its rotation.
    ///
    /// # Errors
    /// As of [`Shape::new`].
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
    /// As of [`Shape::new`].
    pub fn sphere(centre: DVec3, radius: f64) -> Result<Self> {
        Self::new(Solid::Sphere { centre, radius })
    }

    /// The plane, if the shape is a half-space.
    pub fn as_plane(&self) -> Option<Plane> {
        match self.solid {
            Solid::Plane(plane) if self.outside => Some(plane.flipped()),
            Solid::Plane(plane) => Some(plane),
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
        let inside = region(&self.solid).unwrap_or_default();
        match self.outside {
            true => inside.complement(),
            false => inside,
        }
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
            solid: Solid::Plane(plane),
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

/// The inside of a solid.
fn region(solid: &Solid) -> Result<Clip> {
    match *solid {
        Solid::Plane(plane) => Ok(Clip::of([plane], ClipOp::And)),
        Solid::Slab { plane, thickness } => {
            let beyond = Plane::new(-plane.normal(), thickness - plane.offset())?;
            match thickness > 0.0 {
                true => Ok(Clip::of([plane, beyond], ClipOp::And)),
                false => Err(Error::Invalid("a slab's thickness is above zero".into())),
            }
        }
        Solid::Cuboid {
            centre,
            half,
            rotation,
        } => {
            let has_sizes = half.min_element() > 0.0;
            if !has_sizes {
                return Err(Error::Invalid("a box's half sizes are above zero".into()));
            }
            let side = |index: usize| {
                let inward = if index < 3 { -1.0 } else { 1.0 };
                let normal = rotation * (DVec3::AXES[index % 3] * inward);
                Plane::new(normal, half[index % 3] - normal.dot(centre))
            };
            let sides: Vec<Plane> = (0..6).map(side).collect::<Result<_>>()?;
            Ok(Clip::of(sides, ClipOp::And))
        }
        Solid::Sphere { centre, radius } => {
            Ok(Clip::of([Quadric::sphere(centre, radius)?], ClipOp::And))
        }
        Solid::Ellipsoid {
            centre,
            radii,
            rotation,
        } => Ok(Clip::of(
            [Quadric::ellipsoid(centre, radii, rotation)?],
            ClipOp::And,
        )),
        Solid::Cylinder { from, to, radius } => {
            between(Quadric::cylinder(from, to, radius)?, from, to)
        }
        Solid::Capsule { from, to, radius } => {
            let ends = [Quadric::sphere(from, radius)?, Quadric::sphere(to, radius)?];
            let side = between(Quadric::cylinder(from, to, radius)?, from, to)?;
            Ok(Clip::joined([Clip::of(ends, ClipOp::Or), side], ClipOp::Or))
        }
        Solid::Cone { apex, base, radius } => {
            between(Quadric::cone(apex, base, radius)?, apex, base)
        }
    }
}

/// What a quadric keeps between the planes across a line at two of its points.
fn between(quadric: Quadric, from: DVec3, to: DVec3) -> Result<Clip> {
    let along = to - from;
    let along = along / along.abs().max_element();
    let mut clip = Clip::of([quadric], ClipOp::And);
    for (normal, point) in [(along, from), (-along, to)] {
        clip.surfaces
            .push(Plane::new(normal, -normal.dot(point))?.into());
    }
    Ok(clip)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Random;

    fn random_point(random: &mut Random) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| 6.0 * random.unit() - 3.0))
    }

    /// True when a point is in a solid, from distances alone.
    fn holds(text: &str, x: DVec3) -> bool {
        let (a, b) = (DVec3::new(-1.0, 0.0, 0.5), DVec3::new(1.0, 1.0, 0.5));
        let along = (b - a).normalize();
        let at = (x - a).dot(along);
        let aside = (x - a - at * along).length();
        let length = a.distance(b);
        match text.split(':').next().unwrap() {
            "plane" => x.z >= 0.5,
            "slab" => x.z >= 0.5 && x.z <= 1.25,
            "box" => (x - a).abs().cmple(DVec3::new(1.0, 2.0, 0.5)).all(),
            "sphere" => x.distance(a) <= 1.5,
            "ellipsoid" => ((x - a) / DVec3::new(1.0, 2.0, 0.5)).length() <= 1.0,
            "cylinder" => aside <= 0.75 && (0.0..=length).contains(&at),
            "capsule" => (x - a - at.clamp(0.0, length) * along).length() <= 0.75,
            "cone" => (0.0..=length).contains(&at) && aside <= 0.75 * at / length,
            other => panic!("{other}"),
        }
    }

    #[test]
    fn shapes_keep_what_their_solids_hold() {
        let mut random = Random::new(5);
        for text in [
            "plane:0,0,2,-1",
            "slab:0,0,2,-1,0.75",
            "box:-1,0,0.5,1,2,0.5",
            "sphere:-1,0,0.5,1.5",
            "ellipsoid:-1,0,0.5,1,2,0.5",
            "cylinder:-1,0,0.5,1,1,0.5,0.75",
            "capsule:-1,0,0.5,1,1,0.5,0.75",
            "cone:-1,0,0.5,1,1,0.5,0.75",
        ] {
            let shape: Shape = text.parse().unwrap();
            assert_eq!(shape.to_string().parse::<Shape>().unwrap(), shape, "{text}");
            let (inside, outside) = (shape.clip(), shape.complement().clip());
            let mut held = 0;
            for _ in 0..2_000 {
                let point = random_point(&mut random);
                let is_held = holds(text, point);
                held += u32::from(is_held);
                assert_eq!(inside.keeps(point), is_held, "{text} at {point}");
                assert_eq!(outside.keeps(point), !is_held, "!{text} at {point}");
            }
            assert!((2..1_500).contains(&held), "{text}: {held}");
        }
    }
}
