//! Stage `tiles`, the tile rasteriser: a compute shader blends the splats of each tile of pixels, front to back, until the
//! tile is saturated. [`composite`](super::composite) blends their picture onto what the host has drawn; where nothing lies
//! below, theirs is the picture.

use crate::passes::bin::{lists, macro_tiles};
use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::Pipeline;
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::tiles;
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::tile_picture::TilePicture;
use crate::passes::weight::{self, Weight};
use crate::passes::work::Work;
use crate::passes::{cutoff, project, reclip, shared};
use crate::types::{self, LayerMotion, SurfaceData};
use rara_base::limits;
use rara_gpu::{Buffer, DeviceShape};

pub(crate) static STAGE: Stage<EyePlan> = Stage {
    name: "tiles",
    needed: |plan| plan.is_tiled() && plan.work != Work::Draw,
    missed: |plan| plan.is_tiled() || plan.gaussians() == 0,
    memory: &[STORAGES],
    record,
};

/// The most surfaces of the clips of two frames of which pixels are asked whether the earlier one kept them.
pub(super) const MOTION_SURFACES: usize = 512;

memory! { EyePlan:
    /// The picture that the tiles make, and behind it what else they find of each pixel, as `behind.glsl` says.
    tile_picture: |plan| plan.when_tiled(plan.pixels() * plan.way.tile_pixels.bytes() + behind(plan)),
        in EyePlan::picture_location;
    /// How each layer has moved since the frame before.
    motions: |plan| match plan.way.draws_motion {
        true => u64::from(plan.cut.data.scene.layer_count) * size_of::<LayerMotion>() as u64,
        false => 0,
    };
    /// The surfaces of the clips of the frame before and of this one, where motion is wanted.
    motion_surfaces: |plan| match plan.way.draws_motion {
        true => (MOTION_SURFACES * size_of::<SurfaceData>()) as u64,
        false => 0,
    };
    /// The host's depth; empty where it hides nothing.
    occluders: |plan| plan.occluders.map_or(0, |_| plan.when_tiled(4 * plan.pixels()));
}

/// The bytes behind the pixels, whole vectors.
fn behind(plan: &EyePlan) -> u64 {
    let way = &plan.way;
    let parts = [
        (way.expects_depth, 2),
        (way.writes_depth, 1),
        (way.draws_motion, 1),
    ];
    let words = parts.map(|(is_found, words)| u64::from(is_found) * words);
    16 * (words.iter().sum::<u64>() * plan.pixels()).div_ceil(4)
}

/// The tiles that a dispatch draws: all, or with the pipelines for GPUs one of the two lists of those that hold anything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum List {
    /// All tiles, strip by strip.
    All,
    /// Tiles that need no code for several surfaces, which takes most of a pipeline's registers.
    Few,
    /// Tiles in which several surfaces cut a splat.
    Several,
}

/// True when those in which several surfaces cut a splat are drawn by themselves.
pub(super) fn has_two_lists(plan: &EyePlan) -> bool {
    drawn_lists(plan).len() > 1
}

/// The lists that a frame draws.
fn drawn_lists(plan: &EyePlan) -> &'static [List] {
    match plan.cut.shape {
        DeviceShape::Cpu => &[List::All],
        // A reclipped frame takes over the lists of a frame in which nothing was cut.
        DeviceShape::Gpu { .. }
            if Weight::from_plan(plan).has_several_kinds() && !plan.reclips() =>
        {
            &[List::Few, List::Several]
        }
        DeviceShape::Gpu { .. } => &[List::Few],
    }
}

fn pipeline(plan: &EyePlan, list: List) -> Pipeline<tiles::Program> {
    let weight = Weight::from_plan(plan);
    let is_one_of_two = list == List::Few && has_two_lists(plan);
    let work = plan.tile_work;
    let constants = tiles::Constants {
        clip_mode: weight.mode,
        several: weight.several && !is_one_of_two,
        combined: weight.combined && !is_one_of_two,
        meshes: weight.meshes && !is_one_of_two,
        many: weight.many && !is_one_of_two,
        decay: match plan.has_soft_depth() {
            true => plan.laws.decay,
            false => weight.decay,
        },
        miss: weight.miss,
        phi_form: weight.phi,
        rows: work.rows,
        local_size_y: limits::TILE_HEIGHT / work.rows,
        reclipped: plan.reclips(),
        depth_form: plan.occluders.map_or(types::DEPTH_NONE, |o| o.form),
        show: weight::show_code(plan.way.show),
        pixels: plan.way.tile_pixels.code(),
        listed: list != List::All,
        expected_depth: plan.way.expects_depth,
        written_depth: plan.way.writes_depth,
        soft_depth: plan.has_soft_depth(),
        strongest: plan.way.draws_motion,
    };
    let shader = if work.subgroups {
        &tiles::SUBGROUP_COMP
    } else {
        &tiles::COMP
    };
    let pipeline = Pipeline::new(shader, constants);
    match list {
        List::All | List::Few => pipeline,
        List::Several => pipeline.named("several_tiles"),
    }
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let plan = recording.plan;
    let [depth_offset, depth_scale] = plan.occluders.map_or([0.0; 2], |o| o.map.factors());
    let under = recording
        .depth()
        .map(|depth| depth.under.part)
        .unwrap_or_default();
    let (at, size) = (under.offset, under.extent);
    let params = tiles::Params {
        principal_point: plan.principal_point([0.0; 2]),
        sigma: plan.cut.data.region.sigma,
        cut_stride: plan.data.weight.cut_stride,
        depth_offset,
        depth_scale,
        copy_origin: [at.x, at.y],
        copy_size: [size.width, size.height],
        list: 0,
    };
    for &list in drawn_lists(plan) {
        let buffers = buffers!(tiles {
            shared::MEMORY => [frame],
            project::MEMORY => [splats],
            cutoff::MEMORY => [cut_records],
            lists::MEMORY => [tile_splats, tile_begins],
            macro_tiles::MEMORY => [tile_list],
            reclip::MEMORY => [dirty],
            MEMORY => [occluders];
            picture: &MEMORY.tile_picture,
            picture_words: &MEMORY.tile_picture,
        });
        let groups = match list {
            List::All | List::Few => counted!(tile_groups),
            List::Several => counted!(several_tile_groups),
        };
        let params = tiles::Params {
            list: (list == List::Several).into(),
            ..params
        };
        recording.dispatch_pipeline(&pipeline(plan, list), buffers, params, groups);
    }
}

/// The picture that the tiles of a frame make.
pub(crate) fn picture(b: &Buffers<EyePlan>) -> TilePicture {
    TilePicture {
        begins: b.get(&lists::MEMORY.tile_begins).clone(),
        pixels: b.get(&MEMORY.tile_picture).clone(),
    }
}

/// The host's depth for tiles.
pub(crate) fn occluders(b: &Buffers<EyePlan>) -> &Buffer {
    b.get(&MEMORY.occluders)
}
