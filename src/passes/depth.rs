//! Stage `depth`, only where a host asks for it, finds how deep each splat is in a pixel, on average of what the clip leaves
//! of it. A draw blends those depths.

use std::mem::offset_of;

use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::{depth, splat_depth};
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::weight::Weight;
use crate::passes::work::Work;
use crate::passes::{clip, compact, cutoff, project, sort};
use crate::types::{FrameCounts, SplatDepth};
use rara_gpu::{Attachments, Drawer};
use rara_scene::depth::DepthMap;

/// The splats' depths.
pub(crate) static STAGE: Stage<EyePlan> = Stage {
    name: "depth",
    needed: |plan| plan.way.expects_depth && plan.work != Work::Draw,
    missed: |_| false,
    memory: &[STORAGES],
    record,
};

memory! { EyePlan:
    depths: |plan| expected(plan, plan.gaussians() * size_of::<SplatDepth>() as u64);
    /// The indirect draw of a quad a splat.
    depth_draw: |plan| expected(plan, 16);
}

/// So many bytes where depths are expected.
fn expected(plan: &EyePlan, bytes: u64) -> u64 {
    if plan.way.expects_depth { bytes } else { 0 }
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let buffers = buffers!(depth {
        shared::MEMORY => [frame, counts],
        SCENE => [gaussians],
        compact::MEMORY => [splat_gaussians],
        clip::MEMORY => [surfaces, shortlists],
        MEMORY => [depths],
    });
    recording.dispatch(buffers, (), counted!(project_groups));
    // Each splat is drawn as a quad, also where tiles draw the colours.
    let quad = [4_u32, 0, 0, 0];
    recording.update(&MEMORY.depth_draw, bytemuck::bytes_of(&quad));
    let splats = offset_of!(FrameCounts, mesh_groups) + 3 * size_of::<u32>();
    let region = ash::vk::BufferCopy {
        src_offset: splats as u64,
        dst_offset: 4,
        size: 4,
    };
    recording.copy(&shared::MEMORY.counts, &MEMORY.depth_draw, region);
}

/// The draw of the depths.
pub(crate) fn draw(plan: &EyePlan, attachments: Attachments) -> Draw<splat_depth::Program> {
    let depth = attachments.depth.is_some();
    let weight = Weight::from_plan(plan);
    let constants = splat_depth::Constants {
        boxes: false,
        clip_mode: weight.mode,
        several: weight.several,
        combined: weight.combined,
        many: weight.many,
        decay: weight.decay,
        miss: weight.miss,
        phi_form: weight.phi,
        depth,
    };
    let shaders = [&splat_depth::VERT, &splat_depth::FRAG];
    Draw::new(shaders, constants, attachments, depth)
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
        cutoff::MEMORY => [cut_records],
        MEMORY => [depths];
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
        (b.get(&MEMORY.depth_draw), 0),
    );
    draw(plan, attachments).draw(pipelines, drawer, buffers, params, args);
}
