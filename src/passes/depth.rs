//! Stage `depth`, only where a host asks for it, finds how deep each splat is in a pixel, on average of what the clip leaves
//! of it. Tiles make expected and written depths of those, beside the colours; where there are no tiles, a draw blends them.

use std::mem::offset_of;

use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::{depth, splat_depth};
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::buffers;
use crate::passes::weight::Weight;
use crate::passes::work::Work;
use crate::passes::{clip, compact, cutoff, project, sort};
use crate::types::FrameCounts;
use rara_gpu::{Attachments, DepthUse, Drawer};
use rara_scene::depth::DepthMap;

/// The splats' depths, behind the splats.
pub(crate) static STAGE: Stage<EyePlan> = Stage {
    name: "depth",
    needed: |plan| plan.finds_depth() && plan.work != Work::Draw,
    missed: |_| false,
    memory: &[],
    record,
};

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(depth {
        shared::MEMORY => [frame, counts],
        SCENE => [gaussians],
        compact::MEMORY => [splat_gaussians],
        clip::MEMORY => [surfaces, shortlists, meshes],
        project::MEMORY => [splats],
    });
    recording.dispatch(buffers, (), counted!(project_groups));
}

/// The draw of the depths as quads.
pub(crate) fn draw(plan: &EyePlan, attachments: Attachments) -> Draw<splat_depth::Program> {
    let weight = Weight::from_plan(plan);
    let constants = splat_depth::Constants {
        clip_mode: weight.mode,
        several: weight.several,
        combined: weight.combined,
        meshes: weight.meshes,
        many: weight.many,
        decay: weight.decay,
        miss: weight.miss,
        phi_form: weight.phi,
        depth: attachments.depth.is_some(),
    };
    let shaders = [&splat_depth::VERT, &splat_depth::FRAG];
    Draw::new(shaders, constants, attachments, DepthUse::Tested)
}

/// Draws inside the host's rendering scope. `origin` is where its viewport begins, px, `map` says what its depth buffer
/// holds for a depth, and depths are multiplied by `unit`.
pub(crate) fn record_draw(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (plan, b): (&EyePlan, &Buffers<EyePlan>),
    attachments: Attachments,
    origin: [f32; 2],
    (map, unit): (Option<DepthMap>, f64),
) {
    let buffers = buffers!(splat_depth {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [splats, quads],
        cutoff::MEMORY => [cut_records];
        order: sort::order(plan),
    });
    let [depth_offset, depth_scale] = map.map_or([0.0; 2], |map| map.factors());
    let params = splat_depth::Params {
        origin,
        principal_point: plan.principal_point(origin),
        depth_offset,
        depth_scale,
        sigma: plan.cut.data.region.sigma,
        cut_stride: plan.data.weight.cut_stride,
        alpha_max: plan.data.tiles.alpha_max,
        unit: unit as f32,
    };
    let (buffers, args) = (
        (buffers, |storage| b.get(storage)),
        (
            b.get(&shared::MEMORY.counts),
            offset_of!(FrameCounts, draw) as u64,
        ),
    );
    draw(plan, attachments).draw(pipelines, drawer, buffers, params, args);
}
