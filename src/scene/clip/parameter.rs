//! The parameters of solids: what numbers mean, so that all solids are read, written, moved and mixed by the same code.

use glam::{DQuat, DVec3};

use super::Plane;
use crate::bounds::Bounds;
use rara_base::error::Result;

/// Numbers of a [`Solid`](super::Solid) that belong together, by what they mean. Lengths are world units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Parameter {
    /// A plane; the solid is on the side that the plane keeps.
    Plane(Plane),
    /// A point.
    Point(DVec3),
    /// Lengths along the solid's own axes.
    Sizes(DVec3),
    /// A length.
    Size(f64),
    /// The rotation of the solid's own axes.
    Rotation(DQuat),
}

/// The kind of a parameter.
#[derive(Debug, Clone, Copy)]
pub(super) enum Role {
    Plane,
    Point,
    Sizes,
    Size,
    Rotation,
}

impl Role {
    /// How many numbers it has.
    pub(super) fn count(self) -> usize {
        self.fields("").iter().map(|(_, count)| count).sum()
    }

    /// The fields that hold a parameter of this name in JSON, and how many numbers each has. A rotation may be left out.
    pub(super) fn fields(self, name: &'static str) -> Vec<(&'static str, usize)> {
        match self {
            Self::Plane => vec![("normal", 3), ("d", 1)],
            Self::Point | Self::Sizes => vec![(name, 3)],
            Self::Size => vec![(name, 1)],
            Self::Rotation => vec![(name, 4)],
        }
    }

    /// Returns what 0 % and 100 % of its number at an index mean in these bounds: the ends of an axis for a point, and for a
    /// length from nothing to the extent along that axis, or to the longest extent. `None` for numbers that are no lengths.
    pub(super) fn share(self, index: usize, bounds: &Bounds) -> Option<[f64; 2]> {
        let extent = bounds.max - bounds.min;
        match self {
            Self::Point => Some([bounds.min[index], bounds.max[index]]),
            Self::Sizes => Some([0.0, extent[index]]),
            Self::Size => Some([0.0, extent.max_element()]),
            Self::Plane | Self::Rotation => None,
        }
    }

    /// The parameter that is made of its numbers; a rotation without any turns nothing.
    pub(super) fn parameter(self, numbers: &[f64]) -> Result<Parameter> {
        let vector = || DVec3::from_slice(numbers);
        Ok(match self {
            Self::Plane => Parameter::Plane(Plane::new(vector(), numbers[3])?),
            Self::Point => Parameter::Point(vector()),
            Self::Sizes => Parameter::Sizes(vector()),
            Self::Size => Parameter::Size(numbers[0]),
            Self::Rotation => Parameter::Rotation(match *numbers {
                [w, x, y, z] => DQuat::from_xyzw(x, y, z, w),
                _ => DQuat::IDENTITY,
            }),
        })
    }
}

impl Parameter {
    /// The numbers that it is made of; none for a rotation that turns nothing.
    pub(super) fn numbers(self) -> Vec<f64> {
        match self {
            Self::Plane(plane) => [&plane.normal().to_array()[..], &[plane.offset()]].concat(),
            Self::Point(vector) | Self::Sizes(vector) => vector.to_array().to_vec(),
            Self::Size(size) => vec![size],
            Self::Rotation(q) if q == DQuat::IDENTITY => Vec::new(),
            Self::Rotation(q) => vec![q.w, q.x, q.y, q.z],
        }
    }
}
