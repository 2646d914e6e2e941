//! Stage `sort`: a stable sort of the survivors by linear view depth, ties by their number in the scene.
//!
//! It is given as many keys as there are survivors, in `depth_keys`. `order` holds nothing yet:
//! the survivors are numbered like their keys, from 0. It leaves the sorted keys and their survivors in the pair of `keys`
//! and `order` that [`result`] names, on which all later stages rely, and the others to the stages that follow
//! ([`Sorted::spare`]). The plan says which kernels do it: each set has a file here, shaders and scratch of its own.

mod radix;
mod runs;

use std::mem::offset_of;

use crate::gpu::{Buffer, DeviceShape, Groups};
use crate::limits;
use crate::passes::buffers::indirect;
use crate::passes::plan::Plan;
use crate::passes::stage::{Frame, KernelSet, Stage};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::when_finding_view(
    "sort",
    |plan, need| (kernels(plan).pipelines)(plan, need),
    |frame, recorder| (kernels(frame.plan).record)(frame, recorder),
);

/// The kernels that suit the plan's kind of device.
fn kernels(plan: &Plan) -> &'static KernelSet {
    match plan.way.shape {
        DeviceShape::Cpu => &runs::KERNELS,
        DeviceShape::Gpu { .. } => &radix::KERNELS,
    }
}

/// Words of `histogram` that those kernels use.
pub(super) fn histogram_words(plan: &Plan) -> u64 {
    match plan.way.shape {
        DeviceShape::Cpu => runs::histogram_words(plan.data.order.sort_runs.into()),
        DeviceShape::Gpu { .. } => radix::histogram_words(plan),
    }
}

/// Words of `crowds` that those kernels use.
pub(super) fn crowd_words(plan: &Plan) -> u64 {
    match plan.way.shape {
        DeviceShape::Cpu => 0,
        DeviceShape::Gpu { .. } => radix::crowd_words(plan.gaussians()),
    }
}

/// In which of the two pairs of `keys` and `order` they leave the sorted ones: each pass carries them to the other pair.
pub(super) fn result(plan: &Plan) -> usize {
    (plan.way.sort_passes % 2) as usize
}

// FrameCounts has indirect commands for four passes.
const _: () = assert!(u32::BITS.div_ceil(limits::SORT_BITS) <= 4);

/// The workgroups of a pass, none where the device skips it: of the passes that the scene's bounds ask for, the first ones, as
/// many as there are leading digits in which the keys agree (glsl/sort.glsl).
fn of_pass(counts: &Buffer, pass: u32) -> Groups<'_> {
    let size = size_of::<[u32; 4]>();
    let at = offset_of!(FrameCounts, sort_pass_groups) + pass as usize * size;
    Groups::Indirect(counts, at as u64)
}

/// The workgroups of the count of a pass. The first always runs: it decides which passes are skipped.
fn of_count(counts: &Buffer, pass: u32) -> Groups<'_> {
    match pass.checked_sub(1) {
        None => indirect!(counts, FrameCounts, sort_groups),
        Some(before) => of_pass(counts, before),
    }
}

/// The buffers that the sort leaves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sorted<'a> {
    /// The survivors, front to back.
    pub(super) order: &'a Buffer,
    /// Buffers of a word a Gaussian that nobody needs any more once the order is known, for the stages that follow.
    pub(super) spare: [&'a Buffer; 3],
}

/// The buffers that the sort of a frame leaves.
pub(super) fn sorted<'a>(frame: &Frame<'a>) -> Sorted<'a> {
    let (b, at) = (frame.buffers, frame.plan.sorted());
    Sorted {
        order: &b.order[at],
        spare: [&b.keys[0], &b.keys[1], &b.order[at ^ 1]],
    }
}
