//! Where the camera stands still and the clip moves: the Gaussians between its old and its new surface, and what of them
//! the rasteriser holds. The survivors, which are all in view, their places, colours, order and tiles stay.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::blocks::{BlockList, groups_of_blocks};
use crate::passes::buffers::{Buffers, SweepBuffers};
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::types::FrameCounts;

/// The classes that change.
#[derive(Debug, Clone)]
pub(crate) struct Reclip {
    blocks: ComputePipeline,
    reclip: ComputePipeline,
    scan: ComputePipeline,
    compact: ComputePipeline,
}

impl Reclip {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            blocks: context.compute("reclip_blocks", &shaders::RECLIP_BLOCKS_COMP, &[])?,
            reclip: context.compute("reclip", &shaders::RECLIP_COMP, &[])?,
            scan: context.compute("reclip_scan", &shaders::RECLIP_SCAN_COMP, &[])?,
            compact: context.compute("reclip_compact", &shaders::RECLIP_COMPACT_COMP, &[])?,
        })
    }

    /// With `fresh` the survivors have no clip yet.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        list: &BlockList,
        scene: &SceneBuffers,
        b: &Buffers,
        s: &SweepBuffers,
        (plan, fresh): (&Plan, bool),
    ) {
        let blocks = [
            &b.frame,
            &scene.blocks,
            &b.block_sides,
            &b.block_counts,
            &s.looks,
            &s.reclips,
        ];
        recorder.dispatch(
            &self.blocks,
            &blocks,
            &[fresh.into()],
            groups_of_blocks(plan),
        );
        list.record(recorder, &s.looks, b, BlockList::CLIP);
        let looked_at = Groups::Indirect(&b.counts, offset_of!(FrameCounts, clip_groups) as u64);
        let reclip = [
            &b.frame,
            &scene.gaussians,
            &b.block_list,
            &b.counts,
            &s.looks,
            &b.block_sides,
            &b.masks,
            &s.reclips,
        ];
        recorder.dispatch(&self.reclip, &reclip, &[], looked_at);
        let scan = [&b.frame, &s.looks, &s.reclips, &b.counts];
        recorder.dispatch(&self.scan, &scan, &[], Groups::Count(1));
        let compact = [
            &b.frame,
            &b.block_list,
            &b.counts,
            &b.block_sides,
            &b.masks,
            &b.block_offsets,
            &s.reclips,
            &s.recuts,
            &b.cutoffs,
        ];
        recorder.dispatch(&self.compact, &compact, &[], looked_at);
    }
}

/// What the rasteriser holds of the survivors that change.
#[derive(Debug, Clone)]
pub(crate) struct Recut {
    pipeline: ComputePipeline,
}

impl Recut {
    /// With `tiles` false the shader knows none.
    pub(crate) fn new(context: &Context<'_>, tiles: bool) -> Result<Self> {
        Ok(Self {
            pipeline: context.compute("recut", &shaders::RECUT_COMP, &[(0, tiles.into())])?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        scene: &SceneBuffers,
        b: &Buffers,
        s: &SweepBuffers,
    ) {
        let buffers = [
            &b.frame,
            &scene.gaussians,
            &b.survivors,
            &b.counts,
            &s.recuts,
            &b.cuts,
            &b.tile_masks,
            &b.splats,
            &s.dirty,
        ];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, recut_groups) as u64);
        recorder.dispatch(&self.pipeline, &buffers, &[], groups);
    }
}
