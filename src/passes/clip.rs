//! Stage `clip`, only where the clip has changed: the side of each block of Gaussians, and the paper's three classes
//! (section 3.2) of each Gaussian in the blocks that are cut. The camera has no part in it.

use crate::gpu::Recorder;
use crate::passes::block_list::{self, ListFor};
use crate::passes::blocks::groups_of_blocks;
use crate::passes::buffers::indirect;
use crate::passes::pipelines::Kernel;
use crate::passes::plan::Plan;
use crate::passes::shaders::{clip, clip_blocks};
use crate::passes::stage::{Frame, Stage};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage {
    name: "clip",
    needed: |plan| plan.finds_clip(),
    missed: |_| true,
    pipelines: |plan, need| {
        need(sides(plan).key());
        need(block_list::kernel().key());
        need(classes(plan).key());
    },
    record,
};

fn sides(plan: &Plan) -> Kernel<clip_blocks::Program> {
    let layered = plan.way.layered;
    Kernel::new(&clip_blocks::COMP, clip_blocks::Constants { layered })
}

fn classes(plan: &Plan) -> Kernel<clip::Program> {
    let layered = plan.way.layered;
    Kernel::new(&clip::COMP, clip::Constants { layered })
}

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (pipelines, scene, b) = (frame.pipelines, frame.scene, frame.buffers);
    let buffers = clip_blocks::Buffers {
        frame: &b.frame,
        surfaces: &b.surfaces,
        blocks: &scene.blocks,
        clip_sides: &b.clip_sides,
    };
    sides(frame.plan).dispatch(
        pipelines,
        recorder,
        buffers,
        (),
        groups_of_blocks(frame.plan),
    );
    block_list::record(frame, recorder, &b.clip_sides, ListFor::Clip);
    let buffers = clip::Buffers {
        frame: &b.frame,
        surfaces: &b.surfaces,
        gaussians: &scene.gaussians,
        block_list: &b.block_list,
        counts: &b.counts,
        clip_masks: &b.clip_masks,
    };
    let groups = indirect!(b.counts, FrameCounts, clip_groups);
    classes(frame.plan).dispatch(pipelines, recorder, buffers, (), groups);
}
