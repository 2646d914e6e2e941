//! Surfaces: what a clip is made of. A kind of surface is a `SurfaceKind` and a row of `surfaces!`.

use std::cmp::Ordering;

use glam::DVec3;

use super::surface_kind::SurfaceKind;
use super::{Plane, Quadric};
use crate::placement::Placement;

/// Defines the kinds of surfaces, and `each_surface!`, which has one expression for all of them.
macro_rules! surfaces {
    (($d:tt) $($(#[$doc:meta])+ $kind:ident,)+) => {
        /// A surface that divides space into what it keeps and what it does not.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Surface {
            $($(#[$doc])+ $kind($kind),)+
        }

        impl Surface {
            /// The place of its kind among the kinds.
            fn kind(&self) -> Option<usize> {
                [$(matches!(self, Self::$kind(_))),+].iter().position(|is| *is)
            }
        }

        $(
            impl From<$kind> for Surface {
                fn from(surface: $kind) -> Self {
                    Self::$kind(surface)
                }
            }
        )+

        /// The value of an expression of a surface, of whatever kind it is.
        #[doc(hidden)]
        #[macro_export]
        macro_rules! each_surface {
            ($d surface:expr, $d kind:ident => $d value:expr) => {
                match $d surface {
                    $($crate::clip::Surface::$kind($d kind) => $d value,)+
                }
            };
        }
    };
}

surfaces! { ($)
    /// Keeps a half-space.
    Plane,
    /// Keeps one side of a quadric.
    Quadric,
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

    /// The same surface as a scene with this placement sees it.
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
        let of_kinds = self.kind().cmp(&other.kind());
        of_kinds.then_with(|| {
            orders
                .find(|order| order.is_ne())
                .unwrap_or(Ordering::Equal)
        })
    }
}
