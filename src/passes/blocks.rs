//! Stage 2, a block of Gaussians an invocation: what view and clip say about all of them at once, and which blocks are left
//! to look at.

use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Groups, Recorder};
use crate::limits;
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;

#[derive(Debug, Clone)]
pub(crate) struct Blocks {
    pipeline: ComputePipeline,
}

impl Blocks {
    /// With `clip` false the shader asks for no clip.
    pub(crate) fn new(context: &Context<'_>, clip: bool) -> Result<Self> {
        Ok(Self {
            pipeline: context.compute("blocks", &shaders::BLOCKS_COMP, &[(0, clip.into())])?,
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
        let buffers = [&b.frame, &scene.blocks, &b.clip_sides, &b.block_sides];
        recorder.dispatch(&self.pipeline, &buffers, &[], groups_of_blocks(plan));
        list.record(recorder, &b.block_sides, b, BlockList::CLASSIFY);
    }
}

/// Lists the blocks whose Gaussians differ, for one stage.
#[derive(Debug, Clone)]
pub(crate) struct BlockList {
    pipeline: ComputePipeline,
}

impl BlockList {
    pub(crate) const CLIP: u32 = 0;
    pub(crate) const CLASSIFY: u32 = 1;

    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            pipeline: context.compute("block_list", &shaders::BLOCK_LIST_COMP, &[])?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        sides: &Buffer,
        b: &Buffers,
        stage: u32,
    ) {
        let buffers = [&b.frame, sides, &b.block_list, &b.counts];
        recorder.dispatch(&self.pipeline, &buffers, &[stage], Groups::Count(1));
    }
}

/// An invocation a block.
pub(crate) fn groups_of_blocks(plan: &Plan) -> Groups<'static> {
    Groups::Count(plan.data.block_count.div_ceil(limits::BLOCK_GROUP_SIZE))
}
