//! The buffers of earlier frames: those that are large enough stay when others grow.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{Buffer, Device};
use crate::passes::buffers::{Buffers, ReclipBuffers, gpu_only};
use crate::passes::plan::Plan;
use crate::passes::sizes::{Sized, Sizes};
use crate::passes::tile_picture::TilePicture;

/// Buffers that may be used again. Those that are not are dropped, and go when the frames that use them are done.
#[derive(Debug, Default)]
pub(crate) struct Spare {
    buffers: Vec<Buffer>,
    pub(super) picture: Option<Arc<TilePicture>>,
    pub(super) reclip: Option<ReclipBuffers>,
}

impl Spare {
    /// True when there is a buffer of a name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.buffers.iter().any(|buffer| buffer.name() == name)
    }

    /// Keeps what is large enough for these sizes, and where a plan wants it.
    pub(crate) fn retain(&mut self, sizes: Sizes, plan: &Plan) {
        let location = plan.picture_location();
        self.keep(sizes, plan, |buffer, bytes| buffer.size() >= bytes);
        let is_there = |picture: &Arc<TilePicture>| picture.pixels.location() == location;
        self.picture = self.picture.take().filter(is_there);
    }

    /// Keeps what is exactly as large as these sizes ask for.
    pub(crate) fn retain_exact(&mut self, sizes: Sizes, plan: &Plan) {
        self.keep(sizes, plan, |buffer, bytes| {
            buffer.size() == bytes.max(1).next_multiple_of(16)
        });
    }

    fn keep(&mut self, sizes: Sizes, plan: &Plan, fits: impl Fn(&Buffer, u64) -> bool) {
        let fit = |sized: &[Sized], buffer: &Buffer| {
            let mut named = sized.iter().filter(|(name, _)| *name == buffer.name());
            named.any(|(_, bytes)| fits(buffer, *bytes))
        };
        let wanted = sizes.buffers(plan.way.shape);
        self.buffers.retain(|buffer| fit(&wanted, buffer));
        let wanted = sizes.picture();
        let picture = self.picture.take();
        self.picture = picture.filter(|p| fit(&wanted, &p.begins) && fit(&wanted, &p.pixels));
        let wanted = sizes.reclip();
        let reclip = self.reclip.take();
        self.reclip = reclip.filter(|reclip| reclip.all().iter().all(|b| fit(&wanted, b)));
    }

    /// All of it.
    pub(super) fn all(&self) -> Vec<&Buffer> {
        let picture = self.picture.iter().flat_map(|p| [&p.begins, &p.pixels]);
        let reclip = self.reclip.iter().flat_map(ReclipBuffers::all);
        self.buffers.iter().chain(picture).chain(reclip).collect()
    }

    /// A buffer of a name that only the device sees and that holds so many bytes: a spare one, or else a new one.
    pub(super) fn gpu_only(
        &mut self,
        device: &Device,
        name: &'static str,
        size: u64,
    ) -> Result<Buffer> {
        let at = self.buffers.iter().position(|buffer| buffer.name() == name);
        let spare = at.map(|at| self.buffers.swap_remove(at));
        match spare {
            Some(buffer) => Ok(buffer),
            None => gpu_only(device, name, size),
        }
    }
}

impl Buffers {
    /// What of the buffers another frame may use.
    pub(crate) fn spare(&self) -> Spare {
        let tiles = self.tiles.as_ref();
        Spare {
            buffers: self.single().into_iter().cloned().collect(),
            picture: tiles.map(|tiles| tiles.picture.clone()),
            reclip: self.reclip.get().cloned(),
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
    pub(crate) fn all(&self) -> Vec<&Buffer> {
        let mut all = self.single();
        if let Some(t) = &self.tiles {
            all.extend([&t.picture.begins, &t.picture.pixels]);
        }
        if let Some(s) = self.reclip.get() {
            all.extend(s.all());
        }
        all
    }
}
