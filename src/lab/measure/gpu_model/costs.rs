//! The work that each compute pass costs a GPU's frame, as functions of the frame's numbers: how many invocations the pass
//! has, how many loads one of them may have to wait for, one after the other, and how many bytes of device memory all of them
//! together read and write. `tests/gpu_cost` holds the table to the commands of real frames, and to ceilings.
//!
//! A load is a trip to device memory, not to a workgroup's shared memory. Loads that do not wait for each other count as one:
//! those of a struct, and those of loops of a fixed length, which compilers unroll. In a loop whose length follows from data
//! each turn counts, since compilers do not overlap them. The frame's constants are one load.
//!
//! Bytes are those that a pass moves if caches keep everything while one workgroup, or neighbouring ones, use it, and nothing
//! from one pass to the next. So what neighbours share counts once, what many workgroups read over and over (a sum of all
//! partitions, the frame's constants) counts once, and a single element that is read out of order counts as whole sectors of
//! memory (`gathered`). Elements that are written out of order in short runs count as they are, although their sectors' rests
//! may be moved too.

use rara::types;
use rara_base::limits;

use super::numbers::{FrameNumbers, WORD};

#[derive(Debug, Clone, Copy)]
pub struct Cost {
    pub name: &'static str,
    /// Its invocations, but for those that fill up the last workgroup.
    pub invocations: fn(&FrameNumbers) -> u64,
    /// The longest chain of loads of an invocation of which each waits for the one before.
    pub loads: fn(&FrameNumbers) -> u64,
    /// Bytes of device memory that all invocations together read and write.
    pub bytes: fn(&FrameNumbers) -> u64,
    /// The turns of its loops, as a multiple of those that a compiler takes for granted, which knows no data: Mesa's for AMD's
    /// GPUs takes a loop for 8 turns, and one inside it for 4.
    pub turns: fn(&FrameNumbers) -> f64,
}

impl Cost {
    /// The cost of a pass whose code has no loops that matter, or none but unrolled ones.
    const fn new(
        name: &'static str,
        invocations: fn(&FrameNumbers) -> u64,
        loads: fn(&FrameNumbers) -> u64,
        bytes: fn(&FrameNumbers) -> u64,
    ) -> Self {
        Self {
            name,
            invocations,
            loads,
            bytes,
            turns: |_| 1.0,
        }
    }

    const fn turning(self, turns: fn(&FrameNumbers) -> f64) -> Self {
        Self { turns, ..self }
    }
}

// Bytes of what passes read and write.
/// A Gaussian without its colour.
const GAUSSIAN: u64 = size_of::<types::Gaussian>() as u64;
const BOUNDS: u64 = size_of::<types::Block>() as u64;
/// A splat without its curvature and its depth, which lie apart.
const SPLAT: u64 = 12 * WORD;
/// The curvature of a splat's weight.
const CURVATURE: u64 = 4 * WORD;
/// A splat: its Gaussian; where the clip cuts any, its place among those that are cut is a word more.
const SPLAT_GAUSSIAN: u64 = WORD;
/// A splat's mask of tiles.
const TILE_MASK: u64 = 4 * WORD;
const BLOCK: u64 = limits::BLOCK_SIZE as u64 * GAUSSIAN;
/// The two masks of a block, a bit a Gaussian in each.
const MASKS: u64 = 2 * limits::BLOCK_SIZE as u64 / 8;
const TOTALS: u64 = 4 * WORD;
/// A change of a reclipped frame: the splat, and its place among those that are cut.
const CHANGE: u64 = 2 * WORD;
/// The words that a reclipped frame keeps of a block.
const KEPT: u64 = limits::RECLIP_WORDS as u64 * WORD;
/// A pixel of the tiles' picture.
const PIXEL: u64 = 4 * WORD;

/// The bytes that are moved for so many bytes that are read alone: whole sectors, the least piece of memory that caches of
/// NVIDIA and Intel read; those of AMD read more.
const fn gathered(bytes: u64) -> u64 {
    bytes.next_multiple_of(32)
}

// Invocations.
/// The invocations of a workgroup of the passes that sort and bin.
const GROUP: u64 = limits::RADIX_GROUP_SIZE as u64;
const GAUSSIANS: u64 = limits::BLOCK_SIZE as u64;
const TILE: u64 = (limits::TILE_WIDTH * limits::TILE_HEIGHT) as u64;

// Counts within a workgroup.
const DIGITS: u64 = 1 << limits::SORT_BITS;
const KEYS: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;
/// It waits for the loads of so many of them together, as in glsl/radix.glsl.
const KEYS_AT_ONCE: u64 = 4;
/// Chunks of splats in a partition, as in glsl/macro_tiles.glsl.
const CHUNKS: u64 = KEYS;
/// Splats of a batch for each invocation.
const BATCH_TURNS: u64 = (limits::BATCH_SPLATS / limits::RADIX_GROUP_SIZE) as u64;
/// Batches whose counts an invocation waits for together, as in glsl/batch_scan.comp.
const BATCHES_AT_ONCE: u64 = 8;

/// The costs of all passes of a GPU's frames.
pub static COSTS: [Cost; 33] = [
    // It reads the bounds, and writes their side.
    Cost::new(
        "clip_blocks",
        |n| n.blocks,
        |n| 1 + n.layer() + n.surfaces,
        |n| n.blocks * (BOUNDS + WORD),
    ),
    // The number of its group's block, the block, its layer, its Gaussian. It writes the masks.
    Cost::new(
        "clip",
        |n| n.clip_blocks * GAUSSIANS,
        |n| 2 + n.layer() + 1 + n.asked_surfaces(),
        |n| n.clip_blocks * (WORD + BLOCK + MASKS),
    ),
    Cost::new(
        "block_list",
        |n| n.blocks,
        |n| n.loads_of_list(1),
        // It reads the blocks' sides, and writes the list.
        |n| n.blocks * 2 * WORD,
    ),
    Cost::new(
        "blocks",
        |n| n.blocks,
        |n| 1 + n.layer() + n.asked_surfaces(),
        // It reads the bounds and their side of the clip, and writes their side.
        |n| n.blocks * (BOUNDS + 2 * WORD),
    ),
    // As clip; where the surfaces are not asked, two loads of what stage clip has found. It reads the Gaussians and, if there
    // is a clip, its side and its masks, and writes masks and totals.
    Cost::new(
        "classify",
        |n| n.view_blocks * GAUSSIANS,
        |n| 2 + n.layer() + 1 + n.asked_surfaces().max(2),
        |n| {
            let clip = n.surfaces.min(1) * (WORD + MASKS);
            n.view_blocks * (WORD + BLOCK + clip + MASKS + TOTALS)
        },
    ),
    // Each block has a side, totals and a layer. It writes the block's places, and the list.
    Cost::new(
        "compact_scan",
        |n| n.blocks,
        |n| n.loads_of_list(n.layer()),
        |n| n.blocks * (WORD + TOTALS + 2 * WORD + WORD),
    ),
    // The number of its group's block, the block, its layer, its side, its Gaussian's bits in the two masks; and the words of
    // each mask. It writes the splats, and the numbers of those that are cut.
    Cost::new(
        "compact",
        |n| n.kept_blocks * GAUSSIANS,
        |n| 2 + n.layer() + 3 + 2 * u64::from(limits::BLOCK_SIZE / u32::BITS),
        |n| {
            let block = 4 * WORD + MASKS;
            n.kept_blocks * block + n.splats * SPLAT_GAUSSIAN + n.cuts() + n.cut * WORD
        },
    ),
    // How many there are, its Gaussian's number, the layer; the Gaussian meanwhile. It writes the record.
    Cost::new(
        "cutoff",
        |n| n.cut,
        |n| 2 + n.layer() + n.asked_surfaces(),
        |n| n.cut * (WORD + gathered(GAUSSIAN) + n.record_bytes),
    ),
    // How many there are, its Gaussian's number, the layer; the Gaussian meanwhile. Then the cutoff record's header and the
    // rest of it, the colour's constant, its units and those of three degrees; the record once more for the tiles.
    // It reads the splat, the Gaussian, its colour and the record, and writes the splat, its depth, its rectangle of tiles and
    // its key, the curvatures of cut splats, and the masks of those that need one, which have a pair each at least; quads are left out, which frames of
    // tiles do without.
    Cost::new(
        "project",
        |n| n.splats,
        |n| 2 + n.layer() + 2 + 5 + 2,
        |n| {
            let read = SPLAT_GAUSSIAN + GAUSSIAN + n.sh_bytes;
            let written = SPLAT + 3 * WORD;
            let masks = n.masked_pairs * gathered(TILE_MASK);
            let cut = n.record_bytes + gathered(CURVATURE);
            n.splats * (read + written) + n.cuts() + masks + n.cut * cut
        },
    ),
    // How many keys there are; then its own. It reads the keys, and writes the partitions' counts.
    Cost::new(
        "radix_count",
        |n| n.partitions() * GROUP,
        |_| 2,
        |n| n.splats * WORD + n.histogram(),
    ),
    // The partitions' least and greatest keys, which decide about the passes; then their counts of the digit, which it reads,
    // several at once, and writes.
    Cost::new(
        "radix_scan",
        |_| DIGITS * GROUP,
        |n| {
            let ranges = n.partitions().div_ceil(GROUP);
            2 + ranges + scan_turns(n.partitions())
        },
        |n| 2 * n.histogram(),
    )
    .turning(|n| scan_turns(n.partitions()) as f64 / 8.0),
    // How many keys there are, the digits' totals, its own keys, the partition's counts; then the keys once more.
    // It reads and writes the keys and the splats' numbers, which before the first of the passes nobody has written, and reads
    // the counts.
    Cost::new(
        "radix_scatter",
        |n| n.partitions() * GROUP,
        |_| 4 + KEYS / KEYS_AT_ONCE,
        |n| {
            let all = 4 * n.sort_passes.max(1) - 1;
            n.splats * all * WORD / n.sort_passes.max(1) + n.histogram()
        },
    ),
    // How many keys there are, those half a partition away, its own and those beside them; then those of one depth. It reads the
    // keys; for those of one depth it reads and writes the splats, for each of four digits where there are many, and looks up
    // their numbers. Nearly all turns are of splats of one depth: the compiler takes three loops inside each other for granted
    // where a frame's few have one or two turns. What is left is straight code, a hundredth of that estimate.
    Cost::new(
        "radix_ties",
        |n| n.partitions() * GROUP,
        |n| 3 + most_of_ties(n),
        |n| {
            let number = gathered(WORD) + gathered(GAUSSIAN);
            n.splats * WORD + n.tied * (number + 4 * 4 * WORD)
        },
    )
    .turning(|_| 0.01),
    // It reads whether there are large ties; how many the stretch has of each, where the tie begins and the counts of the stretches before;
    // then, for each of its partitions, who stands for a number and of which tie it is one. Of its numbers it reads the bits,
    // and of those of a tie the rest.
    Cost::new(
        "radix_large_ties",
        |n| n.stretches() * GROUP,
        |n| match n.tied > n.least_large_tie() {
            false => 1,
            true => 3 + n.stretches().div_ceil(8) + 3 * n.partitions().div_ceil(n.stretches()),
        },
        |n| match n.tied > n.least_large_tie() {
            false => 0,
            true => n.splats / 8 + n.tied * (2 * gathered(WORD) + WORD),
        },
    )
    .turning(|n| {
        if n.tied > n.least_large_tie() {
            1.0
        } else {
            0.0
        }
    }),
    // How many splats there are; then its own and their rectangles. It writes these in the order of depth, and how many pairs
    // the chunks have.
    Cost::new(
        "macro_count",
        |n| n.partitions() * GROUP,
        |_| 3,
        |n| {
            let splat = 2 * WORD + gathered(WORD);
            n.splats * splat + n.partitions() * (1 + CHUNKS) * WORD
        },
    ),
    // The sums of all partitions; then those of its own chunks, of which it writes where they begin.
    Cost::new(
        "macro_scan",
        |n| n.partitions() * GROUP,
        |n| 2 + n.partitions().div_ceil(GROUP),
        |n| n.partitions() * (1 + 2 * CHUNKS) * WORD,
    ),
    // How many pairs there are; the search among all chunks, and where the first begins; then, in each round, the splats'
    // rectangles and their numbers. It writes the pairs, and counts them for their sort.
    Cost::new(
        "macro_expand",
        |n| n.pair_partitions() * GROUP,
        |n| {
            let chunks = n.partitions() * CHUNKS;
            2 + u64::from(chunks.next_power_of_two().ilog2()) + 2 * expand_rounds(n)
        },
        |n| (n.splats * 2 + n.macro_pairs * 2) * WORD + n.pair_histogram(),
    )
    .turning(|n| expand_rounds(n) as f64 / 8.0),
    // These are as in the sort of the splats.
    Cost::new(
        "pair_radix_count",
        |n| n.pair_partitions() * GROUP,
        |_| 2,
        |n| n.macro_pairs * WORD + n.pair_histogram(),
    ),
    Cost::new(
        "pair_radix_scan",
        |_| DIGITS * GROUP,
        |n| 1 + scan_turns(n.pair_partitions()),
        |n| 2 * n.pair_histogram(),
    )
    .turning(|n| scan_turns(n.pair_partitions()) as f64 / 8.0),
    Cost::new(
        "pair_radix_scatter",
        |n| n.pair_partitions() * GROUP,
        |_| 4 + KEYS / KEYS_AT_ONCE,
        |n| n.macro_pairs * 4 * WORD + n.pair_histogram(),
    ),
    // How many pairs there are; the steps of the search, of which each invocation reads a pair of its own. It writes where each
    // macro-tile's begin.
    Cost::new(
        "macro_ranges",
        |n| (n.macro_tiles() + 1) * u64::from(limits::MACRO_RANGE_GROUP_SIZE),
        |n| 1 + range_steps(n),
        |n| {
            let step = u64::from(limits::MACRO_RANGE_GROUP_SIZE) * gathered(WORD);
            (n.macro_tiles() + 1) * (range_steps(n) * step + WORD)
        },
    )
    .turning(|n| range_steps(n) as f64 / 8.0),
    // How many batches there are; the search for its own; then each of its pairs, perhaps its splat, the mask and the outline,
    // and once more the splat and its record. It writes how many splats of the batch each tile has. The bytes are those of one
    // surface, for which it reads the splats' numbers only where it needs their masks.
    Cost::new(
        "batch_count",
        |n| n.batches() * GROUP,
        |n| 1 + batch(n) + 2 * BATCH_TURNS,
        |n| {
            let splats = (n.masked_pairs * gathered(WORD)).min(n.macro_pairs * WORD);
            n.macro_pairs * WORD + splats + batch_bytes(n)
        },
    )
    .turning(|_| BATCH_TURNS as f64 / 8.0),
    // The macro-tile's pairs; then the counts of its batches, which it reads, several at once, and writes. It writes the sums of
    // tiles and rows.
    Cost::new(
        "batch_scan",
        |n| n.macro_tiles() * u64::from(limits::MACRO_TILES),
        |n| {
            2 + n
                .batches()
                .div_ceil(n.macro_tiles())
                .div_ceil(BATCHES_AT_ONCE)
        },
        |n| 2 * batch_counts(n) + n.tiles() * WORD + row_sums(n),
    )
    .turning(|n| n.batches() as f64 / n.macro_tiles().max(1) as f64 / (8 * BATCHES_AT_ONCE) as f64),
    // The sums of all rows; then the counts of its row's tiles, in place of which it writes where they begin.
    Cost::new(
        "row_scan",
        |n| n.tile_rows * GROUP,
        |n| 2 + n.macro_tile_rows().div_ceil(GROUP) + n.tile_columns.div_ceil(GROUP),
        |n| row_sums(n) + (2 * n.tiles() + n.filled()) * WORD,
    ),
    // As batch_count, but that it reads the counts; then where the tile begins. It writes the tiles' lists.
    Cost::new(
        "batch_scatter",
        |n| n.batches() * GROUP,
        |n| 2 + batch(n),
        |n| (n.macro_pairs * 2 + n.tiles() + n.pairs) * WORD + batch_bytes(n),
    )
    .turning(|_| BATCH_TURNS as f64 / 8.0),
    // The layer, the block's side in view, its totals. It reads the bounds too, reads and writes the block's side of the clip,
    // and writes whether it is revisited.
    Cost::new(
        "reclip_blocks",
        |n| n.blocks,
        |n| 1 + n.layer() + 2 + n.surfaces,
        |n| n.blocks * (BOUNDS + TOTALS + 4 * WORD),
    ),
    // The number of its group's block, the block, its layer, whether the Gaussian is in view, its side before, that of the
    // block now, the Gaussian. It reads and writes the words that a reclipped frame keeps of the block.
    Cost::new(
        "reclip",
        |n| n.clip_blocks * GAUSSIANS,
        |n| 2 + n.layer() + 2 + 2 + 2 + n.asked_surfaces(),
        |n| n.clip_blocks * (3 * WORD + BLOCK + MASKS / 2 + 2 * KEPT),
    ),
    // Each block says whether it is revisited and then has totals. It writes the block's places.
    Cost::new(
        "reclip_scan",
        |n| n.blocks,
        |n| n.loads_of_list(2),
        |n| n.blocks * (WORD + TOTALS + 2 * WORD),
    ),
    // The number of its group's block, the block, whether its Gaussian changes, its places; and the words of the masks. It
    // writes which splats change, and the numbers of those that are cut.
    Cost::new(
        "reclip_compact",
        |n| n.clip_blocks * GAUSSIANS,
        |_| 4 + u64::from(limits::BLOCK_SIZE / u32::BITS) + 1,
        |n| {
            let block = 4 * WORD + MASKS / 2 + KEPT;
            n.clip_blocks * block + n.changed * CHANGE + n.cut * WORD
        },
    ),
    // How many there are, which splat, which Gaussian, its layer, the cutoff record, the mask and the splat, most of which
    // it writes.
    Cost::new(
        "recut",
        |n| n.changed,
        |n| 3 + n.layer() + 2 + 2,
        |n| {
            let gaussian = gathered(SPLAT_GAUSSIAN) + gathered(GAUSSIAN);
            let splat = gathered(TILE_MASK) + SPLAT + gathered(CURVATURE);
            n.changed * (CHANGE + gaussian + n.record_bytes + splat)
        },
    ),
    Cost::new(
        "tiles",
        |n| n.filled_tiles * TILE,
        loads_of_tile,
        |n| bytes_of_tiles(n, n.filled_tiles),
    )
    .turning(splats_of_tile),
    Cost::new(
        "several_tiles",
        |n| n.several_tiles * TILE,
        loads_of_tile,
        |n| bytes_of_tiles(n, n.several_tiles),
    )
    .turning(splats_of_tile),
    Cost::new(
        "depth",
        |n| n.splats,
        |n| 2 + n.layer() + n.asked_surfaces(),
        // It reads the splat and the Gaussian, and writes the depth.
        |n| n.splats * (SPLAT_GAUSSIAN + GAUSSIAN + size_of::<types::SplatDepth>() as u64),
    ),
];

/// The turns of the scan over so many partitions.
fn scan_turns(partitions: u64) -> u64 {
    partitions.div_ceil((limits::RADIX_GROUP_SIZE * limits::RADIX_SCAN_COUNTS).into())
}

/// The longest chain of loads that puts splats of one depth into order, where as many have it as in the frame, or fewer.
fn most_of_ties(n: &FrameNumbers) -> u64 {
    let search = u64::from(n.splats.max(1).ilog2()) + 1;
    // A splat, its Gaussian and the number of that.
    let number = 3;
    let together = n.tied.min(n.least_large_tie());
    let alone = together.min(KEYS).div_ceil(KEYS_AT_ONCE) * (1 + number + 1);
    if together <= KEYS {
        return alone;
    }
    if together <= GROUP {
        return alone + search + number;
    }
    let turns = together.div_ceil(limits::RADIX_PARTITION.into());
    let digits = u64::from(n.splats.max(1).ilog2() / limits::SORT_BITS + 1);
    // The numbers; for each digit a splat and its number to count and to sort it, and the splat to carry it; the copy back.
    let sorted = search + turns * (number + digits * 5 + 1);
    alone.max(sorted)
}

/// The rounds in which a partition of the pairs finds its splats, 2048 in each, from the beginning of a chunk on; as many
/// splats as there are where all have as many pairs.
fn expand_rounds(n: &FrameNumbers) -> u64 {
    let splats = u64::from(limits::RADIX_PARTITION) * n.splats / n.macro_pairs.max(1);
    (splats + GROUP).div_ceil(2048)
}

/// The steps of the search for a macro-tile's first pair.
fn range_steps(n: &FrameNumbers) -> u64 {
    let bits = u64::from(n.macro_pairs.max(1).ilog2()) + 1;
    bits.div_ceil(limits::MACRO_RANGE_GROUP_SIZE.ilog2().into())
}

/// The loads that find a batch and the tiles of its splats.
fn batch(n: &FrameNumbers) -> u64 {
    u64::from(n.macro_tiles().next_power_of_two().ilog2()) + 1 + 3 * BATCH_TURNS
}

/// Bytes of the counts of all batches, a tile of a macro-tile each.
fn batch_counts(n: &FrameNumbers) -> u64 {
    n.batches() * u64::from(limits::MACRO_TILES) * WORD
}

/// Bytes of the masks of the pairs that need one, which neighbours in a list do not share, and of the batches' counts.
fn batch_bytes(n: &FrameNumbers) -> u64 {
    n.masked_pairs * gathered(TILE_MASK) + batch_counts(n)
}

/// Bytes of the sums of the rows of tiles of macro-tiles.
fn row_sums(n: &FrameNumbers) -> u64 {
    n.macro_tile_rows() * 4 * WORD
}

/// Bytes of the lists of so many tiles and of their splats, as far as they are loaded, each once for a macro-tile; and of the
/// pixels.
fn bytes_of_tiles(n: &FrameNumbers, tiles: u64) -> u64 {
    let share = tiles as f64 / n.filled().max(1) as f64;
    let loaded = n.loaded as f64 / n.pairs.max(1) as f64;
    let splats = n.macro_pairs as f64 * loaded * gathered(SPLAT) as f64;
    let lists = (n.loaded * WORD) as f64;
    (share * (lists + splats)) as u64 + tiles * (WORD + TILE * PIXEL)
}

/// The tile, its bounds, the count of its list; and in a tile as full as the others, for each batch its splats' numbers, the
/// splats and what else their side of the tile takes, and for each splat that is weighed its record's header and its planes.
fn loads_of_tile(n: &FrameNumbers) -> u64 {
    let splats = n.loaded.div_ceil(n.filled().max(1));
    let weighed = splats * n.cut / n.splats.max(1);
    3 + 3 * splats.div_ceil(TILE) + 2 * weighed
}

/// The turns of the loop over a tile's splats, which stands in that over its batches.
fn splats_of_tile(n: &FrameNumbers) -> f64 {
    n.loaded as f64 / n.filled().max(1) as f64 / 32.0
}
