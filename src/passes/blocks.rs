//! Stage `blocks`, one invocation a block of Gaussians, finds what view and clip say about all of them at once, and which
//! blocks are left to look at.

use crate::passes::block_list::{self, groups_of_blocks, list_differing};
use crate::passes::clip;
use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::Recording;
use crate::passes::shaders::blocks;
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};

pub(crate) static STAGE: Stage<EyePlan> =
    Stage::when_finding_view("blocks", &[STORAGES, block_list::STORAGES], record);

memory! { EyePlan:
    /// What view and clip say of each block.
    block_sides: |plan| 4 * plan.blocks();
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(blocks {
        shared::MEMORY => [frame],
        SCENE => [blocks],
        clip::MEMORY => [surfaces, clip_sides, shortlists, meshes],
        MEMORY => [block_sides],
    });
    recording.dispatch(buffers, (), groups_of_blocks(recording.plan));
    list_differing(recording, &MEMORY.block_sides);
}
