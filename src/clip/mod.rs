//! The region that a clip keeps: surfaces, of which each keeps one side, and how they combine.

#![forbid(unsafe_code)]

#[cfg(feature = "json")]
mod file;
mod plane;
mod shape;
mod surface;

#[cfg(feature = "json")]
pub use file::{NamedPlane, load_planes, planes_from_json};
pub use plane::Plane;
pub use shape::Shape;
#[cfg(feature = "lab")]
pub use shape::numbers;
pub use surface::Surface;

/// How several surfaces combine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum ClipOp {
    /// Visible where every surface keeps it (an intersection).
    #[default]
    And,
    /// Visible where any surface keeps it (a union).
    Or,
}

impl ClipOp {
    /// The operation that joins complements: what a union leaves out is what all of its parts leave out.
    #[must_use]
    pub fn dual(self) -> Self {
        match self {
            Self::And => Self::Or,
            Self::Or => Self::And,
        }
    }
}

/// The region that stays visible. No surfaces means that everything does.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clip {
    /// The surfaces that bound it, at most [`MAX_SURFACES`](Self::MAX_SURFACES).
    pub surfaces: Vec<Surface>,
    /// How they combine.
    pub op: ClipOp,
}

impl Clip {
    /// The most surfaces that a clip can have. Raising it lengthens the cutoff records of such clips.
    pub const MAX_SURFACES: usize = 32;

    /// The clip of these surfaces.
    ///
    /// ```
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
        }
    }
}
