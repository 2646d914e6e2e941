//! What was drawn, and where it went.

use std::path::PathBuf;

use rara::{Channel, Picture};

use super::super::report::Frame;

/// What was drawn for one picture.
pub(in super::super) struct Drawn {
    /// What is reported of it.
    pub(in super::super) frame: Frame,
    /// The frames that it is made of, if they are several.
    pub(in super::super) faces: Vec<Frame>,
    /// None where it goes nowhere.
    pub(in super::super) picture: Option<Picture>,
    /// Beside its colours.
    pub(in super::super) channels: Vec<Channel>,
}

/// What goes nowhere.
impl From<Frame> for Drawn {
    fn from(frame: Frame) -> Self {
        Self {
            frame,
            faces: Vec::new(),
            picture: None,
            channels: Vec::new(),
        }
    }
}

/// What is known of a run's pictures when all are drawn.
#[derive(Default)]
pub(in super::super) struct Written {
    /// A frame for each picture.
    pub(in super::super) pictures: Vec<Frame>,
    /// The frames that these are made of, where they are several each.
    pub(in super::super) faces: Vec<Frame>,
    pub(in super::super) files: Vec<PathBuf>,
}
