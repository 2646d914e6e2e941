//! Stage `clip`, only where the clip has changed, finds the side of each block of Gaussians, and of each Gaussian in the
//! blocks that are cut: the paper's three classes (section 3.2). The camera has no part in it.

use crate::passes::block_list::{self, ListFor, groups_of_blocks};
use crate::passes::plan::Plan;
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::{clip, clip_blocks};
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::types;

pub(crate) static STAGE: Stage = Stage {
    name: "clip",
    needed: |plan| plan.finds_clip(),
    missed: |_| true,
    memory: &[STORAGES, block_list::STORAGES],
    record,
};

memory! {
    /// The clip's sides of the blocks; empty without a clip.
    clip_sides: |plan| 4 * clipped_blocks(plan);
    /// The clip's masks of the blocks; empty without a clip.
    clip_masks: |plan| block_list::MASK_BYTES * clipped_blocks(plan);
}

fn clipped_blocks(plan: &Plan) -> u64 {
    match plan.mode() {
        types::MODE_NONE => 0,
        _ => plan.blocks(),
    }
}

fn record(recording: &mut Recording<'_, '_>) {
    let buffers = buffers!(clip_blocks {
        shared::MEMORY => [frame, surfaces],
        SCENE => [blocks],
        block_list::MEMORY => [shortlists],
        MEMORY => [clip_sides],
    });
    recording.dispatch(buffers, (), groups_of_blocks(recording.plan));
    block_list::record(recording, &MEMORY.clip_sides, ListFor::Clip);
    let buffers = buffers!(clip {
        shared::MEMORY => [frame, surfaces, counts],
        SCENE => [gaussians],
        block_list::MEMORY => [block_list, shortlists],
        MEMORY => [clip_masks],
    });
    recording.dispatch(buffers, (), counted!(clip_groups));
}
