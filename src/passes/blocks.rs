//! Stage `blocks`, one invocation a block of Gaussians, finds what view and clip say about all of them at once, and which
//! blocks are left to look at.

use crate::gpu::{DeviceShape, Groups, Recorder};
use crate::limits;
use crate::passes::block_list::{self, ListFor};
use crate::passes::buffers::buffers;
use crate::passes::plan::Plan;
use crate::passes::shaders::blocks;
use crate::passes::stage::{Frame, Stage, key};

pub(crate) const STAGE: Stage = Stage::when_finding_view(
    "blocks",
    |plan, need| {
        need(key::<blocks::Program>(plan));
        need(key::<block_list::Program>(plan));
    },
    record,
);

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = buffers!(blocks {
        b => [frame, surfaces, clip_sides, block_sides, shortlists],
        frame.scene => [blocks],
    });
    let groups = groups_of_blocks(frame.plan);
    frame.dispatch(recorder, buffers, (), groups);
    block_list::record(frame, recorder, &b.block_sides, ListFor::Classify);
}

/// The workgroups of a list of blocks: a single one on CPU drivers, whose invocations have many blocks each, and an invocation
/// a block on GPUs.
pub(crate) fn groups_of_list(plan: &Plan) -> Groups<'static> {
    Groups::Count(match plan.way.shape {
        DeviceShape::Cpu => 1,
        DeviceShape::Gpu { .. } => plan
            .data
            .scene
            .block_count
            .div_ceil(limits::BLOCK_SIZE)
            .max(1),
    })
}

/// An invocation a block.
pub(crate) fn groups_of_blocks(plan: &Plan) -> Groups<'static> {
    Groups::Count(
        plan.data
            .scene
            .block_count
            .div_ceil(limits::BLOCK_GROUP_SIZE),
    )
}
