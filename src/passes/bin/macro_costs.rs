//! The costs of the passes that bin at two scales, declared as `cost.rs` says.

use super::macro_tiles::CHUNKS;
use crate::limits;
use crate::passes::cost::{self, Cost, FrameNumbers};
use crate::passes::radix;
use crate::passes::shaders::{
    batch_count, batch_scan, batch_scatter, macro_count, macro_expand, macro_ranges, macro_scan,
    row_scan,
};

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
fn batch_counts(numbers: &FrameNumbers) -> u64 {
    numbers.batches() * u64::from(limits::MACRO_TILES) * cost::WORD
}

/// Bytes of the masks of the pairs that need one, which neighbours in a list do not share, and of the batches' counts.
fn batch_bytes(numbers: &FrameNumbers) -> u64 {
    let masks = numbers.masked_pairs * cost::gathered(cost::TILE_MASK);
    masks + batch_counts(numbers)
}

/// Bytes of the sums of the rows of tiles of macro-tiles.
fn row_sums(numbers: &FrameNumbers) -> u64 {
    let columns = numbers.tile_columns.div_ceil(limits::MACRO_COLUMNS.into());
    numbers.tile_rows * columns * 4 * cost::WORD
}

/// Batches whose counts an invocation waits for together, as in glsl/batch_scan.comp.
const BATCHES_AT_ONCE: u64 = 8;

/// The rounds in which a partition of the pairs finds its splats, 2048 in each, from the beginning of a chunk on; as many
/// splats as there are where all have as many pairs.
fn expand_rounds(numbers: &FrameNumbers) -> u64 {
    let pairs = numbers.macro_pairs.max(1);
    let splats = u64::from(limits::RADIX_PARTITION) * numbers.survivors / pairs;
    (splats + u64::from(limits::RADIX_GROUP_SIZE)).div_ceil(2048)
}

/// The steps of the search for a macro-tile's first pair.
fn range_steps(numbers: &FrameNumbers) -> u64 {
    let bits = u64::from(numbers.macro_pairs.max(1).ilog2()) + 1;
    bits.div_ceil(limits::MACRO_RANGE_GROUP_SIZE.ilog2().into())
}

/// The turns of the loop over an invocation's splats of a batch.
fn batch_turns(_: &FrameNumbers) -> f64 {
    f64::from(limits::BATCH_SPLATS / limits::RADIX_GROUP_SIZE) / 8.0
}

/// Pairs of an invocation.
const OWN: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

fn partitions_of_splats(numbers: &FrameNumbers) -> u64 {
    numbers.partitions() * u64::from(limits::RADIX_GROUP_SIZE)
}

fn partitions_of_pairs(numbers: &FrameNumbers) -> u64 {
    numbers.pair_partitions() * u64::from(limits::RADIX_GROUP_SIZE)
}

fn batches(numbers: &FrameNumbers) -> u64 {
    numbers.batches() * u64::from(limits::RADIX_GROUP_SIZE)
}

/// The loads that find a batch and the tiles of its splats.
fn batch(numbers: &FrameNumbers) -> u64 {
    let search = u64::from(numbers.macro_tiles().next_power_of_two().ilog2());
    search + 1 + 3 * BATCH_TURNS
}

/// Splats of a batch for each invocation.
const BATCH_TURNS: u64 = (limits::BATCH_SPLATS / limits::RADIX_GROUP_SIZE) as u64;
