//! The part of a frame that has to be computed.

use bytemuck::bytes_of;

/// The part of a frame that has to be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Work {
    /// Everything, but for the clip's sides where those in the buffers hold.
    Whole {
        /// True when the clip's sides have to be found.
        clip: bool,
    },
    /// The camera stands still and the clip has moved: the sides that change, and what follows from them.
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
