//! Stages `reclip` and `recut`, where the camera stands still and the clip moves, find the Gaussians between its old and its
//! new surface and change what the rasteriser holds of them. The splats, which are all in view, and their centres,
//! colours, order and tiles stay.

use crate::passes::block_list::{
    self, groups_of_blocks, groups_of_list, list_differing, looked_at,
};
use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::{reclip, reclip_blocks, reclip_compact, reclip_scan, recut};
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::work::Work;
use crate::passes::{blocks, classify, clip, compact, cutoff, project};
use rara_base::limits;

/// The stage that finds which sides change.
pub(crate) static RECLIP: Stage<EyePlan> = Stage {
    name: "reclip",
    needed: |plan| plan.reclips(),
    missed: |_| false,
    memory: &[STORAGES],
    record: record_reclip,
};

/// The stage that changes what the rasteriser holds of those splats.
pub(crate) static RECUT: Stage<EyePlan> = Stage {
    name: "recut",
    needed: |plan| plan.reclips(),
    missed: |_| false,
    memory: &[],
    record: record_recut,
};

// Only frames whose camera has stood still have them.
memory! { EyePlan:
    /// Which blocks are looked at.
    revisits: |plan| reclipped(plan, 4 * plan.blocks());
    /// What is kept of each block.
    reclips: |plan| reclipped(plan, 4 * u64::from(limits::RECLIP_WORDS) * plan.blocks());
    /// The splats that change, and their places among those that are cut.
    recuts: |plan| reclipped(plan, 8 * plan.gaussians());
    /// The tiles that hold any of these.
    dirty: |plan| reclipped(plan, plan.when_tiled(4 * u64::from(plan.data.tiles.tile_count)));
}

/// So many bytes, in a reclipped frame.
fn reclipped(plan: &EyePlan, bytes: u64) -> u64 {
    if plan.reclips() { bytes } else { 0 }
}

fn record_reclip(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(reclip_blocks {
        shared::MEMORY => [frame],
        SCENE => [blocks],
        blocks::MEMORY => [block_sides],
        classify::MEMORY => [block_counts],
        clip::MEMORY => [surfaces, shortlists, meshes],
        MEMORY => [revisits, reclips],
    });
    // No clip may have changed the splats yet.
    let fresh = matches!(recording.plan.work, Work::Reclip { fresh: true, .. });
    let params = reclip_blocks::Params {
        fresh: fresh.into(),
    };
    recording.dispatch(buffers, params, groups_of_blocks(recording.plan));
    list_differing(recording, &MEMORY.revisits);
    let buffers = buffers!(reclip {
        shared::MEMORY => [frame],
        SCENE => [gaussians],
        clip::MEMORY => [surfaces, shortlists, meshes],
        block_list::MEMORY => [block_list],
        blocks::MEMORY => [block_sides],
        classify::MEMORY => [masks],
        MEMORY => [revisits, reclips],
    });
    recording.dispatch(buffers, (), looked_at());
    let buffers = buffers!(reclip_scan {
        shared::MEMORY => [frame, counts],
        MEMORY => [revisits, reclips],
    });
    recording.dispatch(buffers, (), groups_of_list(recording.plan));
    let buffers = buffers!(reclip_compact {
        shared::MEMORY => [frame],
        block_list::MEMORY => [block_list],
        blocks::MEMORY => [block_sides],
        classify::MEMORY => [masks],
        compact::MEMORY => [block_offsets, cutoffs],
        MEMORY => [reclips, recuts],
    });
    recording.dispatch(buffers, (), looked_at());
}

fn record_recut(recording: &mut Recording<'_, '_, EyePlan>) {
    if recording.plan.is_tiled() {
        // All tiles are drawn again where no frame has drawn what is in view.
        let all = recording.plan.finds_view();
        recording.fill(&MEMORY.dirty, all.into());
    }
    let buffers = buffers!(recut {
        shared::MEMORY => [frame, counts],
        SCENE => [gaussians],
        compact::MEMORY => [splat_gaussians],
        cutoff::MEMORY => [cut_records],
        project::MEMORY => [tile_masks, splats, quads],
        MEMORY => [recuts, dirty],
    });
    recording.dispatch(buffers, (), counted!(recut_groups));
}
