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
use crate::passes::splat::WeightKey;
use crate::passes::work::Work;
use crate::settings::Show;
use crate::types::{self, FrameCounts};

/// The splats of each tile, by depth: first the spans of each row of tiles, then their splats in each of the row's tiles.
#[derive(Debug, Clone)]
pub(crate) struct Bin {
    span_count: ComputePipeline,
    span_scan: ComputePipeline,
    span_scatter: ComputePipeline,
    tile_count: ComputePipeline,
    tile_scan: ComputePipeline,
    tile_scatter: ComputePipeline,
}

impl Bin {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            span_count: context.compute("span_count", &shaders::SPAN_COUNT_COMP, &[])?,
            span_scan: context.compute("span_scan", &shaders::SPAN_SCAN_COMP, &[])?,
            span_scatter: context.compute("span_scatter", &shaders::SPAN_SCATTER_COMP, &[])?,
            tile_count: context.compute("tile_count", &shaders::TILE_COUNT_COMP, &[])?,
            tile_scan: context.compute("tile_scan", &shaders::TILE_SCAN_COMP, &[])?,
            tile_scatter: context.compute("tile_scatter", &shaders::TILE_SCATTER_COMP, &[])?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        b: &Buffers,
        t: &TileBuffers,
        plan: &Plan,
    ) {
        let sorted = plan.sorted();
        let order = &b.order[sorted];
        // What the sort has done with has room for the masks in the order of depth.
        let [origins, above, below] = [&b.keys[0], &b.keys[1], &b.order[sorted ^ 1]];
        let at = |offset: usize| Groups::Indirect(&b.counts, offset as u64);
        let runs = at(offset_of!(FrameCounts, sort_groups));
        let runs_with_room = at(offset_of!(FrameCounts, span_groups));
        let parts = at(offset_of!(FrameCounts, part_groups));
        let rows = at(offset_of!(FrameCounts, row_groups));
        let span_count = [
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
        recorder.dispatch(&self.span_count, &span_count, &[], runs);
        let span_scan = [&b.frame, &b.counts, &b.histogram, &t.row_begins];
        recorder.dispatch(&self.span_scan, &span_scan, &[], Groups::Count(1));
        let span_scatter = [
            &b.frame,
            &b.counts,
            &b.splats,
            order,
            &b.histogram,
            &t.span_splats,
            &t.span_columns,
            origins,
            above,
            below,
        ];
        recorder.dispatch(&self.span_scatter, &span_scatter, &[], runs_with_room);
        let tile_count = [&b.frame, &t.row_begins, &t.column_counts, &t.span_columns];
        recorder.dispatch(&self.tile_count, &tile_count, &[], parts);
        let tile_scan = [&b.frame, &t.row_begins, &t.column_counts, &t.begins];
        recorder.dispatch(&self.tile_scan, &tile_scan, &[], rows);
        let tile_scatter = [
            &b.frame,
            &t.row_begins,
            &t.column_counts,
            &t.span_splats,
            &t.span_columns,
            &b.counts,
            &t.splats,
        ];
        recorder.dispatch(&self.tile_scatter, &tile_scatter, &[], parts);
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
        // Only a sweep looks at what is dirty.
        let dirty = b.sweep.as_ref().map_or(&b.counts, |sweep| &sweep.dirty);
        let occluders = plan.occluders.map_or(&b.counts, |_| &t.occluders);
        let buffers = [
            &b.frame, &b.splats, &t.splats, &t.begins, &b.cuts, &t.picture, dirty, occluders,
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
