//! Stage `depth`, only where a host asks for it, finds how deep each splat is in a pixel, on average of what the clip leaves
//! of it. A draw blends those depths.

use std::mem::offset_of;

use crate::depth::DepthMap;
use crate::gpu::{Attachments, Drawer, Recorder};
use crate::passes::buffers::{Buffers, DepthBuffers, buffers, indirect};
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::plan::Plan;
use crate::passes::shaders::{depth, splat_depth};
use crate::passes::stage::{Frame, Stage, key};
use crate::passes::weight::Weight;
use crate::passes::work::Work;
use crate::types::FrameCounts;

/// The splats' depths.
pub(crate) const STAGE: Stage = Stage {
    name: "depth",
    needed: |plan| plan.way.expects_depth && plan.work != Work::Draw,
    missed: |_| false,
    pipelines: |plan, need| need(key::<depth::Program>(plan)),
    record,
};

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (b, d) = (frame.buffers, frame.depths());
    let buffers = buffers!(depth {
        b => [frame, surfaces, survivors, counts, shortlists],
        frame.scene => [gaussians],
        d => [depths],
    });
    let groups = indirect!(b.counts, FrameCounts, project_groups);
    frame.dispatch(recorder, buffers, (), groups);
    // Each survivor is drawn as a quad, also where tiles draw the colours.
    let quad = [4_u32, 0, 0, 0];
    recorder.update(&d.draw, 0, bytemuck::bytes_of(&quad));
    let survivors = offset_of!(FrameCounts, mesh_groups) + 3 * size_of::<u32>();
    let region = ash::vk::BufferCopy {
        src_offset: survivors as u64,
        dst_offset: 4,
        size: 4,
    };
    recorder.copy(&b.counts, &d.draw, &[region]);
}

/// The draw of the depths.
pub(crate) fn draw(plan: &Plan, attachments: Attachments) -> Draw<splat_depth::Program> {
    let depth = attachments.depth.is_some();
    let weight = Weight::of(plan);
    let constants = splat_depth::Constants {
        boxes: false,
        clip_mode: weight.mode,
        several: weight.several,
        combined: weight.combined,
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
    (plan, b, d): (&Plan, &Buffers, &DepthBuffers),
    attachments: Attachments,
    origin: [f32; 2],
    (map, unit): (Option<DepthMap>, f64),
) {
    let buffers = buffers!(splat_depth {
        b => [frame, counts, splats, quads, cut_records],
        d => [depths];
        order: &b.order[plan.sorted()],
    });
    let [depth_offset, depth_scale] = map.map_or([0.0; 2], |map| map.factors());
    let params = splat_depth::Params {
        origin,
        principal_point: plan.principal_point(origin),
        depth_offset,
        depth_scale,
        sigma: plan.data.region.sigma,
        cut_stride: plan.data.weight.cut_stride,
        unit: unit as f32,
    };
    draw(plan, attachments).draw(pipelines, drawer, buffers, params, (&d.draw, 0));
}
