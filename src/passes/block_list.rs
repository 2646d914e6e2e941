//! Lists of blocks: lists those whose Gaussians differ, for one stage, and counts the workgroups that look at blocks.

use crate::passes::plan::Plan;
use crate::passes::recording::{Groups, Recording};
use crate::passes::shaders::block_list;
use crate::passes::shared;
use crate::passes::storage::{Storage, buffers, memory};
use rara_base::limits;
use rara_gpu::DeviceShape;

memory! {
    /// The numbers of the blocks that the next stage looks at.
    block_list: |plan| 4 * plan.blocks();
    /// The blocks' shortlists of surfaces; empty where no region has many.
    shortlists: |plan| match plan.is_shortlisted() {
        true => 4 * u64::from(limits::SHORTLIST_WORDS) * plan.blocks(),
        false => 0,
    };
}

/// Bytes of the two masks of a block, a bit a Gaussian in each.
pub(super) const MASK_BYTES: u64 = 2 * limits::BLOCK_SIZE as u64 / 8;

/// The stage that will look at the blocks of the list.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ListFor {
    Clip = 0,
    Classify = 1,
}

/// Lists those whose two low bits in `sides` say that they differ.
pub(crate) fn record(
    recording: &mut Recording<'_, '_>,
    sides: &'static Storage,
    list_for: ListFor,
) {
    let buffers = buffers!(block_list {
        MEMORY => [block_list],
        shared::MEMORY => [frame, counts];
        sides,
    });
    let params = block_list::Params {
        stage: list_for as u32,
    };
    recording.dispatch(buffers, params, groups_of_list(recording.plan));
}

/// The workgroups of a list of blocks: a single one on CPU drivers, whose invocations have many blocks each, and an invocation
/// a block on GPUs.
pub(crate) fn groups_of_list(plan: &Plan) -> Groups {
    let blocks = plan.data.scene.block_count;
    Groups::Count(match plan.way.shape {
        DeviceShape::Cpu => 1,
        DeviceShape::Gpu { .. } => blocks.div_ceil(list_invocations(plan)).max(1),
    })
}

/// The invocations of each of them.
pub(crate) fn list_invocations(plan: &Plan) -> u32 {
    match plan.way.shape {
        DeviceShape::Cpu => limits::RUN_ROW,
        DeviceShape::Gpu { .. } => limits::BLOCK_SIZE,
    }
}

/// An invocation a block.
pub(crate) fn groups_of_blocks(plan: &Plan) -> Groups {
    let blocks = plan.data.scene.block_count;
    Groups::Count(blocks.div_ceil(limits::BLOCK_GROUP_SIZE))
}
