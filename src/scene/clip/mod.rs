//! The region that a clip keeps: surfaces, of which each keeps one side, and how they combine.

mod between;
#[cfg(feature = "json")]
mod clip_file;
mod expression;
#[cfg(feature = "json")]
mod geojson;
mod inside;
mod lasso;
mod leaf;
mod mesh_shape;
mod outline;
mod parameter;
mod placed;
mod plane;
#[doc(hidden)]
pub mod postfix;
mod prism;
mod quadric;
mod shape;
mod shape_text;
mod solid;
mod surface;
mod surface_kind;

#[cfg(feature = "json")]
#[doc(hidden)]
pub use clip_file::are_alternatives;
#[cfg(feature = "json")]
pub use clip_file::{NamedClip, clips_from_json, clips_to_json, load_clips};
pub use expression::Expression;
pub use inside::Inside;
pub use lasso::Lasso;
pub use mesh_shape::MeshShape;
pub use parameter::Parameter;
pub use plane::Plane;
pub use prism::{Prism, PrismBase};
pub use quadric::Quadric;
pub use shape::Shape;
#[doc(hidden)]
pub use shape_text::{numbers, numbers_of};
pub use solid::Solid;
pub use surface::Surface;

use glam::DVec3;

use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::named;

named! {
    /// How several shapes or surfaces combine.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum ClipOp {
        /// A point is visible if all of them keep it (an intersection).
        #[default]
        And = "and",
        /// A point is visible if at least one of them keeps it (a union).
        Or = "or",
    }
}

impl ClipOp {
    /// Returns the operation that combines complements: the complement of a union is the intersection of the complements.
    #[must_use]
    pub fn dual(self) -> Self {
        match self {
            Self::And => Self::Or,
            Self::Or => Self::And,
        }
    }
}

/// The region that stays visible. It is an intersection or a union of the sides that surfaces keep and of further regions of
/// the same kind. An empty one keeps everything.
///
/// Any expression of `and`, `or` and `not` is such a region, since the complement of an intersection is the union of the
/// complements, and the complement of a surface is a surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clip {
    /// The surfaces of the region.
    pub surfaces: Vec<Surface>,
    /// How the surfaces and the parts combine.
    pub op: ClipOp,
    /// The regions that are combined with the surfaces. None of them is empty.
    pub parts: Vec<Clip>,
}

impl Clip {
    /// The most surfaces of a region and its parts together.
    pub const MAX_SURFACES: usize = 1 << 16;
    /// The most levels of parts within parts.
    pub const MAX_DEPTH: usize = 64;

    /// Makes a clip of surfaces.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Clip, ClipOp, Plane, glam::DVec3};
    ///
    /// let clip = Clip::of([Plane::new(DVec3::X, 0.0)?, Plane::new(DVec3::Y, -1.0)?], ClipOp::And);
    /// assert_eq!(clip.surfaces[1].distance(DVec3::ZERO), -1.0);
    /// # Ok::<(), rara::Error>(())
    /// ```
    pub fn of(surfaces: impl IntoIterator<Item = impl Into<Surface>>, op: ClipOp) -> Self {
        Self {
            surfaces: surfaces.into_iter().map(Into::into).collect(),
            op,
            parts: Vec::new(),
        }
    }

    /// Combines regions into one: it keeps what all of them keep, or what any of them keeps. A single region is returned as it
    /// is.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Clip, ClipOp, Shape, glam::DVec3};
    ///
    /// let (ball, block): (Shape, Shape) = ("sphere:0,0,0,1".parse()?, "!box:0,0,0,.5,.5,.5".parse()?);
    /// let clip = Clip::joined([ball.clip(), block.clip()], ClipOp::And);
    /// assert!(clip.keeps(DVec3::X * 0.7) && !clip.keeps(DVec3::ZERO));
    /// # Ok::<(), rara::Error>(())
    /// ```
    pub fn joined(clips: impl IntoIterator<Item = Clip>, op: ClipOp) -> Self {
        let mut clips: Vec<Clip> = clips.into_iter().collect();
        if clips.len() == 1 {
            return clips.remove(0);
        }
        if op == ClipOp::Or && clips.iter().any(Clip::is_everything) {
            return Self::default();
        }
        let mut joined = Self {
            op,
            ..Self::default()
        };
        for clip in clips {
            let alone = clip.surfaces.len() + clip.parts.len() == 1;
            if clip.op == op || alone || clip.is_everything() {
                joined.surfaces.extend(clip.surfaces);
                joined.parts.extend(clip.parts);
            } else {
                joined.parts.push(clip);
            }
        }
        joined
    }

    /// True when nothing is clipped away.
    pub fn is_everything(&self) -> bool {
        self.surfaces.is_empty() && self.parts.is_empty()
    }

    /// True when surfaces are all that there is, so that one operation joins them.
    pub fn is_flat(&self) -> bool {
        self.parts.is_empty()
    }

    /// That its surfaces can be counted, and that no part is empty.
    ///
    /// # Errors
    /// [`Error::Invalid`] where that is not so.
    #[doc(hidden)]
    pub fn check(&self) -> Result<()> {
        fn count(clip: &Clip, depth: usize) -> Option<usize> {
            let parts = clip.parts.iter().map(|part| match part.is_everything() {
                true => None,
                false if depth == Clip::MAX_DEPTH => None,
                false => count(part, depth + 1),
            });
            parts
                .sum::<Option<usize>>()
                .map(|sum| sum + clip.surfaces.len())
        }
        match count(self, 0) {
            Some(count) if count <= Self::MAX_SURFACES => Ok(()),
            Some(count) => Err(Error::Invalid(format!(
                "a clip of {} is beyond the {} that one may have; use fewer",
                counted(count, "surface"),
                Self::MAX_SURFACES
            ))),
            None => Err(Error::Invalid(format!(
                "a clip with an empty part, or with parts within parts beyond {} levels, means nothing; leave such parts out",
                Self::MAX_DEPTH
            ))),
        }
    }

    /// True when splats are weighed as combinations of surfaces that may bend, and not by a list of planes.
    #[doc(hidden)]
    pub fn is_general(&self) -> bool {
        let bends = self.surfaces.iter().any(|s| s.as_plane().is_none());
        !self.is_flat() || bends
    }

    /// True when the region keeps a point. A surface's own points are kept.
    pub fn keeps(&self, point: DVec3) -> bool {
        let surfaces = self.surfaces.iter().map(|s| s.distance(point) >= 0.0);
        let mut kept = surfaces.chain(self.parts.iter().map(|part| part.keeps(point)));
        self.is_everything()
            || match self.op {
                ClipOp::And => kept.all(|k| k),
                ClipOp::Or => kept.any(|k| k),
            }
    }

    /// Returns the region that keeps what this one does not. The complement of a region that keeps everything would be empty;
    /// as no region can be empty, it is everything again.
    #[must_use]
    pub fn complement(&self) -> Self {
        Self {
            surfaces: self.surfaces.iter().map(Surface::complement).collect(),
            op: self.op.dual(),
            parts: self.parts.iter().map(Clip::complement).collect(),
        }
    }

    /// All surfaces of the region and of its parts.
    pub fn all_surfaces(&self) -> Vec<Surface> {
        let mut all = self.surfaces.clone();
        all.extend(self.parts.iter().flat_map(Clip::all_surfaces));
        all
    }

    /// The same region with its surfaces changed.
    #[doc(hidden)]
    pub fn map(&self, change: &dyn Fn(&Surface) -> Surface) -> Self {
        Self {
            surfaces: self.surfaces.iter().map(change).collect(),
            op: self.op,
            parts: self.parts.iter().map(|part| part.map(change)).collect(),
        }
    }
}
