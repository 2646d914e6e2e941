//! Finds the spans of each row of tiles, by runs of consecutive splats, then their splats in each of the row's tiles. Its
//! scratch is the counts and the spans of [`TileBuffers`](crate::passes::buffers::TileBuffers).

use crate::gpu::{Groups, Recorder};
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::Cost;
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

#[cfg(feature = "lab")]
pub(in crate::passes) const COSTS: &[Cost] = &[
    // For each splat of its run its number, its mask, and the count of each span's row.
    Cost::of::<span_count::Program>(
        |n| n.span_runs,
        |n| 1 + 2 * n.survivors.div_ceil(n.span_runs) + n.spans.div_ceil(n.span_runs),
    ),
    // The counts of a row of tiles in each run, to sum them and once more to place them.
    Cost::of::<span_scan::Program>(
        |_| ROWS_SCANNED,
        |n| {
            let rows = n.tile_rows.div_ceil(ROWS_SCANNED);
            1 + n.span_runs.div_ceil(ROWS_SCANNED) + 2 * n.span_runs * rows
        },
    ),
    // For each splat of its run its number and its mask, and the place of each span.
    Cost::of::<span_scatter::Program>(
        |n| n.span_runs,
        |n| 1 + n.survivors.div_ceil(n.span_runs) + n.spans.div_ceil(n.span_runs),
    ),
    // For each span of its part the span and the counts of its columns; then the sums along the row.
    Cost::of::<tile_count::Program>(
        |n| n.parts(),
        |n| 2 + 2 * n.spans.div_ceil(n.parts()) + n.tile_columns,
    ),
    // The pairs of the parts before its row; then the counts of the row's columns in each part.
    Cost::of::<tile_scan::Program>(
        |n| n.tile_rows,
        |n| 1 + (n.tile_rows - 1) * n.row_parts + n.tile_columns * n.row_parts,
    ),
    // For each span of its part the span, and for each of its pairs the place.
    Cost::of::<tile_scatter::Program>(
        |n| n.parts(),
        |n| 2 + n.spans.div_ceil(n.parts()) + n.pairs.div_ceil(n.parts()),
    ),
];

/// Rows of tiles that the one workgroup of `span_scan` goes through together: its size.
#[cfg(feature = "lab")]
const ROWS_SCANNED: u64 = 256;

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
