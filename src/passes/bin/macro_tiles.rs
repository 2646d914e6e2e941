//! Bins at two scales: finds the macro-tiles of each splat, sorts these pairs by macro-tile with the radix sort for GPUs, and
//! lists each tile's splats in batches of a macro-tile's. Pairs are written by whoever owns the place that they go to, so that
//! a splat over the whole picture costs its tiles and nobody waits for it.

use crate::error::Result;
use crate::gpu::{Buffer, Device, Groups, Recorder};
use crate::limits;
use crate::passes::bin::ScratchWords;
use crate::passes::buffers::{buffers, gpu_only, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost, FrameNumbers};
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
        need(key::<macro_ranges::Program>(plan));
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

pub(super) fn words(plan: &Plan) -> ScratchWords {
    let tiles = &plan.data.tiles;
    let [columns, rows] = macro_tiles(tiles).map(u64::from);
    let tile_rows = u64::from(tiles.tile_count / tiles.tile_columns);
    let pairs = u64::from(plan.data.room.pair_capacity);
    let batches = pairs.div_ceil(limits::BATCH_SPLATS.into()) + columns * rows;
    [
        u64::from(plan.gaussians()).div_ceil(limits::RADIX_PARTITION.into()),
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
    pub(super) fn new(device: &Device, words: ScratchWords) -> Result<Self> {
        let [
            sums,
            keys,
            splats,
            sorted,
            histogram,
            begins,
            counts,
            rows,
            list,
        ] = words;
        let gpu = |name, words| gpu_only(device, name, words * 4);
        Ok(Self {
            pair_sums: gpu("pair_sums", sums)?,
            macro_keys: gpu("macro_keys", keys)?,
            macro_splats: [
                gpu("macro_splats", splats)?,
                gpu("sorted_macro_splats", sorted)?,
            ],
            macro_histogram: gpu("macro_histogram", histogram)?,
            macro_begins: gpu("macro_begins", begins)?,
            tile_counts: gpu("tile_counts", counts)?,
            row_sums: gpu("row_sums", rows)?,
            tile_list: gpu("tile_list", list)?,
        })
    }

    pub(super) fn tile_list(&self) -> &Buffer {
        &self.tile_list
    }

    #[cfg(feature = "lab")]
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

#[cfg(feature = "lab")]
pub(in crate::passes) const COSTS: &[Cost] = &[
    // How many splats there are; then each of its own and its mask. It writes how many pairs each splat has, and its rectangle of
    // tiles.
    Cost::of::<macro_count::Program>(
        partitions_of_splats,
        |_| 1 + 2 * OWN,
        |n| n.survivors * (cost::WORD + cost::gathered(cost::TILE_MASK) + 3 * cost::WORD),
    )
    .turning(|_| OWN as f64 / 8.0),
    // The sums of all partitions; then its own counts, which it reads and writes.
    Cost::of::<macro_scan::Program>(
        partitions_of_splats,
        |n| 2 + n.partitions().div_ceil(limits::RADIX_GROUP_SIZE.into()),
        |n| (n.partitions() + 2 * n.survivors) * cost::WORD,
    ),
    // How many pairs there are; the search among all splats, for both ends together; where the pairs of those in between begin;
    // then what is known of the splat of each of its own pairs. It writes the pairs, and counts them for their sort.
    Cost::of::<macro_expand::Program>(
        partitions_of_pairs,
        |n| 1 + u64::from(n.survivors.next_power_of_two().ilog2()) + OWN + 1,
        |n| (n.survivors * 4 + n.macro_pairs * 2) * cost::WORD + n.pair_histogram(),
    ),
    // These are as in the sort of the survivors.
    Cost::named(
        radix::PAIR_COUNT,
        partitions_of_pairs,
        |_| 1 + OWN,
        |n| n.macro_pairs * cost::WORD + n.pair_histogram(),
    )
    .turning(|_| OWN as f64 / 8.0),
    Cost::named(
        radix::PAIR_SCAN,
        |_| (1 << limits::SORT_BITS) * u64::from(limits::RADIX_GROUP_SIZE),
        |n| {
            1 + n
                .pair_partitions()
                .div_ceil(limits::RADIX_GROUP_SIZE.into())
        },
        |n| 2 * n.pair_histogram(),
    )
    .turning(|n| {
        n.pair_partitions()
            .div_ceil(limits::RADIX_GROUP_SIZE.into()) as f64
            / 8.0
    }),
    Cost::named(
        radix::PAIR_SCATTER,
        partitions_of_pairs,
        |_| 4 + OWN,
        |n| n.macro_pairs * 4 * cost::WORD + n.pair_histogram(),
    ),
    // How many pairs there are; then its own. It writes where each macro-tile's begin.
    Cost::of::<macro_ranges::Program>(
        partitions_of_pairs,
        |_| 1 + OWN,
        |n| (n.macro_pairs + n.macro_tiles()) * cost::WORD,
    )
    .turning(|_| OWN as f64 / 8.0),
    // How many batches there are; the search for its own; then each of its splats, the mask and perhaps the splat, and once
    // more the splat and its record. It writes how many splats of the batch each tile has. The bytes are those of one surface.
    Cost::of::<batch_count::Program>(batches, |n| 1 + batch(n) + 2 * BATCH_TURNS, batch_bytes)
        .turning(batch_turns),
    // The macro-tile's pairs; then the counts of its batches, which it reads and writes. It writes the sums of tiles and rows.
    Cost::of::<batch_scan::Program>(
        |n| n.macro_tiles() * u64::from(limits::MACRO_TILES),
        |n| 2 + n.batches().div_ceil(n.macro_tiles()),
        |n| 2 * batch_counts(n) + n.tiles() * cost::WORD + row_sums(n),
    )
    .turning(|n| n.batches() as f64 / n.macro_tiles().max(1) as f64 / 8.0),
    // The sums of all rows; then the counts of its row's tiles, in place of which it writes where they begin.
    Cost::of::<row_scan::Program>(
        |n| n.tile_rows * u64::from(limits::RADIX_GROUP_SIZE),
        |n| {
            let columns = n.tile_columns.div_ceil(limits::MACRO_COLUMNS.into());
            let turns = |words: u64| words.div_ceil(limits::RADIX_GROUP_SIZE.into());
            2 + turns(n.tile_rows * columns) + turns(n.tile_columns)
        },
        |n| row_sums(n) + (2 * n.tiles() + n.filled()) * cost::WORD,
    ),
    // As batch_count, but that it reads the counts; then where the tile begins. It writes the tiles' lists.
    Cost::of::<batch_scatter::Program>(
        batches,
        |n| 2 + batch(n),
        |n| batch_bytes(n) + (n.tiles() + n.pairs) * cost::WORD,
    )
    .turning(batch_turns),
];

/// Bytes of the counts of all batches, a tile of a macro-tile each.
#[cfg(feature = "lab")]
fn batch_counts(numbers: &FrameNumbers) -> u64 {
    numbers.batches() * u64::from(limits::MACRO_TILES) * cost::WORD
}

/// A pair's key holds a macro-tile's number, column, row, columns and rows of a rectangle in it, and a mark.
const _: () = assert!(
    limits::PAIR_BITS + 2 * (limits::MACRO_COLUMNS * limits::MACRO_ROWS).ilog2() + 1 == u32::BITS
);

/// Bytes of the pairs of all batches, of the masks of those that need one, which neighbours in a list do not share, and of the
/// counts.
#[cfg(feature = "lab")]
fn batch_bytes(numbers: &FrameNumbers) -> u64 {
    let masks = numbers.masked_pairs * cost::gathered(cost::TILE_MASK);
    numbers.macro_pairs * 2 * cost::WORD + masks + batch_counts(numbers)
}

/// Bytes of the sums of the rows of tiles of macro-tiles.
#[cfg(feature = "lab")]
fn row_sums(numbers: &FrameNumbers) -> u64 {
    let columns = numbers.tile_columns.div_ceil(limits::MACRO_COLUMNS.into());
    numbers.tile_rows * columns * 4 * cost::WORD
}

/// The turns of the loop over an invocation's splats of a batch.
#[cfg(feature = "lab")]
fn batch_turns(_: &FrameNumbers) -> f64 {
    f64::from(limits::BATCH_SPLATS / limits::RADIX_GROUP_SIZE) / 8.0
}

/// Pairs of an invocation.
#[cfg(feature = "lab")]
const OWN: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

#[cfg(feature = "lab")]
fn partitions_of_splats(numbers: &FrameNumbers) -> u64 {
    numbers.partitions() * u64::from(limits::RADIX_GROUP_SIZE)
}

#[cfg(feature = "lab")]
fn partitions_of_pairs(numbers: &FrameNumbers) -> u64 {
    numbers.pair_partitions() * u64::from(limits::RADIX_GROUP_SIZE)
}

#[cfg(feature = "lab")]
fn batches(numbers: &FrameNumbers) -> u64 {
    numbers.batches() * u64::from(limits::RADIX_GROUP_SIZE)
}

/// The loads that find a batch and the tiles of its splats.
#[cfg(feature = "lab")]
fn batch(numbers: &FrameNumbers) -> u64 {
    let search = u64::from(numbers.macro_tiles().next_power_of_two().ilog2());
    search + 1 + 3 * BATCH_TURNS
}

/// Splats of a batch for each invocation.
#[cfg(feature = "lab")]
const BATCH_TURNS: u64 = (limits::BATCH_SPLATS / limits::RADIX_GROUP_SIZE) as u64;

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (b, t) = (frame.buffers, frame.tiles());
    let scratch = t.scratch.macro_tiles();
    let sort::Sorted {
        order,
        spare: [pair_begins, rect_firsts, rect_sizes],
    } = sort::sorted(frame);
    let partitions = indirect!(b.counts, FrameCounts, sort_groups);
    let buffers = buffers!(macro_count {
        b => [frame, counts, tile_masks],
        scratch => [pair_sums];
        order, pair_begins, rect_firsts, rect_sizes,
    });
    frame.dispatch(recorder, buffers, (), partitions);
    let buffers = buffers!(macro_scan {
        b => [frame, counts],
        scratch => [pair_sums];
        pair_begins,
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
        b => [frame, counts];
        order, pair_begins, rect_firsts, rect_sizes,
        macro_keys: keys[0],
        macro_splats: splats[0],
        histogram: &scratch.macro_histogram,
    });
    frame.dispatch(recorder, buffers, (), pair_partitions);
    let kernels = Kernels::new(frame.plan, Keys::Pairs);
    for number in 0..passes {
        let pair = [number, number + 1].map(|pair| (pair % 2) as usize);
        let pass = Pass {
            number,
            passes,
            keys: pair.map(|pair| keys[pair]),
            order: pair.map(|pair| splats[pair]),
            first_keys: keys[0],
            histogram: &scratch.macro_histogram,
        };
        if number > 0 {
            pass.count(&kernels, frame, recorder, pair_partitions);
        }
        pass.carry(&kernels, frame, recorder, pair_partitions);
    }
    let sorted = (passes % 2) as usize;
    let buffers = buffers!(macro_ranges {
        b => [frame, counts],
        scratch => [macro_begins];
        macro_keys: &scratch.macro_keys,
    });
    frame.dispatch(recorder, buffers, (), pair_partitions);

    let batches = indirect!(b.counts, FrameCounts, batch_groups);
    let buffers = buffers!(batch_count {
        b => [frame, counts, splats, tile_masks, cut_records],
        scratch => [macro_begins, macro_keys, tile_counts];
        macro_splats: splats[sorted],
    });
    frame.dispatch(recorder, buffers, (), batches);
    let [columns, rows] = macro_tiles(&frame.plan.data.tiles);
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
