//! Stages 8 and 9, the tile rasteriser: which splats meet each tile of pixels, front to back, and a compute shader that blends them until
//! the tile is saturated. What does not fit is drawn as quads in the same frame.

use std::mem::offset_of;

use ash::vk;

use crate::error::Result;
use crate::gpu::{Attachments, ComputePipeline, Drawer, GraphicsPipeline, Groups, Recorder};
use crate::limits;
use crate::passes::buffers::{Buffers, TileBuffers};
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::shaders;
use crate::passes::sort::Sort;
use crate::passes::splat::WeightKey;
use crate::passes::work::Work;
use crate::settings::Show;
use crate::types::{self, FrameCounts};

/// Pairs of tile and splat, ordered by tile and within each tile by depth.
#[derive(Debug, Clone)]
pub(crate) struct Bin {
    count: ComputePipeline,
    scan: ComputePipeline,
    scatter: ComputePipeline,
    ranges: ComputePipeline,
}

impl Bin {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            count: context.compute("bin_count", &shaders::BIN_COUNT_COMP, &[])?,
            scan: context.compute("bin_scan", &shaders::BIN_SCAN_COMP, &[])?,
            scatter: context.compute("bin_scatter", &shaders::BIN_SCATTER_COMP, &[])?,
            ranges: context.compute("bin_ranges", &shaders::BIN_RANGES_COMP, &[])?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        sort: &Sort,
        b: &Buffers,
        t: &TileBuffers,
        plan: &Plan,
    ) {
        let order = &b.order[plan.sorted()];
        // What the sort has done with has room for the masks in the order of depth.
        let [origins, above, below] = [&b.keys[0], &b.keys[1], &b.order[plan.sorted() ^ 1]];
        let at = |offset: usize| Groups::Indirect(&b.counts, offset as u64);
        let survivors = at(offset_of!(FrameCounts, sort_groups));
        let pairs = at(offset_of!(FrameCounts, pair_groups));
        let count = [
            &b.frame,
            &b.counts,
            &b.splats,
            order,
            &b.histogram,
            &b.tile_masks,
            origins,
            above,
            below,
        ];
        recorder.dispatch(&self.count, &count, &[], survivors);
        let scan = [&b.frame, &b.counts, &b.histogram];
        recorder.dispatch(&self.scan, &scan, &[], Groups::Count(1));
        let (tiles, splats) = (&t.pair_tiles[0], &t.pair_splats[0]);
        let scatter = [
            &b.frame,
            &b.counts,
            &b.splats,
            order,
            &b.histogram,
            tiles,
            splats,
            origins,
            above,
            below,
        ];
        recorder.dispatch(&self.scatter, &scatter, &[], pairs);
        sort.record_pairs(recorder, b, t, plan.tile_digits);
        let ranges = [
            &b.frame,
            &b.counts,
            &t.pair_tiles[plan.sorted_pairs()],
            &t.begins,
        ];
        recorder.dispatch(&self.ranges, &ranges, &[], pairs);
    }
}

/// How the invocations of a workgroup share its tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct TileWork {
    /// Pixels that an invocation owns, one above the other.
    rows: u32,
    /// Whether subgroups load splats together.
    subgroups: bool,
}

impl TileWork {
    /// What suits a device whose subgroups can shuffle if their size is not 0.
    pub(crate) fn suiting(is_cpu: bool, subgroup_size: u32) -> Self {
        let rows = if is_cpu { limits::TILE_HEIGHT } else { 1 };
        let invocations = limits::TILE_WIDTH * (limits::TILE_HEIGHT / rows);
        Self {
            rows,
            // The shader counts on subgroups without gaps, which come together again after each branch. That is how CPU
            // drivers run them, as vectors under a mask; Vulkan promises it to none who has not asked for it. GPUs, whose
            // loads serve all invocations at once, would not gain as much either.
            subgroups: is_cpu && subgroup_size > 0 && invocations.is_multiple_of(subgroup_size),
        }
    }
}

/// What tells one pipeline of the tiles' pixels from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct TilesKey {
    weight: WeightKey,
    work: TileWork,
    sweep: bool,
    depth: u32,
    show: Show,
}

impl TilesKey {
    /// What a plan needs.
    pub(crate) fn new(plan: &Plan) -> Self {
        Self {
            weight: WeightKey::new(plan),
            work: plan.tile_work,
            sweep: matches!(plan.work, Work::Sweep { .. }),
            depth: plan.occluders.map_or(types::DEPTH_NONE, |o| o.form),
            show: plan.show,
        }
    }
}

/// The tiles' pixels.
#[derive(Debug, Clone)]
pub(crate) struct Tiles {
    pipeline: ComputePipeline,
}

impl Tiles {
    pub(crate) fn new(context: &Context<'_>, key: TilesKey) -> Result<Self> {
        let [mode, op, decay, miss, phi] = key.weight.constants();
        let constants = [
            mode,
            op,
            decay,
            miss,
            phi,
            (5, key.work.rows),
            (6, limits::TILE_HEIGHT / key.work.rows),
            (7, key.sweep.into()),
            (8, key.depth),
            (9, (key.show == Show::Weight).into()),
        ];
        let shader = if key.work.subgroups {
            &shaders::TILES_SUBGROUP_COMP
        } else {
            &shaders::TILES_COMP
        };
        Ok(Self {
            pipeline: context.compute("tiles", shader, &constants)?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        b: &Buffers,
        t: &TileBuffers,
        (plan, copied): (&Plan, vk::Rect2D),
    ) {
        let splats = &t.pair_splats[plan.sorted_pairs()];
        // Only a sweep looks at what is dirty.
        let dirty = b.sweep.as_ref().map_or(&b.counts, |sweep| &sweep.dirty);
        let occluders = plan.occluders.map_or(&b.counts, |_| &t.occluders);
        let buffers = [
            &b.frame, &b.splats, splats, &t.begins, &b.cuts, &t.picture, dirty, occluders,
        ];
        let [_, _, cx, cy] = plan.data.focal.map(f32::to_bits);
        let [offset, scale] = plan.occluders.map_or([0, 0], |o| o.map.words());
        let (at, size) = (copied.offset, copied.extent);
        let sigma = plan.data.sigma.to_bits();
        let params = [
            0,
            0,
            sigma,
            plan.cut_stride,
            cx,
            cy,
            offset,
            scale,
            at.x as u32,
            at.y as u32,
            size.width,
            size.height,
        ];
        let tiles = Groups::Indirect(&b.counts, offset_of!(FrameCounts, tile_groups) as u64);
        recorder.dispatch(&self.pipeline, &buffers, &params, tiles);
    }
}

/// The tiles' picture, blended onto what the host has drawn.
#[derive(Debug, Clone)]
pub(crate) struct Composite {
    pipeline: GraphicsPipeline,
}

impl Composite {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        let (front, fragment) = (&shaders::COMPOSITE_VERT, &shaders::COMPOSITE_FRAG);
        Ok(Self {
            pipeline: context.graphics("composite", front, fragment, &[], false)?,
        })
    }

    /// Draws inside the host's rendering scope; `origin` is where its viewport begins, px.
    pub(crate) fn record(
        &self,
        drawer: &mut Drawer<'_>,
        b: &Buffers,
        t: &TileBuffers,
        origin: [f32; 2],
    ) {
        let buffers = [&b.frame, &t.picture, &t.begins];
        let at = offset_of!(FrameCounts, composite) as u64;
        drawer.draw_indirect(
            &self.pipeline,
            &buffers,
            &origin.map(f32::to_bits),
            &b.counts,
            at,
        );
    }
}

/// Graphics pipelines differ by what they draw into.
pub(crate) type Composites = std::collections::HashMap<Attachments, Composite>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_subgroups_of_cpu_drivers_load_together() {
        for (is_cpu, size, subgroups) in [
            (true, 4, true),
            (true, 8, true),
            (true, 16, false),
            (true, 0, false),
            (false, 32, false),
        ] {
            assert_eq!(
                TileWork::suiting(is_cpu, size).subgroups,
                subgroups,
                "{size}"
            );
        }
    }
}
