//! Stage `bin`: the splats of each tile, by depth.
//!
//! It is given the survivors' outlines, as masks or as splats, and their [order](super::sort::sorted); it leaves the tiles'
//! lists and where they begin, and how many pairs of tile and splat there are. The plan says which kernels do it: each set
//! has a file here, shaders and scratch of its own, and may use the buffers that the sort has left over.

mod spans;

use crate::gpu::DeviceShape;
use crate::passes::plan::Plan;
use crate::passes::stage::{KernelSet, Stage};

pub(crate) const STAGE: Stage = Stage {
    name: "bin",
    needed: |plan| plan.finds_view() && plan.is_tiled(),
    missed: |plan| plan.is_tiled() || plan.gaussians() == 0,
    pipelines: |plan, need| (kernels(plan).pipelines)(plan, need),
    record: |frame, recorder| (kernels(frame.plan).record)(frame, recorder),
};

/// The costs of those for GPUs.
#[cfg(feature = "lab")]
pub(in crate::passes) use spans::COSTS;

/// The kernels that suit the plan's kind of device.
fn kernels(plan: &Plan) -> &'static KernelSet {
    match plan.way.shape {
        DeviceShape::Cpu | DeviceShape::Gpu { .. } => &spans::KERNELS,
    }
}
