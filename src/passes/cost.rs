//! The work that each compute pass costs a GPU's frame, as functions of the frame's numbers: each pass declares how many
//! invocations it has, how many loads one of them may have to wait for, one after the other, and how many bytes of device
//! memory all of them together read and write. The declarations stand beside the passes; `tests/gpu_cost` holds them to the
//! commands of real frames, and to ceilings. The laboratory's `measure::gpu_model` predicts times from them.
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

use super::shaders::Interface;
use super::{
    bin, block_list, blocks, classify, clip, compact, cutoff, depth, project, reclip, sort, tiles,
};
use crate::{limits, types};

/// The numbers of a frame that the cost of its passes depends on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FrameNumbers {
    /// Blocks of Gaussians.
    pub blocks: u64,
    /// Blocks that the clip may cut, or that a moved clip revisits.
    pub clip_blocks: u64,
    /// Blocks that neither view nor clip settles.
    pub view_blocks: u64,
    /// Blocks with survivors.
    pub kept_blocks: u64,
    /// Layers of the scene.
    pub layers: u64,
    /// Surfaces of a layer's region.
    pub surfaces: u64,
    /// Gaussians that are drawn.
    pub survivors: u64,
    /// Those of them that are cut.
    pub cut: u64,
    /// Those of them that a moved clip changes.
    pub changed: u64,
    /// Passes of their sort that are not skipped.
    pub sort_passes: u64,
    /// The most of them that have one depth.
    pub tied: u64,
    /// Columns of tiles in the picture.
    pub tile_columns: u64,
    /// Rows of tiles in the picture.
    pub tile_rows: u64,
    /// Pairs of macro-tile and splat.
    pub macro_pairs: u64,
    /// Those of them whose tiles only the splat's mask tells.
    pub masked_pairs: u64,
    /// Pairs of tile and splat.
    pub pairs: u64,
    /// Tiles that hold splats, of which several surfaces cut none.
    pub filled_tiles: u64,
    /// Tiles in which several surfaces cut a splat.
    pub several_tiles: u64,
    /// Pairs of tile and splat that tiles load before all of their pixels are saturated.
    pub loaded: u64,
    /// Bytes of a Gaussian's spherical harmonics.
    pub sh_bytes: u64,
    /// Bytes of a cutoff record.
    pub record_bytes: u64,
}

impl FrameNumbers {
    /// The numbers by their names.
    pub fn named(&mut self) -> [(&'static str, &mut u64); 21] {
        [
            ("blocks", &mut self.blocks),
            ("clip_blocks", &mut self.clip_blocks),
            ("view_blocks", &mut self.view_blocks),
            ("kept_blocks", &mut self.kept_blocks),
            ("layers", &mut self.layers),
            ("surfaces", &mut self.surfaces),
            ("survivors", &mut self.survivors),
            ("cut", &mut self.cut),
            ("changed", &mut self.changed),
            ("sort_passes", &mut self.sort_passes),
            ("tied", &mut self.tied),
            ("tile_columns", &mut self.tile_columns),
            ("tile_rows", &mut self.tile_rows),
            ("macro_pairs", &mut self.macro_pairs),
            ("masked_pairs", &mut self.masked_pairs),
            ("pairs", &mut self.pairs),
            ("filled_tiles", &mut self.filled_tiles),
            ("several_tiles", &mut self.several_tiles),
            ("loaded", &mut self.loaded),
            ("sh_bytes", &mut self.sh_bytes),
            ("record_bytes", &mut self.record_bytes),
        ]
    }

    /// The surfaces that a Gaussian asks at most, and where its block has a shortlist the list's word.
    pub(super) fn asked_surfaces(&self) -> u64 {
        match self.surfaces < limits::SHORTLIST_FROM.into() {
            true => self.surfaces,
            false => 1 + u64::from(limits::SHORTLIST_SURFACES),
        }
    }

    /// The loads that find a block's layer, and what is constant in it.
    pub(super) fn layer(&self) -> u64 {
        u64::from(self.layers.next_power_of_two().ilog2()) + 1
    }

    /// Partitions of the sort.
    pub(super) fn partitions(&self) -> u64 {
        self.survivors.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Parts of the scene's numbers that the sort collects those of one depth from, if there are as many numbers as survivors.
    pub(super) fn stretches(&self) -> u64 {
        sort::stretches(self.survivors)
    }

    /// Partitions of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_partitions(&self) -> u64 {
        self.macro_pairs.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Bytes of the survivors' places among those that are cut, which nobody reads where none can be.
    pub(super) fn cuts(&self) -> u64 {
        if self.record_bytes > 0 {
            self.survivors * WORD
        } else {
            0
        }
    }

    /// Macro-tiles of the picture.
    pub(super) fn macro_tiles(&self) -> u64 {
        let columns = self.tile_columns.div_ceil(limits::MACRO_COLUMNS.into());
        columns * self.tile_rows.div_ceil(limits::MACRO_ROWS.into())
    }

    /// Bytes of the histogram of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_histogram(&self) -> u64 {
        histogram_bytes(self.pair_partitions())
    }

    /// Bytes of the sort's histogram.
    pub(super) fn histogram(&self) -> u64 {
        histogram_bytes(self.partitions())
    }

    /// Tiles of the picture.
    pub(super) fn tiles(&self) -> u64 {
        self.tile_columns * self.tile_rows
    }

    /// Tiles that hold splats.
    pub(super) fn filled(&self) -> u64 {
        self.filled_tiles + self.several_tiles
    }

    /// Workgroups for the batches of the macro-tiles' splats.
    pub(super) fn batches(&self) -> u64 {
        self.macro_pairs.div_ceil(limits::BATCH_SPLATS.into()) + self.macro_tiles()
    }
}

// Bytes of what passes read and write.
/// A word.
pub(super) const WORD: u64 = size_of::<u32>() as u64;
/// A Gaussian without its colour.
pub(super) const GAUSSIAN: u64 = size_of::<types::Gaussian>() as u64;
/// The bounds of a block.
pub(super) const BOUNDS: u64 = size_of::<types::Block>() as u64;
/// A splat without its curvature and its depth, which lie apart.
pub(super) const SPLAT: u64 = 12 * WORD;
/// The curvature of a splat's weight.
pub(super) const CURVATURE: u64 = 4 * WORD;
/// A survivor: its Gaussian; where the clip cuts any, its place among those that are cut is a word more.
pub(super) const SURVIVOR: u64 = WORD;
/// A splat's mask of tiles.
pub(super) const TILE_MASK: u64 = 4 * WORD;
/// The Gaussians of a block.
pub(super) const BLOCK: u64 = limits::BLOCK_SIZE as u64 * GAUSSIAN;
/// The two masks of a block, a bit a Gaussian in each.
pub(super) const MASKS: u64 = 2 * limits::BLOCK_SIZE as u64 / 8;
/// The totals of a block.
pub(super) const TOTALS: u64 = 4 * WORD;

/// Bytes of the least piece of memory that a GPU reads: of NVIDIA's and Intel's caches a sector; those of AMD read more.
const SECTOR: u64 = 32;

/// The bytes that are moved for so many bytes that are read alone.
pub(super) const fn gathered(bytes: u64) -> u64 {
    bytes.next_multiple_of(SECTOR)
}

/// Bytes of the counts of the digits of so many partitions.
fn histogram_bytes(partitions: u64) -> u64 {
    (partitions << limits::SORT_BITS) * WORD
}

/// The cost of one dispatch of a program.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// The name of the program, and of its pipelines.
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
    pub(super) const fn of<P: Interface>(
        invocations: fn(&FrameNumbers) -> u64,
        loads: fn(&FrameNumbers) -> u64,
        bytes: fn(&FrameNumbers) -> u64,
    ) -> Self {
        Self::named(P::NAME, invocations, loads, bytes)
    }

    /// The same of pipelines that have a name of their own.
    pub(super) const fn named(
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

    /// The same with the turns of its loops.
    pub(super) const fn turning(self, turns: fn(&FrameNumbers) -> f64) -> Self {
        Self { turns, ..self }
    }
}

/// The costs of all passes of a GPU's frames.
pub fn costs() -> impl Iterator<Item = &'static Cost> {
    let all: [&[Cost]; 12] = [
        clip::COSTS,
        block_list::COSTS,
        blocks::COSTS,
        classify::COSTS,
        compact::COSTS,
        cutoff::COSTS,
        project::COSTS,
        sort::COSTS,
        bin::COSTS,
        reclip::COSTS,
        tiles::COSTS,
        depth::COSTS,
    ];
    all.into_iter().flatten()
}
