//! Stage 1, only where the clip has changed: the side of each block of Gaussians, and the paper's three classes
//! (section 3.2) of each Gaussian in the blocks that are cut. The camera has no part in it.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::blocks::{BlockList, groups_of_blocks};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::types::FrameCounts;

#[derive(Debug, Clone)]
pub(crate) struct Clip {
    blocks: ComputePipeline,
    clip: ComputePipeline,
}

impl Clip {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            blocks: context.compute("clip_blocks", &shaders::CLIP_BLOCKS_COMP, &[])?,
            clip: context.compute("clip", &shaders::CLIP_COMP, &[])?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        list: &BlockList,
        scene: &SceneBuffers,
        b: &Buffers,
        plan: &Plan,
    ) {
        let blocks = [&b.frame, &scene.blocks, &b.clip_sides];
        recorder.dispatch(&self.blocks, &blocks, &[], groups_of_blocks(plan));
        list.record(recorder, &b.clip_sides, b, BlockList::CLIP);
        let clip = [
            &b.frame,
            &scene.gaussians,
            &b.block_list,
            &b.counts,
            &b.clip_masks,
        ];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, clip_groups) as u64);
        recorder.dispatch(&self.clip, &clip, &[], groups);
    }
}
