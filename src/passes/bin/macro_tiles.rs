//! Bins at two scales: finds the macro-tiles of each splat, sorts these pairs by macro-tile with the radix sort for GPUs, and
//! lists each tile's splats in batches of a macro-tile's. Pairs are written by whoever owns the place that they go to, so that
//! a splat over the whole picture costs its tiles and nobody waits for it.

use crate::error::Result;
use crate::gpu::{Buffer, Groups, Recorder};
use crate::limits;
use crate::passes::bin::ScratchWords;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::pipelines::OfPlan;
use crate::passes::plan::Plan;
use crate::passes::radix::{self, Kernels, Keys, Pass};
use crate::passes::shaders::{
    batch_count, batch_scan, batch_scatter, macro_count, macro_expand, macro_ranges, macro_scan,
    row_scan,
};
use crate::passes::stage::{Frame, KernelSet, key};
use crate::passes::{sort, tiles};
use crate::types::{FrameCounts, TilesData};

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |plan, need| {
        need(key::<macro_count::Program>(plan));
        need(key::<macro_scan::Program>(plan));
        need(key::<macro_expand::Program>(plan));
        Kernels::new(plan, Keys::Pairs).need(need);
        if passes(plan) > 1 {
            need(key::<macro_ranges::Program>(plan));
        }
        need(key::<batch_count::Program>(plan));
        need(key::<batch_scan::Program>(plan));
        need(key::<row_scan::Program>(plan));
        need(key::<batch_scatter::Program>(plan));
    },
    record,
};

/// The pairs of macro-tile and splat, and what is counted of them. The tiles' lists are the other half of the sort's keys,
/// which nobody needs any more when the lists are written.
#[derive(Debug)]
pub(in crate::passes) struct Scratch {
    pair_sums: Buffer,
    macro_keys: Buffer,
    macro_splats: [Buffer; 2],
    macro_histogram: Buffer,
    macro_begins: Buffer,
    tile_counts: Buffer,
    row_sums: Buffer,
    tile_list: Buffer,
}

impl OfPlan for batch_count::Constants {
    fn of(plan: &Plan) -> Self {
        Self {
            several: tiles::has_several_kinds(plan),
        }
    }
}

/// Columns and rows of macro-tiles.
fn macro_tiles(tiles: &TilesData) -> [u32; 2] {
    let rows = tiles.tile_count / tiles.tile_columns;
    [
        tiles.tile_columns.div_ceil(limits::MACRO_COLUMNS),
        rows.div_ceil(limits::MACRO_ROWS),
    ]
}

/// Passes of the sort by macro-tile: one for pictures of 1920x1080.
fn passes(plan: &Plan) -> u32 {
    let [columns, rows] = macro_tiles(&plan.data.tiles);
    let last = columns * rows - 1;
    (u32::BITS - last.leading_zeros())
        .div_ceil(limits::SORT_BITS)
        .max(1)
}

/// The buffers' names, in the order of their words.
pub(super) const NAMES: [&str; 9] = [
    "pair_sums",
    "macro_keys",
    "macro_splats",
    "sorted_macro_splats",
    "macro_histogram",
    "macro_begins",
    "tile_counts",
    "row_sums",
    "tile_list",
];

pub(super) fn words(plan: &Plan) -> ScratchWords {
    let tiles = &plan.data.tiles;
    let [columns, rows] = macro_tiles(tiles).map(u64::from);
    let tile_rows = u64::from(tiles.tile_count / tiles.tile_columns);
    let pairs = u64::from(plan.data.room.pair_capacity);
    let batches = pairs.div_ceil(limits::BATCH_SPLATS.into()) + columns * rows;
    let partitions = u64::from(plan.gaussians()).div_ceil(limits::RADIX_PARTITION.into());
    [
        partitions * (1 + CHUNKS),
        pairs,
        pairs,
        pairs,
        radix::histogram_words(pairs),
        columns * rows + 1,
        batches * u64::from(limits::MACRO_TILES),
        columns * tile_rows * 4,
        u64::from(tiles.tile_count) + 2, // and how many there are of each kind
    ]
}

impl Scratch {
    pub(super) fn new(gpu: &mut dyn FnMut(&'static str) -> Result<Buffer>) -> Result<Self> {
        Ok(Self {
            pair_sums: gpu("pair_sums")?,
            macro_keys: gpu("macro_keys")?,
            macro_splats: [gpu("macro_splats")?, gpu("sorted_macro_splats")?],
            macro_histogram: gpu("macro_histogram")?,
            macro_begins: gpu("macro_begins")?,
            tile_counts: gpu("tile_counts")?,
            row_sums: gpu("row_sums")?,
            tile_list: gpu("tile_list")?,
        })
    }

    pub(super) fn tile_list(&self) -> &Buffer {
        &self.tile_list
    }

    pub(super) fn all(&self) -> [&Buffer; 9] {
        [
            &self.pair_sums,
            &self.macro_keys,
            &self.macro_splats[0],
            &self.macro_splats[1],
            &self.macro_histogram,
            &self.macro_begins,
            &self.tile_counts,
            &self.row_sums,
            &self.tile_list,
        ]
    }
}

/// A pair's key holds a macro-tile's number, column, row, columns and rows of a rectangle in it, and a mark.
const _: () = assert!(
    limits::PAIR_BITS + 2 * (limits::MACRO_COLUMNS * limits::MACRO_ROWS).ilog2() + 1 == u32::BITS
);

/// Chunks of splats in a partition, as in glsl/macro_tiles.glsl.
const CHUNKS: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (b, t) = (frame.buffers, frame.tiles());
    let scratch = t.scratch.macro_tiles();
    let sort::Sorted {
        order,
        spare: [rects, chunk_begins, _],
    } = sort::sorted(frame);
    let partitions = indirect!(b.counts, FrameCounts, sort_groups);
    let buffers = buffers!(macro_count {
        b => [frame, counts, tile_masks],
        scratch => [pair_sums];
        order, rects,
    });
    frame.dispatch(recorder, buffers, (), partitions);
    let buffers = buffers!(macro_scan {
        b => [frame, counts],
        scratch => [pair_sums];
        chunk_begins,
    });
    frame.dispatch(recorder, buffers, (), partitions);

    // The last pass leaves them in their own buffer: the tiles' lists take the other one's place.
    let passes = passes(frame.plan);
    let mut keys = [&scratch.macro_keys, &t.splats];
    if passes % 2 == 1 {
        keys.reverse();
    }
    let splats = [&scratch.macro_splats[0], &scratch.macro_splats[1]];
    let pair_partitions = indirect!(b.counts, FrameCounts, pair_groups);
    let buffers = buffers!(macro_expand {
        b => [frame, counts, tile_masks];
        order, rects, chunk_begins,
        macro_keys: keys[0],
        macro_splats: splats[0],
        histogram: &scratch.macro_histogram,
    });
    frame.dispatch(recorder, buffers, (), pair_partitions);
    let kernels = Kernels::new(frame.plan, Keys::Pairs);
    let [columns, rows] = macro_tiles(&frame.plan.data.tiles);
    for number in 0..passes {
        let pair = [number, number + 1].map(|pair| (pair % 2) as usize);
        let pass = Pass {
            number,
            passes,
            keys: pair.map(|pair| keys[pair]),
            order: pair.map(|pair| splats[pair]),
            first_keys: keys[0],
            histogram: &scratch.macro_histogram,
            macro_begins: (passes == 1).then_some((&scratch.macro_begins, columns * rows)),
        };
        if number > 0 {
            pass.count(&kernels, frame, recorder, pair_partitions);
        }
        pass.carry(&kernels, frame, recorder, pair_partitions);
    }
    let sorted = (passes % 2) as usize;
    if passes > 1 {
        let buffers = buffers!(macro_ranges {
            b => [frame, counts],
            scratch => [macro_begins];
            macro_keys: &scratch.macro_keys,
        });
        // And for where all end.
        frame.dispatch(recorder, buffers, (), Groups::Count(columns * rows + 1));
    }

    let batches = indirect!(b.counts, FrameCounts, batch_groups);
    let buffers = buffers!(batch_count {
        b => [frame, counts, splats, tile_masks, cut_records],
        scratch => [macro_begins, macro_keys, tile_counts];
        macro_splats: splats[sorted],
    });
    frame.dispatch(recorder, buffers, (), batches);
    let buffers = buffers!(batch_scan {
        b => [frame, counts],
        scratch => [macro_begins, tile_counts, row_sums];
        tile_begins: &t.picture.begins,
    });
    frame.dispatch(recorder, buffers, (), Groups::Count(columns * rows));
    let buffers = buffers!(row_scan {
        b => [frame, counts],
        scratch => [row_sums, tile_list];
        tile_begins: &t.picture.begins,
    });
    let tiles = &frame.plan.data.tiles;
    let rows = Groups::Count(tiles.tile_count / tiles.tile_columns);
    frame.dispatch(recorder, buffers, (), rows);
    let buffers = buffers!(batch_scatter {
        b => [frame, counts, splats, tile_masks],
        scratch => [macro_begins, macro_keys, tile_counts];
        macro_splats: splats[sorted],
        tile_begins: &t.picture.begins,
        tile_splats: &t.splats,
    });
    frame.dispatch(recorder, buffers, (), batches);
}
