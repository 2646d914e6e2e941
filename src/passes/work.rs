//! Finds which part of an eye's frame has to be computed, and compares data.

use bytemuck::bytes_of;

/// The part of an eye's frame that has to be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Work {
    /// Everything that the eye has a part in.
    Whole,
    /// The eye stands still and the clip has moved: the sides that change, and what follows from them.
    Reclip {
        /// True when the Gaussians in view, clipped away or not, have to be found first.
        base: bool,
        /// True when no clip has changed them yet.
        fresh: bool,
    },
    /// Nothing has changed: the draw alone.
    Draw,
}

/// Compares bytes, by which a number that is none equals itself.
pub(super) fn same<T: bytemuck::NoUninit>(a: &T, b: &T) -> bool {
    bytes_of(a) == bytes_of(b)
}
