//! The text of shapes, as `plane:nx,ny,nz,d` or `!sphere:cx,cy,cz,r`.

use std::fmt;
use std::str::FromStr;

use glam::{DQuat, DVec3};

use super::{Plane, Shape, Solid};
use crate::counted::counted;
use crate::error::{Error, Result, shortened};

/// The names of the shapes.
pub(super) const NAMES: [&str; 8] = [
    "plane",
    "slab",
    "box",
    "sphere",
    "ellipsoid",
    "cylinder",
    "capsule",
    "cone",
];

impl FromStr for Shape {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let (bare, outside) = match text.trim().strip_prefix('!') {
            Some(bare) => (bare, true),
            None => (text.trim(), false),
        };
        let Some((name, numbers)) = bare.split_once(':') else {
            return Err(Error::Invalid(format!(
                "'{}' is no shape; give one like plane:1,0,0,-0.5 or sphere:0,0,0,1",
                shortened(bare)
            )));
        };
        let shape = Self::new(solid(name.trim(), numbers)?)?;
        Ok(if outside { shape.complement() } else { shape })
    }
}

/// The solid of this name and with these numbers.
fn solid(name: &str, text: &str) -> Result<Solid> {
    if !NAMES.contains(&name) {
        return Err(Error::Invalid(format!(
            "'{}' is not a shape; use {}",
            shortened(name),
            NAMES.join(", ")
        )));
    }
    let list = numbers(text)?;
    let vector = |at: usize| DVec3::from_slice(&list[at..]);
    let rotation = match list[..] {
        [.., w, x, y, z] if list.len() == 10 => DQuat::from_xyzw(x, y, z, w),
        _ => DQuat::IDENTITY,
    };
    let needs = |what: &str| {
        Err(Error::Invalid(format!(
            "a {name} has {what}, not {}",
            counted(list.len(), "number")
        )))
    };
    Ok(match (name, list.len()) {
        ("plane", 4) => Solid::Plane(Plane::new(vector(0), list[3])?),
        ("plane", _) => return needs("4 numbers (normal, distance)"),
        ("slab", 5) => Solid::Slab {
            plane: Plane::new(vector(0), list[3])?,
            thickness: list[4],
        },
        ("slab", _) => return needs("5 numbers (normal, distance, thickness)"),
        ("box", 6 | 10) => Solid::Cuboid {
            centre: vector(0),
            half: vector(3),
            rotation,
        },
        ("box", _) => {
            return needs("6 numbers (centre, half sizes) or 10 (and a quaternion w,x,y,z)");
        }
        ("sphere", 4) => Solid::Sphere {
            centre: vector(0),
            radius: list[3],
        },
        ("sphere", _) => return needs("4 numbers (centre, radius)"),
        ("ellipsoid", 6 | 10) => Solid::Ellipsoid {
            centre: vector(0),
            radii: vector(3),
            rotation,
        },
        ("ellipsoid", _) => {
            return needs("6 numbers (centre, radii) or 10 (and a quaternion w,x,y,z)");
        }
        ("cylinder", 7) => Solid::Cylinder {
            from: vector(0),
            to: vector(3),
            radius: list[6],
        },
        ("cylinder", _) => return needs("7 numbers (two ends of the axis, radius)"),
        ("capsule", 7) => Solid::Capsule {
            from: vector(0),
            to: vector(3),
            radius: list[6],
        },
        ("capsule", _) => return needs("7 numbers (two ends of the axis, radius)"),
        (_, 7) => Solid::Cone {
            apex: vector(0),
            base: vector(3),
            radius: list[6],
        },
        _ => return needs("7 numbers (apex, centre of the base, radius of the base)"),
    })
}

/// The text that it parses from.
impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let turned = |q: DQuat| match q == DQuat::IDENTITY {
            true => String::new(),
            false => format!(",{},{},{},{}", q.w, q.x, q.y, q.z),
        };
        f.write_str(if self.is_outside() { "!" } else { "" })?;
        match self.solid() {
            Solid::Plane(plane) => write!(f, "plane:{},{}", list(plane.normal()), plane.offset()),
            Solid::Slab { plane, thickness } => {
                let normal = list(plane.normal());
                write!(f, "slab:{normal},{},{thickness}", plane.offset())
            }
            Solid::Cuboid {
                centre,
                half,
                rotation,
            } => write!(f, "box:{},{}{}", list(centre), list(half), turned(rotation)),
            Solid::Sphere { centre, radius } => write!(f, "sphere:{},{radius}", list(centre)),
            Solid::Ellipsoid {
                centre,
                radii,
                rotation,
            } => {
                let (centre, radii) = (list(centre), list(radii));
                write!(f, "ellipsoid:{centre},{radii}{}", turned(rotation))
            }
            Solid::Cylinder { from, to, radius } => {
                write!(f, "cylinder:{},{},{radius}", list(from), list(to))
            }
            Solid::Capsule { from, to, radius } => {
                write!(f, "capsule:{},{},{radius}", list(from), list(to))
            }
            Solid::Cone { apex, base, radius } => {
                write!(f, "cone:{},{},{radius}", list(apex), list(base))
            }
        }
    }
}

/// Numbers between commas, all finite; blanks around them are allowed.
///
/// # Errors
/// [`Error::Invalid`] for anything else.
#[cfg_attr(not(feature = "lab"), allow(unreachable_pub))]
pub fn numbers(text: &str) -> Result<Vec<f64>> {
    text.split(',')
        .map(|part| match part.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(Error::Invalid(format!(
                "'{}' is not a finite number",
                shortened(part)
            ))),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused_and_says_what_is_missing() {
        for (text, words) in [
            ("", "no shape"),
            ("plane", "no shape"),
            ("plane:1,2,3", "4 numbers"),
            ("plane:0,0,0,1", "normal"),
            ("plane:nan,0,0,1", "'nan'"),
            ("slab:0,0,1,0,0", "thickness"),
            ("box:0,0,0,1,1", "6 numbers"),
            ("box:0,0,0,1,0,1", "above zero"),
            ("box:0,0,0,1,1,1,0,0,0,0", "quaternion"),
            ("sphere:0,0,0,-1", "above zero"),
            ("cylinder:0,0,0,0,0,0,1", "axis"),
            ("capsule:0,0,0,1", "7 numbers"),
            ("cone:0,0,0,1,1,1,0", "above zero"),
            ("torus:1", "plane, slab, box"),
        ] {
            let message = text.parse::<Shape>().unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
    }
}
