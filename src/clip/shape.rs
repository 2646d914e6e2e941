//! Shapes as surfaces, and their textual form: `plane:nx,ny,nz,d`, `box:cx,cy,cz,hx,hy,hz[,qw,qx,qy,qz]`.

use std::fmt;
use std::str::FromStr;

use glam::{DQuat, DVec3};

use super::{Clip, ClipOp, Plane, Surface};
use crate::error::{Error, Result, shortened};

/// A shape, held as the surfaces that bound what it keeps. It parses from text; a leading `!` keeps the outside.
///
/// ```
/// use rara::{Clip, ClipOp, clip::Shape};
///
/// let shapes: Vec<Shape> = vec!["plane:0,0,1,-2".parse()?, "box:0,0,3,1,1,1".parse()?];
/// let clip = Clip::of_shapes(&shapes, ClipOp::And)?;
/// assert_eq!(clip.surfaces.len(), 7);
/// # Ok::<(), rara::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    surfaces: Vec<Surface>,
    /// How the shape's own surfaces combine; a single surface fits either way and has `And`.
    op: ClipOp,
}

impl Shape {
    /// The inside of a box: its centre, half its sizes along its own axes, and its rotation.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a size that is not above zero, a rotation that is zero and numbers that are not finite.
    pub fn cuboid(centre: DVec3, half: DVec3, rotation: DQuat) -> Result<Self> {
        if half.min_element() <= 0.0 {
            return Err(Error::Invalid("a box's half sizes are above zero".into()));
        }
        let largest = rotation.to_array().into_iter().map(f64::abs);
        let largest = largest.fold(0.0, f64::max);
        if largest == 0.0 {
            return Err(Error::Invalid("a box's quaternion cannot be zero".into()));
        }
        // The largest component is divided out first, which keeps the squares of tiny and huge ones in range.
        let turn = DQuat::from_array(rotation.to_array().map(|v| v / largest)).normalize();
        let side = |index: usize| {
            let inward = if index < 3 { -1.0 } else { 1.0 };
            let normal = turn * (DVec3::AXES[index % 3] * inward);
            Plane::new(normal, half[index % 3] - normal.dot(centre)).map(Surface::from)
        };
        Ok(Self {
            surfaces: (0..6).map(side).collect::<Result<_>>()?,
            op: ClipOp::And,
        })
    }

    /// The surfaces that bound the shape.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// How they combine: the inside of a box is kept where all of them keep a point, its outside where any does.
    pub fn op(&self) -> ClipOp {
        self.op
    }

    /// The shape that keeps what this one does not.
    #[must_use]
    pub fn complement(mut self) -> Self {
        for surface in &mut self.surfaces {
            *surface = surface.complement();
        }
        if self.surfaces.len() > 1 {
            self.op = self.op.dual();
        }
        self
    }
}

impl From<Surface> for Shape {
    fn from(surface: Surface) -> Self {
        Self {
            surfaces: vec![surface],
            op: ClipOp::And,
        }
    }
}

impl From<Plane> for Shape {
    fn from(plane: Plane) -> Self {
        Surface::from(plane).into()
    }
}

impl FromStr for Shape {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match text.strip_prefix('!') {
            Some(shape) => inside(shape).map(Self::complement),
            None => inside(text),
        }
    }
}

/// The text of a shape that has this surface alone.
impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plane(plane) => {
                let (n, d) = (plane.normal(), plane.offset());
                write!(f, "plane:{},{},{},{d}", n.x, n.y, n.z)
            }
        }
    }
}

fn inside(text: &str) -> Result<Shape> {
    let invalid = |message: String| Err(Error::Invalid(message));
    let Some((kind, numbers)) = text.split_once(':') else {
        return invalid("expected a shape like plane:1,0,0,-0.5 or box:0,0,0,1,1,1".into());
    };
    match kind {
        "plane" => match *self::numbers(numbers)? {
            [x, y, z, offset] => Ok(Plane::new(DVec3::new(x, y, z), offset)?.into()),
            ref list => invalid(format!(
                "expected 4 numbers with commas between them, found {}",
                list.len()
            )),
        },
        "box" => {
            let list = self::numbers(numbers)?;
            let rotation = match list[..] {
                [_, _, _, _, _, _] => DQuat::IDENTITY,
                [_, _, _, _, _, _, w, x, y, z] => DQuat::from_xyzw(x, y, z, w),
                _ => {
                    return invalid(format!(
                        "a box has 6 numbers (centre, half sizes) or 10 (and a quaternion w,x,y,z), not {}",
                        list.len()
                    ));
                }
            };
            let (centre, half) = (DVec3::from_slice(&list), DVec3::from_slice(&list[3..]));
            Shape::cuboid(centre, half, rotation)
        }
        "sphere" | "cylinder" => {
            invalid(format!("a {kind} is not implemented yet; use plane or box"))
        }
        _ => invalid(format!(
            "'{}' is not a shape; use plane or box",
            shortened(kind)
        )),
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

impl Clip {
    /// The clip that shapes make together: visible in all of them, or in any. A single shape has nothing to combine with,
    /// so its own operation holds.
    ///
    /// # Errors
    /// [`Error::Invalid`] if they do not fit one list of surfaces that one operation joins, or make more than
    /// [`Clip::MAX_SURFACES`].
    pub fn of_shapes(shapes: &[Shape], op: ClipOp) -> Result<Self> {
        let op = match shapes {
            [only] => only.op,
            _ => op,
        };
        if let Some(misfit) = shapes.iter().find(|s| s.surfaces.len() > 1 && s.op != op) {
            let (what, other) = match misfit.op {
                ClipOp::And => ("the inside of a box", "and"),
                ClipOp::Or => ("the outside of a box (!box)", "or"),
            };
            return Err(Error::Invalid(format!(
                "{what} cannot be combined with other shapes by '{}': a clip is half-spaces joined either all by 'and' \
                 or all by 'or', and {what} needs '{other}'",
                if op == ClipOp::And { "and" } else { "or" },
            )));
        }
        let surfaces: Vec<Surface> = shapes.iter().flat_map(|s| s.surfaces.clone()).collect();
        if surfaces.len() > Clip::MAX_SURFACES {
            return Err(Error::Invalid(format!(
                "the clip shapes make {} half-spaces (a box makes six), and a clip has at most {}",
                surfaces.len(),
                Clip::MAX_SURFACES
            )));
        }
        Ok(Self { surfaces, op })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_says_what_it_parses_from() {
        for text in ["plane:0,0,1,-2", "plane:-1,0,0,0.125"] {
            let shape: Shape = text.parse().unwrap();
            assert_eq!(shape.surfaces()[0].to_string(), text);
        }
    }

    #[test]
    fn a_complement_keeps_what_its_shape_does_not() {
        let shape: Shape = "box:1,2,3,1,1,1".parse().unwrap();
        let outside = shape.clone().complement();
        assert_eq!((shape.op(), outside.op()), (ClipOp::And, ClipOp::Or));
        for (inner, outer) in shape.surfaces().iter().zip(outside.surfaces()) {
            let point = DVec3::new(0.3, 2.1, 7.0);
            assert_eq!(inner.distance(point), -outer.distance(point));
            assert!(inner.distance(DVec3::new(1.0, 2.0, 3.0)) > 0.0);
            assert_eq!(outer.complement(), *inner);
        }
    }
}
