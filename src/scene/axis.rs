//! The axes of a scene, as they are called.

use glam::DVec3;

use crate::clip::numbers_of;

/// An axis of the scene, and how a section across it is seen. The sides are those from which a radiologist looks at a patient
/// in DICOM's coordinates, whose x points to the patient's left, y to the back and z to the head.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name as it was written, with its `!`.
    pub name: String,
    /// The direction in which positions along the axis grow.
    pub along: DVec3,
    /// The view's direction, along the axis or against it.
    pub forward: DVec3,
    /// The direction that is up in the picture.
    pub up: DVec3,
}

impl Axis {
    /// An axis by its letter or its name: `x` or `sagittal`, `y` or `coronal`, `z` or `axial`; with a leading `!` it is seen from
    /// the other side.
    pub fn parse(typed: &str) -> Option<Self> {
        let (axis, sign) = match typed.strip_prefix('!') {
            Some(axis) => (axis, -1.0),
            None => (typed, 1.0),
        };
        let (along, forward, up) = match axis {
            "x" | "sagittal" => (DVec3::X, DVec3::NEG_X, DVec3::Z),
            "y" | "coronal" => (DVec3::Y, DVec3::Y, DVec3::Z),
            "z" | "axial" => (DVec3::Z, DVec3::Z, DVec3::NEG_Y),
            _ => return None,
        };
        Some(Self {
            name: typed.into(),
            along,
            forward: sign * forward,
            up,
        })
    }
}

/// The direction of a text: `x,y,z`, not all zero, or an axis as `y`, `+y` or `-z`.
pub fn direction(text: &str) -> Result<DVec3, String> {
    let (sign, axis) = match text.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    match axis {
        "x" => return Ok(sign * DVec3::X),
        "y" => return Ok(sign * DVec3::Y),
        "z" => return Ok(sign * DVec3::Z),
        _ => {}
    }
    let vector = numbers_of(text)
        .map_err(|error| format!("{error}; give three numbers, or an axis such as y or -z"))?;
    match DVec3::from_array(vector) {
        DVec3::ZERO => Err("a direction cannot be zero".into()),
        vector => Ok(vector),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_two_names_and_two_sides() {
        for (one, other) in [("x", "sagittal"), ("y", "coronal"), ("z", "axial")] {
            let [one, other] = [one, other].map(|name| Axis::parse(name).expect("an axis"));
            assert_eq!(
                (one.along, one.forward, one.up),
                (other.along, other.forward, other.up)
            );
            let turned = Axis::parse(&format!("!{}", one.name)).expect("its other side");
            assert_eq!((turned.along, turned.forward), (one.along, -one.forward));
            assert_eq!(one.forward.dot(one.up), 0.0);
        }
        assert!(Axis::parse("w").is_none() && Axis::parse("!!x").is_none());
    }

    #[test]
    fn directions_are_axes_or_numbers() {
        assert!(direction("0,0,-0").is_err() && direction("w").is_err());
        assert_eq!(direction("-z"), Ok(DVec3::NEG_Z));
        assert_eq!(
            (direction("y"), direction("+y")),
            (Ok(DVec3::Y), Ok(DVec3::Y))
        );
        assert_eq!(direction("1, 0,-2"), Ok(DVec3::new(1.0, 0.0, -2.0)));
    }
}
