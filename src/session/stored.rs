//! A picture that was read back and is not decoded yet.

use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use crate::passes::TilePicture;
use rara_scene::picture::Picture;
use rara_scene::precision::TargetFormat;

/// The bytes of a picture as the device stores them.
#[derive(Debug, Clone, Copy)]
pub(super) struct PictureBytes<'a> {
    /// Where the lists of tiles begin, for a picture that tiles have made; empty for one that was drawn.
    pub(super) begins: &'a [u8],
    pub(super) pixels: &'a [u8],
    pub(super) extent: vk::Extent2D,
    pub(super) format: TargetFormat,
    /// True when they are linear light, which becomes what displays store.
    pub(super) linear: bool,
}

impl PictureBytes<'_> {
    pub(super) fn decode(&self) -> Picture {
        let Self {
            begins,
            pixels,
            extent,
            format,
            linear,
        } = *self;
        let mut picture = Picture {
            width: extent.width,
            height: extent.height,
            pixels: match begins.is_empty() {
                true => format.decode(pixels).collect(),
                false => TilePicture::decode(begins, pixels, extent, format),
            },
        };
        if linear {
            picture.store_light();
        }
        picture
    }
}

/// Memory of pictures that were decoded, for the next ones.
pub(super) type SpareMemory = Arc<Mutex<Vec<Vec<u8>>>>;

/// A picture that [`Headless::read_back`](super::Headless::read_back) has copied from the device. Any thread may decode it,
/// while the next frame is drawn.
#[derive(Debug)]
pub struct StoredPicture {
    /// All bytes, the tiles' begins before the pixels.
    bytes: Vec<u8>,
    begins: usize,
    extent: vk::Extent2D,
    format: TargetFormat,
    linear: bool,
    spare: SpareMemory,
}

impl StoredPicture {
    /// A copy in memory that an earlier one has left, if one has.
    pub(super) fn new(stored: PictureBytes<'_>, spare: &SpareMemory) -> Self {
        let memory = spare.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut bytes = memory.unwrap_or_default();
        bytes.clear();
        bytes.extend_from_slice(stored.begins);
        bytes.extend_from_slice(stored.pixels);
        Self {
            bytes,
            begins: stored.begins.len(),
            extent: stored.extent,
            format: stored.format,
            linear: stored.linear,
            spare: spare.clone(),
        }
    }

    /// The picture.
    pub fn decode(self) -> Picture {
        let (begins, pixels) = self.bytes.split_at(self.begins);
        let stored = PictureBytes {
            begins,
            pixels,
            extent: self.extent,
            format: self.format,
            linear: self.linear,
        };
        stored.decode()
    }
}

/// Leaves the memory to the next picture.
impl Drop for StoredPicture {
    fn drop(&mut self) {
        let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        spare.push(std::mem::take(&mut self.bytes));
    }
}
