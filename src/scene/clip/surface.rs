//! Surfaces: what a clip is made of. A kind of surface is a `SurfaceKind`, and an arm of `each_surface!`.

use std::cmp::Ordering;

use glam::DVec3;

use super::surface_kind::SurfaceKind;
use super::{Inside, Plane, Quadric};
use crate::placement::Placement;

/// A surface that divides space into what it keeps and what it does not.
#[derive(Debug, Clone, PartialEq)]
pub enum Surface {
    /// Keeps a half-space.
    Plane(Plane),
    /// Keeps one side of a quadric.
    Quadric(Quadric),
    /// Keeps the inside of a mesh, or its outside.
    Inside(Inside),
}

/// The value of an expression of a surface, of whatever kind it is.
#[doc(hidden)]
#[macro_export]
macro_rules! each_surface {
    ($surface:expr, $kind:ident => $value:expr) => {
        match $surface {
            $crate::clip::Surface::Plane($kind) => $value,
            $crate::clip::Surface::Quadric($kind) => $value,
            $crate::clip::Surface::Inside($kind) => $value,
        }
    };
}

impl Surface {
    /// The surface that keeps what this one does not.
    #[must_use]
    pub fn complement(&self) -> Self {
        each_surface!(self, surface => surface.complement().into())
    }

    /// A measure of how far a point is from the surface, world units: positive where the surface keeps the point. For a
    /// plane it is the signed distance; for a quadric it is close to that near the surface.
    pub fn distance(&self, point: DVec3) -> f64 {
        each_surface!(self, surface => surface.distance(point))
    }

    /// How [`distance`](Self::distance) grows at a point: the surface's normal, near it of length 1.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        each_surface!(self, surface => surface.gradient(point))
    }

    /// Returns the surface in the space of a scene that has this placement.
    #[must_use]
    pub fn in_scene(&self, placement: &Placement) -> Self {
        each_surface!(self, surface => surface.in_scene(placement).into())
    }

    /// The plane, if the surface is one; for callers that handle nothing else.
    pub fn as_plane(&self) -> Option<Plane> {
        match *self {
            Self::Plane(plane) => Some(plane),
            _ => None,
        }
    }

    /// The order in which surfaces stand in every list.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let numbers = |one: &Self| each_surface!(one, surface => surface.numbers());
        let pairs = numbers(self).into_iter().zip(numbers(other));
        let mut orders = pairs.map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0))); // -0 is 0
        let kind = |one: &Self| match one {
            Self::Plane(_) => 0,
            Self::Quadric(_) => 1,
            Self::Inside(_) => 2,
        };
        let of_kinds = kind(self).cmp(&kind(other));
        of_kinds.then_with(|| {
            orders
                .find(|order| order.is_ne())
                .unwrap_or(Ordering::Equal)
        })
    }
}

impl From<Plane> for Surface {
    fn from(plane: Plane) -> Self {
        Self::Plane(plane)
    }
}

impl From<Inside> for Surface {
    fn from(inside: Inside) -> Self {
        Self::Inside(inside)
    }
}

impl From<Quadric> for Surface {
    fn from(quadric: Quadric) -> Self {
        Self::Quadric(quadric)
    }
}
