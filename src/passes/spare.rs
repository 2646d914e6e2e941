//! The buffers of earlier frames: those that are large enough stay when others grow.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{Buffer, BufferDesc, Device, Location};
use crate::passes::buffers::{Buffers, ReclipBuffers, TilePicture};

/// Buffers that may be used again. Those that are not are dropped, and go when the frames that use them are done.
#[derive(Debug, Default)]
pub(crate) struct Spare {
    buffers: Vec<Buffer>,
    pub(super) picture: Option<Arc<TilePicture>>,
    pub(super) reclip: Option<ReclipBuffers>,
}

impl Spare {
    /// A buffer of a name that holds so many bytes: a spare one, or else a new one. A spare one that is too small goes
    /// before.
    pub(super) fn take(
        &mut self,
        device: &Device,
        name: &'static str,
        size: u64,
        location: Location,
    ) -> Result<Buffer> {
        let at = self.buffers.iter().position(|buffer| buffer.name() == name);
        let spare = at.map(|at| self.buffers.swap_remove(at));
        let fits = |buffer: &Buffer| buffer.size() >= size && buffer.location() == location;
        match spare.filter(fits) {
            Some(buffer) => Ok(buffer),
            None => device.create_buffer(&BufferDesc {
                name,
                size,
                location,
            }),
        }
    }

    /// As [`take`](Self::take), of a buffer that only the device sees.
    pub(super) fn gpu_only(
        &mut self,
        device: &Device,
        name: &'static str,
        size: u64,
    ) -> Result<Buffer> {
        self.take(device, name, size, Location::GpuOnly)
    }
}

impl Buffers {
    /// What of the buffers another frame may use.
    pub(super) fn spare(&self) -> Spare {
        let tiles = self.tiles.as_ref();
        Spare {
            buffers: self.single().into_iter().cloned().collect(),
            picture: tiles.map(|tiles| tiles.picture.clone()),
            reclip: self.reclip.clone(),
        }
    }

    /// The buffers that are neither of the tiles' picture nor of a reclipped frame.
    pub(super) fn single(&self) -> Vec<&Buffer> {
        let mut all = vec![
            &self.frame,
            &self.surfaces,
            &self.masks,
            &self.clip_sides,
            &self.clip_masks,
            &self.shortlists,
            &self.block_sides,
            &self.block_list,
            &self.block_counts,
            &self.block_offsets,
            &self.counts,
            &self.survivors,
            &self.cutoffs,
            &self.cut_records,
            &self.splats,
            &self.quads,
            &self.depth_keys,
            &self.histogram,
            &self.crowds,
            &self.tile_masks,
        ];
        all.extend(self.keys.iter().chain(&self.order));
        if let Some(t) = &self.tiles {
            all.extend(t.scratch.all());
            all.extend([&t.splats, &t.occluders]);
        }
        if let Some(d) = &self.depth {
            all.extend([&d.depths, &d.draw]);
        }
        all
    }

    /// All buffers.
    #[cfg(any(feature = "lab", test))]
    pub(crate) fn all(&self) -> Vec<&Buffer> {
        let mut all = self.single();
        if let Some(t) = &self.tiles {
            all.extend([&t.picture.begins, &t.picture.pixels]);
        }
        if let Some(s) = &self.reclip {
            all.extend([&s.revisits, &s.reclips, &s.recuts, &s.dirty]);
        }
        all
    }
}
