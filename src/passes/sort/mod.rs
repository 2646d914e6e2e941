//! Stage `sort`: a stable sort of the survivors by linear view depth, ties by their number in the scene.
//!
//! It is given as many keys as there are survivors, in both `keys`. `order` holds nothing yet: the survivors are numbered
//! like their keys, from 0. It leaves the sorted keys and their survivors in the pair of buffers that [`result`] names, on
//! which all later stages rely, and the others to the stages that follow ([`Sorted::spare`]). The plan says which kernels do
//! it: each set has a file here, shaders and scratch of its own.

mod runs;

use crate::gpu::{Buffer, DeviceShape};
use crate::passes::plan::Plan;
use crate::passes::stage::{Frame, KernelSet, Stage};

pub(crate) const STAGE: Stage = Stage::of_view(
    "sort",
    |plan, need| (kernels(plan).pipelines)(plan, need),
    |frame, recorder| (kernels(frame.plan).record)(frame, recorder),
);

/// The kernels that suit the plan's kind of device.
fn kernels(plan: &Plan) -> &'static KernelSet {
    match plan.way.shape {
        DeviceShape::Cpu | DeviceShape::Gpu { .. } => &runs::KERNELS,
    }
}

/// In which of the two pairs of `keys` and `order` those kernels leave the sorted ones.
pub(super) fn result(plan: &Plan) -> usize {
    match plan.way.shape {
        DeviceShape::Cpu | DeviceShape::Gpu { .. } => runs::result(plan),
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
