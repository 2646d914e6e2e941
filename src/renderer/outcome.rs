//! What whoever submits a frame says of it before, and reads of it afterwards.

/// How a frame is submitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Submission {
    /// While earlier ones are unfinished. One whose tiles' lists have no room is drawn as quads: the same picture, but
    /// slower.
    InFlight,
    /// When all earlier ones are finished, and it is waited for itself. Nothing is drawn of one whose tiles' lists have no
    /// room: it is submitted once more, with more room or as quads.
    Awaited,
}

/// What has become of a frame that was waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Its picture is there.
    Drawn,
    /// The tiles' lists had no room. Configured once more it has the room, or needs none.
    NeedsRoom,
    /// Its picture is that of the frame before, and nothing was computed for it.
    Unchanged,
}
