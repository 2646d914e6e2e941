//! Stage `compact` lists the splats and the cutoff Gaussians in the order of the scene, and writes the counts and the
//! indirect commands of all later stages. No place in a list depends on the order of atomics.

use crate::passes::block_list::{self, groups_of_list, looked_at};
use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::Recording;
use crate::passes::shaders::{compact, compact_scan};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::{blocks, classify, shared};

pub(crate) static STAGE: Stage<EyePlan> = Stage::when_finding_view("compact", &[STORAGES], record);

memory! { EyePlan:
    /// Where the splats and the cut ones of each block go.
    block_offsets: |plan| 8 * plan.blocks();
    /// The Gaussians that are drawn, and their places among those that are cut.
    splat_gaussians: |plan| 8 * plan.gaussians();
    cutoffs: |plan| 4 * plan.gaussians();
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(compact_scan {
        shared::MEMORY => [frame, counts],
        blocks::MEMORY => [block_sides],
        classify::MEMORY => [block_counts],
        block_list::MEMORY => [block_list],
        MEMORY => [block_offsets],
    });
    recording.dispatch(buffers, (), groups_of_list(recording.plan));
    let buffers = buffers!(compact {
        shared::MEMORY => [frame],
        blocks::MEMORY => [block_sides],
        classify::MEMORY => [masks],
        block_list::MEMORY => [block_list],
        MEMORY => [block_offsets, splat_gaussians, cutoffs],
    });
    recording.dispatch(buffers, (), looked_at());
}
