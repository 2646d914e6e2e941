//! Stage `blocks`, one invocation a block of Gaussians, finds what view and clip say about all of them at once, and which
//! blocks are left to look at.

use crate::passes::block_list::{self, ListFor, groups_of_blocks};
use crate::passes::clip;
use crate::passes::recording::Recording;
use crate::passes::shaders::blocks;
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};

pub(crate) static STAGE: Stage = Stage::when_finding_view("blocks", &[STORAGES], record);

memory! {
    /// What view and clip say of each block.
    block_sides: |plan| 4 * plan.blocks();
}

fn record(recording: &mut Recording<'_, '_>) {
    let buffers = buffers!(blocks {
        shared::MEMORY => [frame, surfaces],
        SCENE => [blocks],
        clip::MEMORY => [clip_sides],
        block_list::MEMORY => [shortlists],
        MEMORY => [block_sides],
    });
    recording.dispatch(buffers, (), groups_of_blocks(recording.plan));
    block_list::record(recording, &MEMORY.block_sides, ListFor::Classify);
}
