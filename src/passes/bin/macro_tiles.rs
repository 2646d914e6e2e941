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
    // How many splats there are; then its own and their rectangles. It writes these in the order of depth, and how many pairs
    // the chunks have.
    Cost::of::<macro_count::Program>(
        partitions_of_splats,
        |_| 3,
        |n| {
            let splat = 2 * cost::WORD + cost::gathered(cost::WORD);
            n.survivors * splat + n.partitions() * (1 + CHUNKS) * cost::WORD
        },
    ),
    // The sums of all partitions; then those of its own chunks, of which it writes where they begin.
    Cost::of::<macro_scan::Program>(
        partitions_of_splats,
        |n| 2 + n.partitions().div_ceil(limits::RADIX_GROUP_SIZE.into()),
        |n| n.partitions() * (1 + 2 * CHUNKS) * cost::WORD,
    ),
    // How many pairs there are; the search among all chunks, and where the first begins; then, in each round, the splats'
    // rectangles and their numbers. It writes the pairs, and counts them for their sort.
    Cost::of::<macro_expand::Program>(
        partitions_of_pairs,
        |n| {
            let chunks = n.partitions() * CHUNKS;
            2 + u64::from(chunks.next_power_of_two().ilog2()) + 2 * expand_rounds(n)
        },
        |n| (n.survivors * 2 + n.macro_pairs * 2) * cost::WORD + n.pair_histogram(),
    )
    .turning(|n| expand_rounds(n) as f64 / 8.0),
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
        |n| 1 + radix::scan_turns(n.pair_partitions()),
        |n| 2 * n.pair_histogram(),
    )
    .turning(|n| radix::scan_turns(n.pair_partitions()) as f64 / 8.0),
    Cost::named(
        radix::PAIR_SCATTER,
        partitions_of_pairs,
        |_| 4 + OWN,
        |n| n.macro_pairs * 4 * cost::WORD + n.pair_histogram(),
    ),
    // How many pairs there are; the steps of the search, of which each invocation reads a pair of its own. It writes where each
    // macro-tile's begin.
    Cost::of::<macro_ranges::Program>(
        |n| (n.macro_tiles() + 1) * u64::from(limits::MACRO_RANGE_GROUP_SIZE),
        |n| 1 + range_steps(n),
        |n| {
            let step = u64::from(limits::MACRO_RANGE_GROUP_SIZE) * cost::gathered(cost::WORD);
            (n.macro_tiles() + 1) * (range_steps(n) * step + cost::WORD)
        },
    )
    .turning(|n| range_steps(n) as f64 / 8.0),
    // How many batches there are; the search for its own; then each of its pairs, perhaps its splat, the mask and the outline,
    // and once more the splat and its record. It writes how many splats of the batch each tile has. The bytes are those of one
    // surface, for which it reads the splats' numbers only where it needs their masks.
    Cost::of::<batch_count::Program>(
        batches,
        |n| 1 + batch(n) + 2 * BATCH_TURNS,
        |n| {
            let splats =
                (n.masked_pairs * cost::gathered(cost::WORD)).min(n.macro_pairs * cost::WORD);
            n.macro_pairs * cost::WORD + splats + batch_bytes(n)
        },
    )
    .turning(batch_turns),
    // The macro-tile's pairs; then the counts of its batches, which it reads, several at once, and writes. It writes the sums of
    // tiles and rows.
    Cost::of::<batch_scan::Program>(
        |n| n.macro_tiles() * u64::from(limits::MACRO_TILES),
        |n| {
            2 + n
                .batches()
                .div_ceil(n.macro_tiles())
                .div_ceil(BATCHES_AT_ONCE)
        },
        |n| 2 * batch_counts(n) + n.tiles() * cost::WORD + row_sums(n),
    )
    .turning(|n| n.batches() as f64 / n.macro_tiles().max(1) as f64 / (8 * BATCHES_AT_ONCE) as f64),
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
        |n| (n.macro_pairs * 2 + n.tiles() + n.pairs) * cost::WORD + batch_bytes(n),
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

/// Bytes of the masks of the pairs that need one, which neighbours in a list do not share, and of the batches' counts.
#[cfg(feature = "lab")]
fn batch_bytes(numbers: &FrameNumbers) -> u64 {
    let masks = numbers.masked_pairs * cost::gathered(cost::TILE_MASK);
    masks + batch_counts(numbers)
}

/// Bytes of the sums of the rows of tiles of macro-tiles.
#[cfg(feature = "lab")]
fn row_sums(numbers: &FrameNumbers) -> u64 {
    let columns = numbers.tile_columns.div_ceil(limits::MACRO_COLUMNS.into());
    numbers.tile_rows * columns * 4 * cost::WORD
}

/// Chunks of splats in a partition, as in glsl/macro_tiles.glsl.
const CHUNKS: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

/// Batches whose counts an invocation waits for together, as in glsl/batch_scan.comp.
#[cfg(feature = "lab")]
const BATCHES_AT_ONCE: u64 = 8;

/// The rounds in which a partition of the pairs finds its splats, 2048 in each, from the beginning of a chunk on; as many
/// splats as there are where all have as many pairs.
#[cfg(feature = "lab")]
fn expand_rounds(numbers: &FrameNumbers) -> u64 {
    let pairs = numbers.macro_pairs.max(1);
    let splats = u64::from(limits::RADIX_PARTITION) * numbers.survivors / pairs;
    (splats + u64::from(limits::RADIX_GROUP_SIZE)).div_ceil(2048)
}

/// The steps of the search for a macro-tile's first pair.
#[cfg(feature = "lab")]
fn range_steps(numbers: &FrameNumbers) -> u64 {
    let bits = u64::from(numbers.macro_pairs.max(1).ilog2()) + 1;
    bits.div_ceil(limits::MACRO_RANGE_GROUP_SIZE.ilog2().into())
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
    let [columns, rows] = macro_tiles(&frame.plan.data.tiles);
    // And for where all end.
    frame.dispatch(recorder, buffers, (), Groups::Count(columns * rows + 1));

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
