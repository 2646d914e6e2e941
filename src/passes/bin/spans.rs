//! First the spans of each row of tiles, by runs of consecutive splats, then their splats in each of the row's tiles. Its
//! scratch are the counts and the spans of [`TileBuffers`](crate::passes::buffers::TileBuffers).

use crate::gpu::{Groups, Recorder};
use crate::passes::buffers::indirect;
use crate::passes::pipelines::Kernel;
use crate::passes::shaders::{
    span_count, span_scan, span_scatter, tile_count, tile_scan, tile_scatter,
};
use crate::passes::sort;
use crate::passes::stage::{Frame, KernelSet};
use crate::types::FrameCounts;

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |_, need| {
        need(counts_spans().key());
        need(places_spans().key());
        need(lists_spans().key());
        need(counts_tiles().key());
        need(places_tiles().key());
        need(lists_tiles().key());
    },
    record,
};

fn counts_spans() -> Kernel<span_count::Program> {
    Kernel::new(&span_count::COMP, ())
}

fn places_spans() -> Kernel<span_scan::Program> {
    Kernel::new(&span_scan::COMP, ())
}

fn lists_spans() -> Kernel<span_scatter::Program> {
    Kernel::new(&span_scatter::COMP, ())
}

fn counts_tiles() -> Kernel<tile_count::Program> {
    Kernel::new(&tile_count::COMP, ())
}

fn places_tiles() -> Kernel<tile_scan::Program> {
    Kernel::new(&tile_scan::COMP, ())
}

fn lists_tiles() -> Kernel<tile_scatter::Program> {
    Kernel::new(&tile_scatter::COMP, ())
}

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (pipelines, b, t) = (frame.pipelines, frame.buffers, frame.tiles());
    // What the sort has left over has room for the masks in the order of depth.
    let sort::Sorted {
        order,
        spare: [mask_origins, masks_above, masks_below],
    } = sort::sorted(frame);
    let runs = indirect!(b.counts, FrameCounts, span_count_groups);
    let runs_with_room = indirect!(b.counts, FrameCounts, span_groups);
    let parts = indirect!(b.counts, FrameCounts, part_groups);
    let rows = indirect!(b.counts, FrameCounts, row_groups);
    let buffers = span_count::Buffers {
        frame: &b.frame,
        counts: &b.counts,
        splats: &b.splats,
        order,
        span_counts: &t.span_counts,
        tile_masks: &b.tile_masks,
        mask_origins,
        masks_above,
        masks_below,
    };
    counts_spans().dispatch(pipelines, recorder, buffers, (), runs);
    let buffers = span_scan::Buffers {
        frame: &b.frame,
        counts: &b.counts,
        span_counts: &t.span_counts,
        row_begins: &t.row_begins,
    };
    places_spans().dispatch(pipelines, recorder, buffers, (), Groups::Count(1));
    let buffers = span_scatter::Buffers {
        frame: &b.frame,
        counts: &b.counts,
        splats: &b.splats,
        order,
        span_counts: &t.span_counts,
        span_splats: &t.span_splats,
        span_columns: &t.span_columns,
        mask_origins,
        masks_above,
        masks_below,
    };
    lists_spans().dispatch(pipelines, recorder, buffers, (), runs_with_room);
    let buffers = tile_count::Buffers {
        frame: &b.frame,
        row_begins: &t.row_begins,
        column_counts: &t.column_counts,
        span_columns: &t.span_columns,
    };
    counts_tiles().dispatch(pipelines, recorder, buffers, (), parts);
    let buffers = tile_scan::Buffers {
        frame: &b.frame,
        row_begins: &t.row_begins,
        column_counts: &t.column_counts,
        tile_begins: &t.begins,
    };
    places_tiles().dispatch(pipelines, recorder, buffers, (), rows);
    let buffers = tile_scatter::Buffers {
        frame: &b.frame,
        row_begins: &t.row_begins,
        column_counts: &t.column_counts,
        span_splats: &t.span_splats,
        span_columns: &t.span_columns,
        counts: &b.counts,
        tile_splats: &t.splats,
    };
    lists_tiles().dispatch(pipelines, recorder, buffers, (), parts);
}
