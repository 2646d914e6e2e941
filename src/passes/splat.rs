//! Draws the splats as quads, by a mesh shader or by instancing, back to front and blended `over`. The fragment stage reads
//! the cutoff records for cut splats only.

use std::mem::offset_of;

use ash::vk;

use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::shaders::splat;
use crate::passes::storage::buffers;
use crate::passes::weight::{self, Weight};
use crate::passes::{cutoff, project, shared, sort};
use crate::types::FrameCounts;
use rara_gpu::{Attachments, DepthUse, Drawer};
use rara_scene::depth::DepthMap;
use rara_scene::settings::Raster;

/// The pipeline that a plan needs: without a clip the fragment shader holds no clip code.
pub(crate) fn draw(plan: &EyePlan, attachments: Attachments) -> Draw<splat::Program> {
    let one_sample = attachments.samples == vk::SampleCountFlags::TYPE_1;
    let shaders = match plan.way.raster {
        Raster::Mesh if one_sample => [&splat::MESH, &splat::MESH_FRAG],
        Raster::Mesh => [&splat::FLAT_MESH, &splat::FRAG],
        _ => [&splat::VERT, &splat::FRAG],
    };
    let weight = Weight::from_plan(plan);
    let constants = splat::Constants {
        clip_mode: weight.mode,
        several: weight.several,
        combined: weight.combined,
        meshes: weight.meshes,
        many: weight.many,
        decay: weight.decay,
        miss: weight.miss,
        phi_form: weight.phi,
        depth: attachments.depth.is_some(),
        show: weight::show_code(plan.way.show),
    };
    Draw::new(shaders, constants, attachments, DepthUse::Tested)
}

/// Draws inside the host's rendering scope. `origin` is where its viewport begins, px; `map` says what the host's depth
/// buffer holds for a depth, if it is tested.
pub(crate) fn record(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (plan, b): (&EyePlan, &Buffers<EyePlan>),
    attachments: Attachments,
    origin: [f32; 2],
    map: Option<DepthMap>,
) {
    let buffers = buffers!(splat {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [splats, quads],
        cutoff::MEMORY => [cut_records];
        order: sort::order(plan),
    });
    let [depth_offset, depth_scale] = map.map_or([0.0; 2], |map| map.factors());
    let params = splat::Params {
        origin,
        principal_point: plan.principal_point(origin),
        depth_offset,
        depth_scale,
        sigma: plan.cut.data.region.sigma,
        cut_stride: plan.data.weight.cut_stride,
        alpha_max: plan.data.tiles.alpha_max,
    };
    let at = match plan.way.raster {
        Raster::Mesh => offset_of!(FrameCounts, mesh_groups),
        _ => offset_of!(FrameCounts, draw),
    };
    let args = (b.get(&shared::MEMORY.counts), at as u64);
    let buffers = (buffers, |storage| b.get(storage));
    draw(plan, attachments).draw(pipelines, drawer, buffers, params, args);
}
