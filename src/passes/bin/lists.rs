//! The tiles' lists, or coarse ones where these have no room.

use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::coarse;
use crate::passes::storage::{buffers, memory};
use crate::passes::{project, shared, sort};
use rara_base::limits;
use rara_gpu::DeviceShape;

memory! { EyePlan:
    /// The tiles' lists, one after the other, or coarse lists, for which there is room in any case.
    tile_splats: |plan| {
        let least = coarse_words(plan.gaussians(), 2);
        plan.when_tiled(4 * pairs(plan).max(least))
    };
    /// Where each tile's list begins, and where the last one ends; one that begins where the next one does is empty. Behind them
    /// are the two words by which glsl/coarse.glsl tells coarse lists.
    tile_begins: |plan| plan.when_tiled(4 * (u64::from(plan.data.tiles.tile_count) + 3)), in EyePlan::picture_location;
}

/// The pairs of tile and splat that have room.
pub(super) fn pairs(plan: &EyePlan) -> u64 {
    plan.data.room.pair_capacity.into()
}

/// Words of coarse lists of so many Gaussians, with so many rows and columns of cells.
fn coarse_words(gaussians: u64, cells: u64) -> u64 {
    gaussians.div_ceil(32) * (32 + cells)
}

/// The tiles along a side of the cells of coarse lists, the fewest for which there is room.
pub(in crate::passes) fn cell_side(gaussians: u64, [columns, rows]: [u32; 2], pairs: u32) -> u32 {
    let fits = |side: u32| {
        let cells = columns.div_ceil(side) + rows.div_ceil(side);
        cells <= limits::MOST_CELLS && coarse_words(gaussians, cells.into()) <= pairs.into()
    };
    let most = columns.max(rows).max(1);
    (1..most).find(|side| fits(*side)).unwrap_or(most)
}

/// Words of scratch as buffers of the pipelines for CPU drivers, or else for GPUs, where there are tiles.
pub(super) fn scratch(plan: &EyePlan, is_for_cpus: bool, words: u64) -> u64 {
    match (plan.cut.shape == DeviceShape::Cpu) == is_for_cpus {
        true => plan.when_tiled(4 * words),
        false => 0,
    }
}

/// Writes coarse lists where those of the tiles have no room.
pub(super) fn record_coarse(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(coarse {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [tile_masks],
        MEMORY => [tile_splats, tile_begins];
        order: sort::order(recording.plan),
    });
    recording.dispatch(buffers, (), counted!(coarse_groups));
}
