//! Finds the spans of each row of tiles, by runs of consecutive splats, then their splats in each of the row's tiles. The runs
//! are few and long, as suits processors.

use crate::error::Result;
use crate::gpu::{Buffer, Groups, Recorder};
use crate::passes::bin::ScratchWords;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::plan::Plan;
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

/// The counts and the spans.
#[derive(Debug)]
pub(in crate::passes) struct Scratch {
    span_counts: Buffer,
    row_begins: Buffer,
    span_splats: Buffer,
    span_columns: Buffer,
    column_counts: Buffer,
}

/// The buffers' names, in the order of their words.
pub(super) const NAMES: [&str; 5] = [
    "span_counts",
    "row_begins",
    "span_splats",
    "span_columns",
    "column_counts",
];

pub(super) fn words(plan: &Plan) -> ScratchWords {
    let tiles = &plan.data.tiles;
    let rows = u64::from(tiles.tile_count / tiles.tile_columns);
    let pairs = u64::from(plan.data.room.pair_capacity);
    let parts = rows * u64::from(tiles.row_parts);
    [
        // A run has the number of its spans in each row of tiles, and of its pairs.
        (rows + 1) * u64::from(tiles.span_runs),
        rows + 1,
        pairs,
        pairs,
        parts * (u64::from(tiles.tile_columns) + 1),
        0,
        0,
        0,
        0,
    ]
}

impl Scratch {
    pub(super) fn new(gpu: &mut dyn FnMut(&'static str) -> Result<Buffer>) -> Result<Self> {
        Ok(Self {
            span_counts: gpu("span_counts")?,
            row_begins: gpu("row_begins")?,
            span_splats: gpu("span_splats")?,
            span_columns: gpu("span_columns")?,
            column_counts: gpu("column_counts")?,
        })
    }

    pub(super) fn all(&self) -> [&Buffer; 5] {
        [
            &self.span_counts,
            &self.row_begins,
            &self.span_splats,
            &self.span_columns,
            &self.column_counts,
        ]
    }
}

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (b, t) = (frame.buffers, frame.tiles());
    let scratch = t.scratch.spans();
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
        scratch => [span_counts];
        order, mask_origins, masks_above, masks_below,
    });
    frame.dispatch(recorder, buffers, (), runs);
    let buffers = buffers!(span_scan {
        b => [frame, counts],
        scratch => [span_counts, row_begins],
    });
    frame.dispatch(recorder, buffers, (), Groups::Count(1));
    let buffers = buffers!(span_scatter {
        b => [frame, counts, splats],
        scratch => [span_counts, span_splats, span_columns];
        order, mask_origins, masks_above, masks_below,
    });
    frame.dispatch(recorder, buffers, (), runs_with_room);
    let buffers = buffers!(tile_count {
        b => [frame],
        scratch => [row_begins, column_counts, span_columns],
    });
    frame.dispatch(recorder, buffers, (), parts);
    let buffers = buffers!(tile_scan {
        b => [frame],
        scratch => [row_begins, column_counts];
        tile_begins: &t.picture.begins,
    });
    frame.dispatch(recorder, buffers, (), rows);
    let buffers = buffers!(tile_scatter {
        b => [frame, counts],
        scratch => [row_begins, column_counts, span_splats, span_columns];
        tile_splats: &t.splats,
    });
    frame.dispatch(recorder, buffers, (), parts);
}
