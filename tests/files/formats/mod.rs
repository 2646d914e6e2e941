//! Formats beside 3DGS `.ply`: what other programs wrote, and what is written here, is the scene that it was.

mod collected;
mod damaged;
mod detected;
mod distance;
mod harmonics;
mod khr;
mod truth;
mod variants;
mod written;

use std::io::Cursor;
use std::path::Path;

use rara::scene::{SceneFile, load_from};

fn load_bytes(bytes: &[u8]) -> rara::Result<SceneFile> {
    load_from(Cursor::new(bytes), Path::new("entry"), &mut |_, _| ())
}
