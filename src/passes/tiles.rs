//! Stage `tiles`, the tile rasteriser: a compute shader blends the splats of each tile of pixels, front to back, until the
//! tile is saturated. A draw blends their picture onto what the host has drawn; where nothing lies below, theirs is the
//! picture. A frame whose pairs have no room is drawn as quads instead.

use std::mem::offset_of;

use crate::gpu::{Attachments, DeviceShape, Drawer, Recorder};
use crate::limits;
use crate::passes::buffers::{Buffers, TileBuffers, buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost};
use crate::passes::pipelines::{Draw, Kernel, Pipelines};
use crate::passes::plan::Plan;
use crate::passes::shaders::{composite, tiles};
use crate::passes::stage::{Frame, Stage};
use crate::passes::weight::Weight;
use crate::passes::work::Work;
use crate::precision::TargetFormat;
use crate::settings::Show;
use crate::types::{self, FrameCounts};

pub(crate) const STAGE: Stage = Stage {
    name: "tiles",
    needed: |plan| plan.is_tiled() && plan.work != Work::Draw,
    missed: |plan| plan.is_tiled() || plan.gaussians() == 0,
    pipelines: |plan, need| need(kernel(plan).key()),
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
            // them like that, as vectors under a mask; Vulkan does not promise it unless it is asked for. GPUs, whose
            // loads serve all invocations at once, would not gain as much either.
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

fn kernel(plan: &Plan) -> Kernel<tiles::Program> {
    let weight = Weight::of(plan);
    let work = plan.tile_work;
    let constants = tiles::Constants {
        clip_mode: weight.mode,
        several: weight.several,
        decay: weight.decay,
        miss: weight.miss,
        phi_form: weight.phi,
        rows: work.rows,
        local_size_y: limits::TILE_HEIGHT / work.rows,
        reclipped: plan.reclips(),
        depth_form: plan.occluders.map_or(types::DEPTH_NONE, |o| o.form),
        show_weight: plan.way.show == Show::Weight,
        pixels: plan.way.tile_pixels.code(),
    };
    let shader = if work.subgroups {
        &tiles::SUBGROUP_COMP
    } else {
        &tiles::COMP
    };
    Kernel::new(shader, constants)
}

#[cfg(feature = "lab")]
pub(super) const COSTS: &[Cost] = &[
    // All rows of a strip have invocations. The tile's bounds; and for each batch of the splats of a tile as full as the others
    // their numbers, the splats and, if they are cut, the rest of them. It reads the tiles' lists as far as they are loaded, and
    // the first half of each splat and its curvature once for the tiles of a macro-tile, which are drawn one after the other;
    // and it writes the pixels.
    Cost::of::<tiles::Program>(
        |n| {
            let rows = n.tile_rows.next_multiple_of(limits::STRIP_ROWS.into());
            n.tile_columns * rows * u64::from(limits::TILE_WIDTH * limits::TILE_HEIGHT)
        },
        |n| {
            let batch = u64::from(limits::TILE_WIDTH * limits::TILE_HEIGHT);
            2 + 3 * n
                .pairs
                .div_ceil(n.tile_columns * n.tile_rows)
                .div_ceil(batch)
        },
        |n| {
            let splat = cost::SPLAT / 2;
            let curvature = cost::gathered(4 * cost::WORD);
            let lists = (n.tiles() + n.loaded) * cost::WORD;
            let share = n.loaded as f64 / n.pairs.max(1) as f64;
            let cut = n.cut as f64 / n.survivors.max(1) as f64;
            let splats = n.macro_pairs as f64
                * share
                * (cost::gathered(splat) as f64 + cut * curvature as f64);
            let pixels = n.tiles() * u64::from(limits::TILE_WIDTH * limits::TILE_HEIGHT);
            lists + splats as u64 + pixels * TilePixels::Float.bytes()
        },
    )
    // A turn a splat, of a loop in a loop.
    .turning(|n| n.loaded as f64 / n.tiles().max(1) as f64 / 32.0),
];

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (plan, b, t) = (frame.plan, frame.buffers, frame.tiles());
    let buffers = buffers!(tiles {
        b => [frame, splats, cut_records];
        picture: &t.picture.pixels,
        picture_words: &t.picture.pixels,
        tile_splats: &t.splats,
        tile_begins: &t.picture.begins,
        // Only a reclipped frame reads which tiles are dirty.
        dirty: b.reclip.as_ref().map_or(&b.counts, |reclip| &reclip.dirty),
        occluders: plan.occluders.map_or(&b.counts, |_| &t.occluders),
    });
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
    };
    let groups = indirect!(b.counts, FrameCounts, tile_groups);
    kernel(plan).dispatch(frame.pipelines, recorder, buffers, params, groups);
}

/// The draw of the tiles' picture.
pub(crate) fn composite(attachments: Attachments) -> Draw<composite::Program> {
    Draw::new([&composite::VERT, &composite::FRAG], (), attachments, false)
}

/// Blends the tiles' picture onto what the host has drawn, inside the host's rendering scope. `origin` is where its viewport
/// begins, px.
pub(crate) fn record_composite(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (b, t): (&Buffers, &TileBuffers),
    attachments: Attachments,
    origin: [f32; 2],
) {
    let buffers = buffers!(composite {
        b => [frame];
        picture: &t.picture.pixels,
        tile_begins: &t.picture.begins,
    });
    let args = (&b.counts, offset_of!(FrameCounts, composite) as u64);
    let params = composite::Params { origin };
    composite(attachments).draw(pipelines, drawer, buffers, params, args);
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
