//! Finds the spans of each row of tiles, by runs of consecutive splats, then their splats in each of the row's tiles. Its
//! scratch is the counts and the spans of [`TileBuffers`](crate::passes::buffers::TileBuffers).

use crate::gpu::{Groups, Recorder};
use crate::passes::buffers::{buffers, indirect};
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
    let buffers = buffers!(span_count {
        b => [frame, counts, splats, tile_masks],
        t => [span_counts];
        order, mask_origins, masks_above, masks_below,
    });
    frame.dispatch(recorder, buffers, (), runs);
    let buffers = buffers!(span_scan {
        b => [frame, counts],
        t => [span_counts, row_begins],
    });
    frame.dispatch(recorder, buffers, (), Groups::Count(1));
    let buffers = buffers!(span_scatter {
        b => [frame, counts, splats],
        t => [span_counts, span_splats, span_columns];
        order, mask_origins, masks_above, masks_below,
    });
    frame.dispatch(recorder, buffers, (), runs_with_room);
    let buffers = buffers!(tile_count {
        b => [frame],
        t => [row_begins, column_counts, span_columns],
    });
    frame.dispatch(recorder, buffers, (), parts);
    let buffers = buffers!(tile_scan {
        b => [frame],
        t => [row_begins, column_counts];
        tile_begins: &t.picture.begins,
    });
    frame.dispatch(recorder, buffers, (), rows);
    let buffers = buffers!(tile_scatter {
        b => [frame, counts],
        t => [row_begins, column_counts, span_splats, span_columns];
        tile_splats: &t.splats,
    });
    frame.dispatch(recorder, buffers, (), parts);
}
