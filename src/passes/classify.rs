//! Stage `classify`, one invocation a Gaussian of the blocks that are not settled as a whole, culls by footprint, opacity
//! and size, and finds the side of what is in view.

use crate::passes::block_list::looked_at;
use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::Recording;
use crate::passes::shaders::classify;
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::{block_list, clip};

pub(crate) static STAGE: Stage<EyePlan> = Stage::when_finding_view("classify", &[STORAGES], record);

memory! { EyePlan:
    /// Which Gaussians are kept, and which of them are cut.
    masks: |plan| block_list::MASK_BYTES * plan.blocks();
    /// How many these are in each block.
    block_counts: |plan| 16 * plan.blocks();
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(classify {
        shared::MEMORY => [frame],
        SCENE => [gaussians],
        block_list::MEMORY => [block_list],
        clip::MEMORY => [surfaces, clip_sides, clip_masks, shortlists, meshes],
        MEMORY => [masks, block_counts],
    });
    recording.dispatch(buffers, (), looked_at());
}
