//! The numbers of a frame that the costs of its passes depend on.

use rara_base::limits;

pub(super) const WORD: u64 = size_of::<u32>() as u64;

/// The struct of the numbers, and the numbers by their names.
macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident,)+) => {
        /// The numbers of a frame that the cost of its passes depends on.
        #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
        pub struct FrameNumbers {
            $($(#[$doc])* pub $name: u64,)+
        }

        impl FrameNumbers {
            pub fn named(&mut self) -> impl Iterator<Item = (&'static str, &mut u64)> {
                [$((stringify!($name), &mut self.$name),)+].into_iter()
            }
        }
    };
}

numbers! {
    blocks,
    /// Blocks that the clip may cut, or that a moved clip revisits.
    clip_blocks,
    /// Blocks that neither view nor clip settles.
    view_blocks,
    kept_blocks,
    layers,
    surfaces,
    /// Gaussians that are drawn.
    survivors,
    /// Survivors that are cut.
    cut,
    /// Survivors that a moved clip changes.
    changed,
    /// Passes of the survivors' sort that are not skipped.
    sort_passes,
    /// The most survivors that have one depth.
    tied,
    tile_columns,
    tile_rows,
    /// Pairs of macro-tile and splat.
    macro_pairs,
    /// Pairs of macro-tile and splat whose tiles only the splat's mask tells.
    masked_pairs,
    /// Pairs of tile and splat.
    pairs,
    /// Tiles that hold splats, of which several surfaces cut none.
    filled_tiles,
    /// Tiles in which several surfaces cut a splat.
    several_tiles,
    /// Pairs of tile and splat that tiles load before all of their pixels are saturated.
    loaded,
    sh_bytes,
    record_bytes,
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

    /// Partitions of the survivors' sort.
    pub(super) fn partitions(&self) -> u64 {
        self.survivors.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Partitions of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_partitions(&self) -> u64 {
        self.macro_pairs.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Parts of the scene's numbers that the sort collects those of one depth from, if there are as many numbers as survivors
    /// (glsl/crowds.glsl).
    pub(super) fn stretches(&self) -> u64 {
        let partitions = self.partitions();
        let of_stretch = partitions.div_ceil(limits::MOST_STRETCHES.into());
        partitions.div_ceil(of_stretch.max(limits::LEAST_STRETCH.into()))
    }

    /// How many survivors of one depth are no crowd yet, as in glsl/crowds.glsl.
    pub(super) fn crowd_size(&self) -> u64 {
        let size = self.survivors.div_ceil(limits::MOST_CROWDS.into());
        size.max(limits::RADIX_PARTITION.into())
    }

    /// Bytes of the histogram of the survivors' sort.
    pub(super) fn histogram(&self) -> u64 {
        (self.partitions() << limits::SORT_BITS) * WORD
    }

    /// Bytes of the histogram of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_histogram(&self) -> u64 {
        (self.pair_partitions() << limits::SORT_BITS) * WORD
    }

    /// Bytes of the survivors' places among those that are cut, which nobody reads where none can be.
    pub(super) fn cuts(&self) -> u64 {
        u64::from(self.record_bytes > 0) * self.survivors * WORD
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
