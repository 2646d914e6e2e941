//! The region that a clip keeps: its surfaces, and the questions that the stages ask of it. Each has a file here, beside the
//! file of the same name in `glsl/region/`.

mod box_side;
mod combination;
mod crossing;
mod ellipsoid;
mod face_mass;
mod gaussian_side;
mod half_space;
mod inside;
mod lines;
mod plane;
mod quadric;
mod reduced;
mod region_surface;
mod share;
mod sides;
mod surface;
#[cfg(test)]
mod tests;

pub use box_side::{Bounds, box_side};
pub use combination::Combination;
pub(super) use crossing::Sight;
pub use ellipsoid::Ellipsoid;
pub use gaussian_side::gaussian_side;
pub use half_space::HalfSpace;
pub use inside::UnitInside;
pub use quadric::{Symmetric, UnitSurface};
pub(super) use reduced::reduced;
pub use reduced::{RegionRest, RestSurface};
pub use share::share;
pub(super) use sides::keeps;
pub(super) use surface::{surface_crossings, surface_gaussian_side, surface_half_space};

/// The side of a Gaussian: the paper's three classes, and culled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Outside the view or too faint, whatever the clip says.
    Culled,
    /// In view and untouched.
    Visible,
    Cutoff,
    /// In view but wholly clipped away.
    Invisible,
}
