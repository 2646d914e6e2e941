//! Solids: one table of what there is to say of each of them.

use glam::{DQuat, DVec3};

use super::outline::{Pen, Tube};
use super::parameter::{Parameter, Role};
use super::{Clip, ClipOp, Plane, Quadric, Surface};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// A solid, by the numbers that it is given with. Lengths are world units.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Solid {
    /// A half-space.
    Plane {
        /// Its boundary, which keeps the half-space.
        plane: Plane,
    },
    /// The space between a plane and another that is parallel to it.
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
    /// All points within a distance of a line segment.
    Capsule {
        /// One end of the segment.
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

/// What is said of all solids of a kind.
pub(super) struct Kind {
    pub(super) name: &'static str,
    /// Its numbers but for a rotation, for people.
    numbers: &'static str,
    /// How it is written as text, and what that means.
    usage: &'static str,
    /// Each parameter's field, what people call it, and its role. A rotation comes last.
    pub(super) parameters: &'static [(&'static str, &'static str, Role)],
    make: fn(&[Parameter]) -> Option<Solid>,
}

/// Makes the code of all solids from a row for each: its parameters with their roles, and with the names that people use
/// where those differ from the fields'; its name, numbers and usage as in [`Kind`]; the region that it is; and how its outline
/// is drawn. A variant without a row does not compile.
macro_rules! solids {
    ($($variant:ident { $($field:ident: $role:ident $($label:literal)?),+ } => {
        name: $name:literal, numbers: $numbers:literal,
        usage: $usage:literal,
        region: $region:expr,
        outline: |$pen:ident| $outline:expr,
    })+) => {
        #[allow(non_upper_case_globals)]
        mod kinds {
            use super::*;

            $(pub(super) const $variant: &Kind = &Kind {
                name: $name,
                numbers: $numbers,
                usage: $usage,
                parameters: &[$((
                    stringify!($field),
                    [$($label,)? stringify!($field)][0],
                    Role::$role,
                )),+],
                make: |values| match *values {
                    [$(Parameter::$role($field)),+] => Some(Solid::$variant { $($field),+ }),
                    _ => None,
                },
            };)+
        }

        /// All kinds, in the order in which messages list them.
        pub(super) const KINDS: &[&Kind] = &[$(kinds::$variant),+];

        impl Solid {
            pub(super) fn kind(&self) -> &'static Kind {
                match self {
                    $(Self::$variant { .. } => kinds::$variant,)+
                }
            }

            /// Its parameters in the order of its text.
            pub(super) fn values(&self) -> Vec<Parameter> {
                match *self {
                    $(Self::$variant { $($field),+ } => vec![$(Parameter::$role($field)),+],)+
                }
            }

            /// Its inside.
            pub(super) fn region(&self) -> Result<Clip> {
                match *self {
                    $(Self::$variant { $($field),+ } => $region,)+
                }
            }

            /// Draws the lines by which people recognise it.
            pub(super) fn draw(&self, pen: &mut Pen<'_>) {
                match *self {
                    $(Self::$variant { $($field),+ } => {
                        let $pen = pen;
                        $outline;
                    })+
                }
            }
        }
    };
}

solids! {
    Plane { plane: Plane } => {
        name: "plane", numbers: "normal, distance",
        usage: "plane:nx,ny,nz,d keeps the points p with dot(n, p) + d >= 0.",
        region: Ok(all_of([plane])),
        outline: |pen| pen.plane(&plane),
    }
    Slab { plane: Plane, thickness: Size } => {
        name: "slab", numbers: "normal, distance, thickness",
        usage: "slab:nx,ny,nz,d,thickness keeps the points p with 0 <= dot(n, p) + d <= thickness.",
        region: slab(plane, thickness),
        outline: |pen| pen.slab(&plane, thickness),
    }
    Cuboid { centre: Point, half: Sizes "half size", rotation: Rotation } => {
        name: "box", numbers: "centre, half sizes",
        usage: "box:cx,cy,cz,hx,hy,hz[,qw,qx,qy,qz] has a centre c, half sizes h and a rotation q.",
        region: cuboid(centre, half, rotation),
        outline: |pen| pen.cuboid(centre, half, rotation),
    }
    Sphere { centre: Point, radius: Size } => {
        name: "sphere", numbers: "centre, radius",
        usage: "sphere:cx,cy,cz,r has a centre c and a radius r.",
        region: Ok(all_of([Quadric::sphere(centre, radius)?])),
        outline: |pen| pen.ellipsoid(centre, DVec3::splat(radius), DQuat::IDENTITY),
    }
    Ellipsoid { centre: Point, radii: Sizes, rotation: Rotation } => {
        name: "ellipsoid", numbers: "centre, radii",
        usage: "ellipsoid:cx,cy,cz,rx,ry,rz[,qw,qx,qy,qz] has a centre c, radii r and a rotation q.",
        region: Ok(all_of([Quadric::ellipsoid(centre, radii, rotation)?])),
        outline: |pen| pen.ellipsoid(centre, radii, rotation),
    }
    Cylinder { from: Point, to: Point, radius: Size } => {
        name: "cylinder", numbers: "two ends of the axis, radius",
        usage: "cylinder:ax,ay,az,bx,by,bz,r lies between discs of radius r around a and b.",
        region: between(Quadric::cylinder(from, to, radius)?, from, to),
        outline: |pen| pen.side(&Tube::new(from, to, radius)),
    }
    Capsule { from: Point, to: Point, radius: Size } => {
        name: "capsule", numbers: "two ends of the axis, radius",
        usage: "capsule:ax,ay,az,bx,by,bz,r is all points within r of the line segment from a to b.",
        region: capsule(from, to, radius),
        outline: |pen| pen.capsule(&Tube::new(from, to, radius)),
    }
    Cone { apex: Point "tip", base: Point, radius: Size } => {
        name: "cone", numbers: "apex, centre of the base, radius of the base",
        usage: "cone:ax,ay,az,bx,by,bz,r has its tip at a and a disc of radius r around b.",
        region: between(Quadric::cone(apex, base, radius)?, apex, base),
        outline: |pen| pen.cone(&Tube::new(base, apex, radius)),
    }
}

impl Solid {
    /// The name of its kind, as in its text.
    pub fn name(&self) -> &'static str {
        self.kind().name
    }

    /// Returns the parameters in the order of the shape's text, each with a name for people.
    pub fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let names = self.kind().parameters.iter().map(|(_, name, _)| *name);
        names.zip(self.values()).collect()
    }

    /// How the solids of each kind are written as text, and what that means: a sentence each.
    pub fn usages() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|kind| kind.usage)
    }

    /// The numbers of its text.
    pub(super) fn numbers(&self) -> Vec<f64> {
        self.values()
            .into_iter()
            .flat_map(Parameter::numbers)
            .collect()
    }
}

impl Kind {
    /// The solid of these parameters.
    pub(super) fn with(&self, values: impl Iterator<Item = Result<Parameter>>) -> Result<Solid> {
        let values: Vec<_> = values.collect::<Result<_>>()?;
        let solid = (self.make)(&values);
        solid.ok_or_else(|| {
            Error::Invalid(format!(
                "these are not the parameters of a {}; give as many, of the same kinds, as it has",
                self.name
            ))
        })
    }

    /// The solid that is made of the numbers of its text.
    pub(super) fn solid(&self, numbers: &[f64]) -> Result<Solid> {
        let roles = self.parameters.iter().map(|(.., role)| *role);
        let most: usize = roles.clone().map(Role::count).sum();
        let (least, more) = match self.parameters {
            [.., (.., Role::Rotation)] => (
                most - Role::Rotation.count(),
                format!(" or {most} (and a quaternion w,x,y,z)"),
            ),
            _ => (most, String::new()),
        };
        if ![least, most].contains(&numbers.len()) {
            return Err(Error::Invalid(format!(
                "a {} has {} ({}){more}, not {}",
                self.name,
                counted(least, "number"),
                self.numbers,
                counted(numbers.len(), "number")
            )));
        }
        let mut rest = numbers;
        self.with(roles.map(|role| {
            let (own, others) = rest.split_at(role.count().min(rest.len()));
            rest = others;
            role.parameter(own)
        }))
    }

    /// The fields of its numbers in JSON, in the order of its text, and how many numbers each has.
    #[cfg(feature = "json")]
    pub(super) fn fields(&self) -> impl Iterator<Item = (&'static str, usize)> {
        self.parameters
            .iter()
            .flat_map(|(field, _, role)| role.fields(field))
    }
}

/// What all surfaces keep.
fn all_of<const N: usize>(surfaces: [impl Into<Surface>; N]) -> Clip {
    Clip::of(surfaces, ClipOp::And)
}

fn slab(plane: Plane, thickness: f64) -> Result<Clip> {
    let beyond = Plane::new(-plane.normal(), thickness - plane.offset())?;
    match thickness > 0.0 {
        true => Ok(all_of([plane, beyond])),
        false => Err(Error::Invalid(format!(
            "a slab has the thickness {thickness}: give a number above zero"
        ))),
    }
}

fn cuboid(centre: DVec3, half: DVec3, rotation: DQuat) -> Result<Clip> {
    let has_sizes = half.min_element() > 0.0;
    if !has_sizes {
        let [x, y, z] = half.to_array();
        return Err(Error::Invalid(format!(
            "a box has the half sizes {x}, {y} and {z}: give three numbers above zero"
        )));
    }
    let side = |index: usize| {
        let inward = if index < 3 { -1.0 } else { 1.0 };
        let normal = rotation * (DVec3::AXES[index % 3] * inward);
        Plane::new(normal, half[index % 3] - normal.dot(centre))
    };
    let sides: Vec<Plane> = (0..6).map(side).collect::<Result<_>>()?;
    Ok(Clip::of(sides, ClipOp::And))
}

fn capsule(from: DVec3, to: DVec3, radius: f64) -> Result<Clip> {
    let ends = [Quadric::sphere(from, radius)?, Quadric::sphere(to, radius)?];
    let side = between(Quadric::cylinder(from, to, radius)?, from, to)?;
    Ok(Clip::joined([Clip::of(ends, ClipOp::Or), side], ClipOp::Or))
}

/// Returns what a quadric keeps between the planes across a line at two of its points.
fn between(quadric: Quadric, from: DVec3, to: DVec3) -> Result<Clip> {
    let along = to - from;
    let along = along / along.abs().max_element();
    let mut clip = all_of([quadric]);
    for (normal, point) in [(along, from), (-along, to)] {
        clip.surfaces
            .push(Plane::new(normal, -normal.dot(point))?.into());
    }
    Ok(clip)
}
