//! Surfaces: what a clip is made of.

use glam::DVec3;

use super::{Plane, Quadric};

/// A surface that divides space into what it keeps and what it does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Keeps a half-space.
    Plane(Plane),
    /// Keeps one side of a quadric.
    Quadric(Quadric),
}

impl Surface {
    /// The surface that keeps what this one does not.
    #[must_use]
    pub fn complement(&self) -> Self {
        match self {
            Self::Plane(plane) => plane.flipped().into(),
            Self::Quadric(quadric) => quadric.flipped().into(),
        }
    }

    /// A measure of how far a point is from the surface, world units: positive where the surface keeps the point. For a
    /// plane it is the signed distance; for a quadric it is close to that near the surface.
    pub fn distance(&self, point: DVec3) -> f64 {
        match self {
            Self::Plane(plane) => plane.distance(point),
            Self::Quadric(quadric) => quadric.distance(point),
        }
    }

    /// How [`distance`](Self::distance) grows at a point: the surface's normal, near it of length 1.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Plane(plane) => plane.normal(),
            Self::Quadric(quadric) => quadric.gradient(point),
        }
    }

    /// The plane, if the surface is one; for callers that handle nothing else.
    pub fn as_plane(&self) -> Option<Plane> {
        match *self {
            Self::Plane(plane) => Some(plane),
            Self::Quadric(_) => None,
        }
    }
}

impl From<Plane> for Surface {
    fn from(plane: Plane) -> Self {
        Self::Plane(plane)
    }
}

impl From<Quadric> for Surface {
    fn from(quadric: Quadric) -> Self {
        Self::Quadric(quadric)
    }
}
