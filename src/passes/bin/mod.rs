//! Stage `bin`: the splats of each tile, by depth.
//!
//! It is given the splats' outlines, as masks or as splats, and their [order](super::sort::order); it leaves the tiles'
//! lists and where they begin, how many pairs of tile and splat there are, and on GPUs lists of the tiles themselves. Where the
//! lists have no room, it leaves coarse ones (`glsl/coarse.glsl`) that stages after it need not tell from them. The plan
//! says which pipelines do it: each set has a file here, shaders and scratch of its own, and may use the buffers that the sort
//! has left over.

pub(super) mod lists;
pub(super) mod macro_tiles;
mod spans;

use crate::passes::eye_plan::EyePlan;
use crate::passes::stage::Stage;
use rara_gpu::DeviceShape;

pub(crate) static STAGE: Stage<EyePlan> = Stage {
    name: "bin",
    needed: |plan| plan.finds_view() && plan.is_tiled(),
    missed: |plan| plan.is_tiled() || plan.gaussians() == 0,
    memory: &[lists::STORAGES, spans::STORAGES, macro_tiles::STORAGES],
    record: |recording| match recording.plan.cut.shape {
        DeviceShape::Cpu => spans::record(recording),
        DeviceShape::Gpu { .. } => macro_tiles::record(recording),
    },
};
