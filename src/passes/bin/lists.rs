//! The tiles' lists.

use crate::passes::eye_plan::EyePlan;
use crate::passes::storage::memory;
use rara_gpu::DeviceShape;

memory! { EyePlan:
    /// The tiles' lists, one after the other.
    tile_splats: |plan| plan.when_tiled(4 * pairs(plan));
    /// Where each tile's list begins, and where the last one ends. One that begins where the next one does is empty.
    tile_begins: |plan| plan.when_tiled(4 * (u64::from(plan.data.tiles.tile_count) + 1)), in EyePlan::picture_location;
}

/// The pairs of tile and splat that have room.
pub(super) fn pairs(plan: &EyePlan) -> u64 {
    plan.data.room.pair_capacity.into()
}

/// Words of scratch as buffers of the pipelines for CPU drivers, or else for GPUs, where there are tiles.
pub(super) fn scratch(plan: &EyePlan, is_for_cpus: bool, words: u64) -> u64 {
    match (plan.cut.shape == DeviceShape::Cpu) == is_for_cpus {
        true => plan.when_tiled(4 * words),
        false => 0,
    }
}
