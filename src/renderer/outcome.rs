//! How a frame is submitted, and its outcome: who submits it states the one before and reads the other afterwards.

use rara_base::error::Error;
use rara_scene::settings::{Settings, Show};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Submission {
    /// It is submitted while earlier ones are unfinished. If its tiles' lists have no room, it is drawn as quads: the same
    /// picture, but slower.
    InFlight,
    /// It is submitted when all earlier ones are finished, and waited for itself. If its tiles' lists have no room, nothing
    /// is drawn, and it is submitted again, with more room or as quads.
    Awaited,
}

/// The outcome of a frame that was waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// Its picture is there.
    Drawn,
    /// The tiles' lists had no room, so that it was drawn in a slower way or not at all. Configured once more, the frame has the
    /// room, or needs none.
    NeedsRoom,
    /// The tiles' lists had no room, there is none to be made, and only tiles show what is asked for: nothing was drawn.
    NoRoom,
    /// Its picture is that of the frame before, and nothing was computed for it.
    Unchanged,
}

impl Outcome {
    /// The error of a picture of which this is [`NoRoom`](Self::NoRoom).
    #[doc(hidden)]
    pub fn no_room(settings: &Settings) -> Error {
        let made = match settings.show {
            Show::Colour => "what ColorSpace::Linear asks for is".into(),
            show => format!("Show::{show:?} is"),
        };
        Error::Memory(format!(
            "the tiles' lists are larger than there is room for, and {made} made by tiles alone; raise the memory budget or the \
             pairs that were reserved, draw a smaller picture, or fewer splats"
        ))
    }
}
