use rara_base::limits;
use serde::{Deserialize, Serialize};

pub(super) const WORD: u64 = size_of::<u32>() as u64;

/// The numbers of a frame that the cost of its passes depends on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameNumbers {
    pub blocks: u64,
    /// Blocks that the clip may cut, or that a moved clip revisits.
    pub clip_blocks: u64,
    /// Blocks that neither view nor clip settles.
    pub view_blocks: u64,
    pub kept_blocks: u64,
    pub layers: u64,
    pub surfaces: u64,
    pub splats: u64,
    pub cut: u64,
    /// Splats that a moved clip changes.
    pub changed: u64,
    /// Passes of the splats' sort that are not skipped.
    pub sort_passes: u64,
    /// The most splats that have one depth.
    pub tied: u64,
    pub tile_columns: u64,
    pub tile_rows: u64,
    /// Pairs of macro-tile and splat.
    pub macro_pairs: u64,
    /// Pairs of macro-tile and splat whose tiles only the splat's mask tells.
    pub masked_pairs: u64,
    /// Pairs of tile and splat.
    pub pairs: u64,
    /// Tiles that hold splats, of which several surfaces cut none.
    pub filled_tiles: u64,
    /// Tiles in which several surfaces cut a splat.
    pub several_tiles: u64,
    /// Pairs of tile and splat that tiles load before all of their pixels are saturated.
    pub loaded: u64,
    pub sh_bytes: u64,
    pub record_bytes: u64,
}

impl FrameNumbers {
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

    /// The loads of an invocation of a workgroup that lists blocks, of which each block takes `loads`: those of the blocks
    /// before, 8 at once (glsl/block_runs.glsl), and its own, to count and to list it.
    pub(super) fn loads_of_list(&self, loads: u64) -> u64 {
        1 + (self.blocks.div_ceil(8 * u64::from(limits::BLOCK_SIZE)) + 2) * loads
    }

    pub(super) fn partitions(&self) -> u64 {
        self.splats.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Partitions of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_partitions(&self) -> u64 {
        self.macro_pairs.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Parts of the scene's numbers that the sort collects those of one depth from, if there are as many numbers as splats
    /// (glsl/large_ties.glsl).
    pub(super) fn stretches(&self) -> u64 {
        let partitions = self.partitions();
        let of_stretch = partitions.div_ceil(limits::MOST_STRETCHES.into());
        partitions.div_ceil(of_stretch.max(limits::LEAST_STRETCH.into()))
    }

    /// How many splats of one depth are no large tie yet, as in glsl/large_ties.glsl.
    pub(super) fn least_large_tie(&self) -> u64 {
        let size = self.splats.div_ceil(limits::MOST_LARGE_TIES.into());
        size.max(limits::RADIX_PARTITION.into())
    }

    /// Bytes of the histogram of the splats' sort.
    pub(super) fn histogram(&self) -> u64 {
        (self.partitions() << limits::SORT_BITS) * WORD
    }

    /// Bytes of the histogram of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_histogram(&self) -> u64 {
        (self.pair_partitions() << limits::SORT_BITS) * WORD
    }

    /// Bytes of the splats' places among those that are cut, which nobody reads where none can be.
    pub(super) fn cuts(&self) -> u64 {
        u64::from(self.record_bytes > 0) * self.splats * WORD
    }

    fn macro_columns(&self) -> u64 {
        self.tile_columns.div_ceil(limits::MACRO_COLUMNS.into())
    }

    pub(super) fn macro_tiles(&self) -> u64 {
        self.macro_columns() * self.tile_rows.div_ceil(limits::MACRO_ROWS.into())
    }

    pub(super) fn macro_tile_rows(&self) -> u64 {
        self.tile_rows * self.macro_columns()
    }

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
