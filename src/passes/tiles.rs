//! Stage `tiles`, the tile rasteriser: a compute shader blends the splats of each tile of pixels, front to back, until the
//! tile is saturated. A draw blends their picture onto what the host has drawn; where nothing lies below, theirs is the
//! picture. A frame whose pairs have no room is drawn as quads instead.

use std::mem::offset_of;

use crate::gpu::{DeviceShape, Drawer, Recorder};
use crate::limits;
use crate::passes::buffers::{Buffers, TileBuffers, buffers, indirect};
use crate::passes::pipelines::{Draw, Kernel, Pipelines};
use crate::passes::plan::Plan;
use crate::passes::shaders::{composite, tiles};
use crate::passes::stage::{Frame, Stage, Targets};
use crate::passes::weight::Weight;
use crate::passes::work::Work;
use crate::precision::TargetFormat;
use crate::settings::Show;
use crate::types::{self, FrameCounts};

pub(crate) const STAGE: Stage = Stage {
    name: "tiles",
    needed: |plan| plan.is_tiled() && plan.work != Work::Draw,
    missed: |plan| plan.is_tiled() || plan.gaussians() == 0,
    pipelines: |plan, need| {
        lists(plan)
            .iter()
            .for_each(|list| need(kernel(plan, *list).key()))
    },
    record,
};

/// How the invocations of a workgroup share its tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct TileWork {
    /// Pixels that an invocation owns, one above the other.
    rows: u32,
    /// True when subgroups load splats together.
    subgroups: bool,
}

impl TileWork {
    /// The sharing that suits a device. Its subgroups can shuffle if their size is not 0.
    pub(crate) fn suiting(shape: DeviceShape, subgroup_size: u32) -> Self {
        let is_cpu = shape == DeviceShape::Cpu;
        let rows = if is_cpu { limits::TILE_HEIGHT } else { 1 };
        let invocations = limits::TILE_WIDTH * (limits::TILE_HEIGHT / rows);
        Self {
            rows,
            // The shader counts on subgroups without gaps, which come together again after each branch. CPU drivers run
            // them like that, as vectors under a mask; Vulkan does not promise it unless it is asked for. On GPUs a batch goes
            // through shared memory, which asks for nothing.
            subgroups: is_cpu && subgroup_size > 0 && invocations.is_multiple_of(subgroup_size),
        }
    }
}

/// How the pixels of the tiles' picture are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum TilePixels {
    /// As floats, which a draw can blend.
    #[default]
    Float,
    /// As those of a target of 8 bits a channel.
    Byte,
}

impl TilePixels {
    /// The pixels with which the tiles' picture is a target's, to the byte. `None` for 16-bit floats, to which one driver
    /// rounds in shaders and cuts off in blending.
    pub(crate) fn of(target: TargetFormat) -> Option<Self> {
        match target {
            TargetFormat::Float => Some(Self::Float),
            TargetFormat::Unorm8 => Some(Self::Byte),
            TargetFormat::Half => None,
        }
    }

    /// Bytes of a pixel.
    pub(crate) const fn bytes(self) -> u64 {
        match self {
            Self::Float => TargetFormat::Float.pixel_bytes(),
            Self::Byte => TargetFormat::Unorm8.pixel_bytes(),
        }
    }

    /// The shaders' name of them, `PIXELS_*`.
    const fn code(self) -> u32 {
        match self {
            Self::Float => types::PIXELS_FLOAT,
            Self::Byte => types::PIXELS_BYTE,
        }
    }
}

/// The tiles that a dispatch draws: all, or with the kernels for GPUs one of the two lists of those that hold anything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum List {
    /// All tiles, strip by strip.
    All,
    /// Tiles that need no code for several surfaces, which takes most of a pipeline's registers.
    Few,
    /// Tiles in which several surfaces cut a splat.
    Several,
}

/// True when tiles in which several surfaces cut a splat are told from the others.
pub(super) fn has_several_kinds(plan: &Plan) -> bool {
    let weight = Weight::of(plan);
    weight.several && weight.mode == types::MODE_EXACT
}

/// The lists that a frame draws.
fn lists(plan: &Plan) -> &'static [List] {
    match plan.way.shape {
        DeviceShape::Cpu => &[List::All],
        // A reclipped frame takes over the lists of a frame in which nothing was cut.
        DeviceShape::Gpu { .. } if has_several_kinds(plan) && !plan.reclips() => {
            &[List::Few, List::Several]
        }
        DeviceShape::Gpu { .. } => &[List::Few],
    }
}

fn kernel(plan: &Plan, list: List) -> Kernel<tiles::Program> {
    let weight = Weight::of(plan);
    let is_one_of_two = list == List::Few && lists(plan).len() > 1;
    let work = plan.tile_work;
    let constants = tiles::Constants {
        clip_mode: weight.mode,
        several: weight.several && !is_one_of_two,
        combined: weight.combined && !is_one_of_two,
        decay: weight.decay,
        miss: weight.miss,
        phi_form: weight.phi,
        rows: work.rows,
        local_size_y: limits::TILE_HEIGHT / work.rows,
        reclipped: plan.reclips(),
        depth_form: plan.occluders.map_or(types::DEPTH_NONE, |o| o.form),
        show: plan.way.show.code(),
        pixels: plan.way.tile_pixels.code(),
        listed: list != List::All,
    };
    let shader = if work.subgroups {
        &tiles::SUBGROUP_COMP
    } else {
        &tiles::COMP
    };
    let kernel = Kernel::new(shader, constants);
    match list {
        List::All | List::Few => kernel,
        List::Several => kernel.named("several_tiles"),
    }
}

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (plan, b, t) = (frame.plan, frame.buffers, frame.tiles());
    let [depth_offset, depth_scale] = plan.occluders.map_or([0.0; 2], |o| o.map.factors());
    let (at, size) = (frame.copied.offset, frame.copied.extent);
    let params = tiles::Params {
        principal_point: plan.principal_point([0.0; 2]),
        sigma: plan.data.region.sigma,
        cut_stride: plan.data.weight.cut_stride,
        depth_offset,
        depth_scale,
        copy_origin: [at.x, at.y],
        copy_size: [size.width, size.height],
        list: 0,
    };
    for &list in lists(plan) {
        let buffers = buffers!(tiles {
            b => [frame, splats, cut_records];
            picture: &t.picture.pixels,
            picture_words: &t.picture.pixels,
            tile_splats: &t.splats,
            tile_begins: &t.picture.begins,
            // Only a reclipped frame reads which tiles are dirty.
            dirty: b.reclip.get().map_or(&b.counts, |reclip| &reclip.dirty),
            occluders: plan.occluders.map_or(&b.counts, |_| &t.occluders),
            tile_list: t.scratch.tile_list().unwrap_or(&b.counts),
        });
        let groups = match list {
            List::All | List::Few => indirect!(b.counts, FrameCounts, tile_groups),
            List::Several => indirect!(b.counts, FrameCounts, several_tile_groups),
        };
        let params = tiles::Params {
            list: (list == List::Several).into(),
            ..params
        };
        kernel(plan, list).dispatch(frame.pipelines, recorder, buffers, params, groups);
    }
}

/// The draw of the tiles' picture, in linear light where a target asks for it and colours are shown.
pub(crate) fn composite(plan: &Plan, targets: Targets) -> Draw<composite::Program> {
    let shows_colours = matches!(plan.way.show, Show::Colour | Show::Weight);
    let constants = composite::Constants {
        linear: targets.linear && shows_colours,
    };
    let shaders = [&composite::VERT, &composite::FRAG];
    Draw::new(shaders, constants, targets.colour, false)
}

/// Blends the tiles' picture onto what the host has drawn, inside the host's rendering scope. `origin` is where its viewport
/// begins, px.
pub(crate) fn record_composite(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (plan, b, t): (&Plan, &Buffers, &TileBuffers),
    targets: Targets,
    origin: [f32; 2],
) {
    let buffers = buffers!(composite {
        b => [frame];
        picture: &t.picture.pixels,
        tile_begins: &t.picture.begins,
    });
    let args = (&b.counts, offset_of!(FrameCounts, composite) as u64);
    let params = composite::Params { origin };
    composite(plan, targets).draw(pipelines, drawer, buffers, params, args);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_subgroups_of_cpu_drivers_load_together() {
        for (shape, size, subgroups) in [
            (DeviceShape::Cpu, 4, true),
            (DeviceShape::Cpu, 8, true),
            (DeviceShape::Cpu, 16, false),
            (DeviceShape::Cpu, 0, false),
            (DeviceShape::Gpu { subgroup: 32 }, 32, false),
        ] {
            assert_eq!(
                TileWork::suiting(shape, size).subgroups,
                subgroups,
                "{size}"
            );
        }
    }
}
