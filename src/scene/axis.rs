//! The axes of a scene, as they are called.

use glam::DVec3;

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
}
