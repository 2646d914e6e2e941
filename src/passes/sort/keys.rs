//! The buffers of the sort, and the workgroups of its passes.

use std::mem::offset_of;

use crate::passes::eye_plan::EyePlan;
use crate::passes::radix;
use crate::passes::recording::{Groups, counted};
use crate::passes::resources::EyeName;
use crate::passes::shared;
use crate::passes::storage::{Storage, memory, named};
use crate::types::FrameCounts;
use rara_base::limits;
use rara_gpu::DeviceShape;

memory! { EyePlan:
    keys: |plan| 4 * plan.gaussians();
    sorted_keys: |plan| 4 * plan.gaussians();
    order: |plan| 4 * plan.gaussians();
    sorted_order: |plan| 4 * plan.gaussians();
    histogram: |plan| 4 * match plan.cut.shape {
        DeviceShape::Cpu => run_words(plan.data.order.sort_runs.into()),
        DeviceShape::Gpu { .. } => radix::histogram_words(plan.gaussians()),
    };
    /// What the sort for GPUs knows of many splats of one depth; empty for CPU drivers.
    large_ties: |plan| match plan.cut.shape {
        DeviceShape::Cpu => 0,
        DeviceShape::Gpu { .. } => 4 * large_tie_words(plan.gaussians()),
    };
}

/// The two pairs of keys and of what they order, which passes carry from one to the other.
pub(super) static KEYS: [&Storage<EyePlan>; 2] = [&MEMORY.keys, &MEMORY.sorted_keys];
pub(super) static ORDER: [&Storage<EyePlan>; 2] = [&MEMORY.order, &MEMORY.sorted_order];

/// Words of the histogram for so many runs: for each its keys of each digit, and its least and greatest key.
fn run_words(runs: u64) -> u64 {
    runs * ((1 << limits::SORT_BITS) + 2)
}

/// Stretches of so many Gaussians' numbers, as in glsl/large_ties.glsl.
pub(super) fn stretches(gaussians: u64) -> u64 {
    let partitions = gaussians.div_ceil(limits::RADIX_PARTITION.into());
    let of_stretch = partitions.div_ceil(limits::MOST_STRETCHES.into());
    partitions.div_ceil(of_stretch.max(limits::LEAST_STRETCH.into()))
}

/// Words of the large ties: whether there are any, their places, their counts, and a bit for each number.
fn large_tie_words(gaussians: u64) -> u64 {
    let tables = stretches(gaussians) + 1;
    1 + tables * u64::from(limits::MOST_LARGE_TIES) + gaussians.div_ceil(u32::BITS.into())
}

// FrameCounts has indirect commands for four passes.
const _: () = assert!(u32::BITS.div_ceil(limits::SORT_BITS) <= 4);

/// The workgroups of a pass, none where the device skips it: of the passes that the scene's bounds ask for, the first ones, as
/// many as there are leading digits in which the keys agree (glsl/sort.glsl).
pub(super) fn groups_of_pass(pass: u32) -> Groups<EyeName> {
    let at = offset_of!(FrameCounts, sort_pass_groups) + pass as usize * size_of::<[u32; 4]>();
    Groups::Counted(named(&shared::MEMORY.counts), at)
}

/// The workgroups of the count of a pass. The first always runs: it decides which passes are skipped.
pub(super) fn groups_of_count(pass: u32) -> Groups<EyeName> {
    match pass.checked_sub(1) {
        None => counted!(sort_groups),
        Some(before) => groups_of_pass(before),
    }
}

/// The splats that the sort of a frame leaves, front to back.
pub(in crate::passes) fn order(plan: &EyePlan) -> &'static Storage<EyePlan> {
    ORDER[plan.sorted()]
}

/// Buffers of a word a Gaussian that nobody needs any more once the order is known, for the stages that follow.
pub(in crate::passes) fn spare(plan: &EyePlan) -> [&'static Storage<EyePlan>; 3] {
    [KEYS[0], KEYS[1], ORDER[plan.sorted() ^ 1]]
}
