//! What a scene keeps of Gaussians that edits move, from which the next frame's motion follows.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use rara_base::error::Result;
use rara_gpu::{Buffer, BufferDesc, Device, Location};

/// What a scene keeps of Gaussians that edits have moved: what they were in the last frame.
#[derive(Debug, Clone)]
pub(crate) struct EarlierShapes {
    buffer: Buffer,
    /// The number of the last edit that has moved any, from 1 on.
    edit: u32,
    /// The number of the last one that a frame has shown.
    shown: Arc<AtomicU32>,
}

impl EarlierShapes {
    /// Makes room for as many bytes as a scene's Gaussians take, for the first edit. Nothing is in it yet.
    pub(super) fn new(device: &Device, size: u64) -> Result<Self> {
        device.check_budget("what edited Gaussians were", size, 0)?;
        let desc = BufferDesc {
            name: "earlier",
            size,
            location: Location::GpuOnly,
        };
        Ok(Self {
            buffer: device.create_buffer(&desc)?,
            edit: 1,
            shown: Arc::default(),
        })
    }

    pub(super) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// The numbers of the last edit and of the last one that a frame has shown.
    pub(super) fn numbers(&self) -> [u32; 2] {
        [self.edit, self.shown.load(Ordering::Relaxed)]
    }

    /// The same after one more edit.
    pub(super) fn edited(&self) -> Self {
        Self {
            edit: self.edit + 1,
            ..self.clone()
        }
    }

    /// Notes that a frame shows the edits.
    pub(crate) fn show(&self) {
        self.shown.store(self.edit, Ordering::Relaxed);
    }
}
