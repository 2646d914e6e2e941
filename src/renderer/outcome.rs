//! How a frame is submitted, and its outcome: who submits it states the one before and reads the other afterwards.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Submission {
    /// It is submitted while earlier ones are unfinished.
    InFlight,
    /// It is submitted when all earlier ones are finished, and waited for itself.
    Awaited,
}

/// The outcome of a frame that was waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// Its picture is there.
    Drawn,
    /// Its picture is that of the frame before, and nothing was computed for it.
    Unchanged,
}
