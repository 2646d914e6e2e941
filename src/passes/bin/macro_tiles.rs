//! Bins at two scales: finds the macro-tiles of each splat, sorts these pairs by macro-tile with the radix sort for GPUs, and
//! lists each tile's splats in batches of a macro-tile's. Pairs are written by whoever owns the place that they go to, so that
//! a splat over the whole picture costs its tiles and nobody waits for it.

use crate::passes::bin::lists::{self, pairs};
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::FromPlan;
use crate::passes::radix::{self, Keys, Pass, RadixPipelines};
use crate::passes::recording::{Groups, Recording, counted};
use crate::passes::shaders::{
    batch_count, batch_scan, batch_scatter, macro_count, macro_expand, macro_ranges, macro_scan,
    row_scan,
};
use crate::passes::storage::{buffers, memory};
use crate::passes::weight::Weight;
use crate::passes::{cutoff, project, shared, sort, tiles};
use crate::types::TilesData;
use rara_base::limits;

memory! { EyePlan:
    /// The pairs of each partition of splats, and of its chunks.
    pair_sums: |plan| {
        let partitions = plan.gaussians().div_ceil(limits::RADIX_PARTITION.into());
        scratch(plan, partitions * (1 + CHUNKS))
    };
    /// The pairs of macro-tile and splat. The tiles' lists are the other half of the sort's keys, which nobody needs any more
    /// when the lists are written.
    macro_keys: |plan| scratch(plan, pairs(plan));
    macro_splats: |plan| scratch(plan, pairs(plan));
    sorted_macro_splats: |plan| scratch(plan, pairs(plan));
    macro_histogram: |plan| scratch(plan, radix::histogram_words(pairs(plan)));
    macro_begins: |plan| scratch(plan, count(plan) + 1);
    /// Of each batch the splats in each tile of its macro-tile.
    tile_counts: |plan| {
        let batches = pairs(plan).div_ceil(limits::BATCH_SPLATS.into()) + count(plan);
        scratch(plan, batches * u64::from(limits::MACRO_TILES))
    };
    row_sums: |plan| {
        let tiles = &plan.data.tiles;
        let [columns, _] = macro_tiles(tiles);
        scratch(plan, 4 * u64::from(columns * (tiles.tile_count / tiles.tile_columns)))
    };
    /// The tiles that hold splats, and how many there are of each kind.
    tile_list: |plan| scratch(plan, u64::from(plan.data.tiles.tile_count) + 2);
}

/// Bytes of so many words where these pipelines run.
fn scratch(plan: &EyePlan, words: u64) -> u64 {
    lists::scratch(plan, false, words)
}

/// Macro-tiles of the picture.
fn count(plan: &EyePlan) -> u64 {
    macro_tiles(&plan.data.tiles)
        .map(u64::from)
        .iter()
        .product()
}

impl FromPlan<EyePlan> for batch_count::Constants {
    fn from_plan(plan: &EyePlan) -> Self {
        Self {
            several: Weight::from_plan(plan).has_several_kinds(),
        }
    }
}

impl FromPlan<EyePlan> for row_scan::Constants {
    fn from_plan(plan: &EyePlan) -> Self {
        Self {
            several: tiles::has_two_lists(plan),
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
fn passes(plan: &EyePlan) -> u32 {
    let [columns, rows] = macro_tiles(&plan.data.tiles);
    let last = columns * rows - 1;
    (u32::BITS - last.leading_zeros())
        .div_ceil(limits::SORT_BITS)
        .max(1)
}

/// A pair's key holds a macro-tile's number, column, row, columns and rows of a rectangle in it, and a mark.
const _: () = assert!(
    limits::PAIR_BITS + 2 * (limits::MACRO_COLUMNS * limits::MACRO_ROWS).ilog2() + 1 == u32::BITS
);

/// Chunks of splats in a partition, as in glsl/macro_tiles.glsl.
const CHUNKS: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

pub(super) fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let plan = recording.plan;
    let order = sort::order(plan);
    let [rects, chunk_begins, _] = sort::spare(plan);
    let partitions = counted!(sort_groups);
    let buffers = buffers!(macro_count {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [tile_masks],
        MEMORY => [pair_sums];
        order, rects,
    });
    recording.dispatch(buffers, (), partitions);
    let buffers = buffers!(macro_scan {
        shared::MEMORY => [frame, counts],
        MEMORY => [pair_sums];
        chunk_begins,
    });
    recording.dispatch(buffers, (), partitions);

    // The last pass leaves them in their own buffer: the tiles' lists take the other one's place.
    let passes = passes(plan);
    let mut keys = [&MEMORY.macro_keys, &lists::MEMORY.tile_splats];
    if passes % 2 == 1 {
        keys.reverse();
    }
    let splats = [&MEMORY.macro_splats, &MEMORY.sorted_macro_splats];
    let pair_partitions = counted!(pair_groups);
    let buffers = buffers!(macro_expand {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [tile_masks];
        order, rects, chunk_begins,
        macro_keys: keys[0],
        macro_splats: splats[0],
        histogram: &MEMORY.macro_histogram,
    });
    recording.dispatch(buffers, (), pair_partitions);
    let pipelines = RadixPipelines::new(plan, Keys::Pairs);
    let [columns, rows] = macro_tiles(&plan.data.tiles);
    for number in 0..passes {
        let pair = [number, number + 1].map(|pair| (pair % 2) as usize);
        let pass = Pass {
            number,
            passes,
            keys: pair.map(|pair| keys[pair]),
            order: pair.map(|pair| splats[pair]),
            first_keys: keys[0],
            histogram: &MEMORY.macro_histogram,
            macro_begins: (passes == 1).then_some((&MEMORY.macro_begins, columns * rows)),
        };
        if number > 0 {
            pass.count(&pipelines, recording, pair_partitions);
        }
        pass.carry(&pipelines, recording, pair_partitions);
    }
    let sorted = (passes % 2) as usize;
    if passes > 1 {
        let buffers = buffers!(macro_ranges {
            shared::MEMORY => [frame, counts],
            MEMORY => [macro_begins];
            macro_keys: &MEMORY.macro_keys,
        });
        // And for where all end.
        recording.dispatch(buffers, (), Groups::Count(columns * rows + 1));
    }

    let batches = counted!(batch_groups);
    let buffers = buffers!(batch_count {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [splats, tile_masks],
        cutoff::MEMORY => [cut_records],
        MEMORY => [macro_begins, macro_keys, tile_counts];
        macro_splats: splats[sorted],
    });
    recording.dispatch(buffers, (), batches);
    let buffers = buffers!(batch_scan {
        shared::MEMORY => [frame, counts],
        MEMORY => [macro_begins, tile_counts, row_sums];
        tile_begins: &lists::MEMORY.tile_begins,
    });
    recording.dispatch(buffers, (), Groups::Count(columns * rows));
    let buffers = buffers!(row_scan {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [tile_masks],
        lists::MEMORY => [tile_splats, tile_begins],
        MEMORY => [row_sums, tile_list];
        order,
    });
    let tiles = &plan.data.tiles;
    let rows = Groups::Count(tiles.tile_count / tiles.tile_columns);
    recording.dispatch(buffers, (), rows);
    let buffers = buffers!(batch_scatter {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [splats, tile_masks],
        MEMORY => [macro_begins, macro_keys, tile_counts];
        macro_splats: splats[sorted],
        tile_begins: &lists::MEMORY.tile_begins,
        tile_splats: &lists::MEMORY.tile_splats,
    });
    recording.dispatch(buffers, (), batches);
}
