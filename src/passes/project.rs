//! Stage `project`, one invocation a splat, computes conic, colour and depth key, the mask of tiles and, where it is
//! drawn as one, the quad.

use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::FromPlan;
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::project;
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::{compact, cutoff};
use crate::types::{self, Quad, Splat, SplatDepth};
use rara_base::limits;
use rara_gpu::DeviceShape;
use rara_scene::precision::ShFormat;

pub(crate) static STAGE: Stage<EyePlan> = Stage::when_finding_view("project", &[STORAGES], record);

memory! { EyePlan:
    /// As they lie in glsl/splats.glsl: with pipelines for GPUs some of their numbers apart, four splats to a vector, and where
    /// depths are found what makes those behind.
    splats: |plan| {
        let whole = plan.gaussians() * size_of::<Splat>() as u64;
        let apart = plan.gaussians().div_ceil(4) * 16;
        match plan.cut.shape {
            _ if plan.finds_depth() => whole + apart + plan.gaussians() * size_of::<SplatDepth>() as u64,
            DeviceShape::Cpu => whole,
            DeviceShape::Gpu { .. } => whole + apart,
        }
    };
    /// What the splats are drawn with; empty where no quads are.
    quads: |plan| match plan.needs_quads() {
        true => plan.gaussians() * size_of::<Quad>() as u64,
        false => 0,
    };
    /// The keys of the splats' depths, and behind them the splats' numbers where the sort needs these; with pipelines for GPUs
    /// also room for the ties that their sort finds.
    depth_keys: |plan| {
        let lists = match (plan.reordered, plan.cut.shape) {
            (false, _) => 1,
            (true, DeviceShape::Cpu) => 2,
            (true, DeviceShape::Gpu { .. }) => 3,
        };
        4 * lists * plan.gaussians()
    };
    /// Which tiles each splat touches; empty where tiles are not wanted. Pipelines for GPUs have words of the splats' rectangles
    /// behind the masks (glsl/rects.glsl).
    tile_masks: |plan| {
        let rects = u64::from(plan.keeps_rects()) * plan.gaussians().div_ceil(4);
        plan.when_tiled(16 * (plan.gaussians() + rects))
    };
}

/// Splats of an invocation on processors.
const TURNS: u32 = 8;

/// The shader reads spherical harmonics in one format; without cut splats it reads no cutoff records.
impl FromPlan<EyePlan> for project::Constants {
    fn from_plan(plan: &EyePlan) -> Self {
        Self {
            cuts: plan.view_is_cut(),
            layered: plan.cut.layered,
            sh_format: match plan.way.sh_format {
                ShFormat::Byte => types::SH_BYTE,
                ShFormat::Packed => types::SH_PACKED,
                ShFormat::Half => types::SH_HALF,
                ShFormat::Float => types::SH_FLOAT,
            },
            tiles: plan.is_tiled(),
            quads: plan.needs_quads(),
            rects: plan.keeps_rects(),
            colours: plan.way.colours.code(),
            numbers: plan.reordered,
            local_size_x: match plan.cut.shape {
                DeviceShape::Cpu => limits::SPLAT_GROUP_SIZE / TURNS,
                DeviceShape::Gpu { .. } => limits::SPLAT_GROUP_SIZE,
            },
        }
    }
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(project {
        shared::MEMORY => [frame, counts],
        SCENE => [gaussians, sh],
        compact::MEMORY => [splat_gaussians],
        cutoff::MEMORY => [cut_records],
        MEMORY => [splats, quads, depth_keys, tile_masks],
    });
    let params = project::Params {
        first_layer: recording.plan.way.colours.first_layer(),
    };
    recording.dispatch(buffers, params, counted!(project_groups));
}
