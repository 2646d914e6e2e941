//! Pictures between drawing and writing.

use std::path::PathBuf;

use rara::{Channel, Picture, StoredPicture};

use super::super::report::FrameRecord;

/// A picture that was drawn, and what it took.
pub(in super::super) struct RenderedPicture {
    pub(in super::super) frame: FrameRecord,
    /// The frames that it is made of, if they are several.
    pub(in super::super) faces: Vec<FrameRecord>,
    /// The pixels; none where they go nowhere.
    pub(in super::super) picture: Option<Pixels>,
    pub(in super::super) channels: Vec<Channel>,
}

/// A picture that a thread may have to decode before it encodes it.
pub(in super::super) enum Pixels {
    Stored(StoredPicture),
    Decoded(Picture),
}

impl Pixels {
    pub(super) fn picture(self) -> Picture {
        match self {
            Self::Stored(stored) => stored.decode(),
            Self::Decoded(picture) => picture,
        }
    }
}

impl From<FrameRecord> for RenderedPicture {
    fn from(frame: FrameRecord) -> Self {
        Self {
            frame,
            faces: Vec::new(),
            picture: None,
            channels: Vec::new(),
        }
    }
}

/// The frames and files of a run, once all pictures are drawn.
#[derive(Default)]
pub(in super::super) struct WrittenPictures {
    pub(in super::super) pictures: Vec<FrameRecord>,
    /// The frames that these are made of, where they are several each.
    pub(in super::super) faces: Vec<FrameRecord>,
    pub(in super::super) files: Vec<PathBuf>,
}
