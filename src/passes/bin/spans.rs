//! Finds the spans of each row of tiles, by runs of consecutive splats, then their splats in each of the row's tiles. Its
//! scratch is the counts and the spans of [`TileBuffers`](crate::passes::buffers::TileBuffers).

use crate::gpu::{Groups, Recorder};
use crate::passes::buffers::indirect;
use crate::passes::shaders::{
    span_count, span_scan, span_scatter, tile_count, tile_scan, tile_scatter,
};
use crate::passes::sort;
use crate::passes::stage::{Frame, KernelSet, key};
use crate::types::FrameCounts;

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |plan, need| {
        need(key::<span_count::Program>(plan));
        need(key::<span_scan::Program>(plan));
        need(key::<span_scatter::Program>(plan));
        need(key::<tile_count::Program>(plan));
        need(key::<tile_scan::Program>(plan));
        need(key::<tile_scatter::Program>(plan));
    },
    record,
};

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (b, t) = (frame.buffers, frame.tiles());
    // The buffers that the sort has left over have room for the masks in the order of depth.
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
    frame.dispatch(recorder, buffers, (), runs);
    let buffers = span_scan::Buffers {
        frame: &b.frame,
        counts: &b.counts,
        span_counts: &t.span_counts,
        row_begins: &t.row_begins,
    };
    frame.dispatch(recorder, buffers, (), Groups::Count(1));
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
    frame.dispatch(recorder, buffers, (), runs_with_room);
    let buffers = tile_count::Buffers {
        frame: &b.frame,
        row_begins: &t.row_begins,
        column_counts: &t.column_counts,
        span_columns: &t.span_columns,
    };
    frame.dispatch(recorder, buffers, (), parts);
    let buffers = tile_scan::Buffers {
        frame: &b.frame,
        row_begins: &t.row_begins,
        column_counts: &t.column_counts,
        tile_begins: &t.begins,
    };
    frame.dispatch(recorder, buffers, (), rows);
    let buffers = tile_scatter::Buffers {
        frame: &b.frame,
        row_begins: &t.row_begins,
        column_counts: &t.column_counts,
        span_splats: &t.span_splats,
        span_columns: &t.span_columns,
        counts: &b.counts,
        tile_splats: &t.splats,
    };
    frame.dispatch(recorder, buffers, (), parts);
}
