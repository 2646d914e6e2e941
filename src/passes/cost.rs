//! The latency that each compute pass costs a GPU's frame, as functions of the frame's numbers: each pass declares how
//! many invocations it has and how many loads one of them may have to wait for, one after the other. The declarations stand
//! beside the passes; `tests/gpu_cost` holds them to the commands of real frames, and to ceilings.
//!
//! A load is a trip to device memory, not to a workgroup's shared memory. Loads that do not wait for each other count as one:
//! those of a struct, and those of loops of a fixed length, which compilers unroll. In a loop whose length follows from data
//! each turn counts, since compilers do not overlap them. The frame's constants are one load.

use super::shaders::Interface;
use super::{
    bin, block_list, blocks, classify, clip, compact, cutoff, depth, project, reclip, sort, tiles,
};
use crate::limits;

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
    /// The most of them that have one depth.
    pub tied: u64,
    /// Columns of tiles in the picture.
    pub tile_columns: u64,
    /// Rows of tiles in the picture.
    pub tile_rows: u64,
    /// Pairs of macro-tile and splat.
    pub macro_pairs: u64,
    /// Pairs of tile and splat.
    pub pairs: u64,
    /// Tiles that hold splats, of which several surfaces cut none.
    pub filled_tiles: u64,
    /// Tiles in which several surfaces cut a splat.
    pub several_tiles: u64,
}

impl FrameNumbers {
    /// The loads that find a block's layer, and what is constant in it.
    pub(super) fn layer(&self) -> u64 {
        u64::from(self.layers.next_power_of_two().ilog2()) + 1
    }

    /// Partitions of the sort.
    pub(super) fn partitions(&self) -> u64 {
        self.survivors.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Partitions of the sort of the pairs of macro-tile and splat.
    pub(super) fn pair_partitions(&self) -> u64 {
        self.macro_pairs.div_ceil(limits::RADIX_PARTITION.into())
    }

    /// Macro-tiles of the picture.
    pub(super) fn macro_tiles(&self) -> u64 {
        let columns = self.tile_columns.div_ceil(limits::MACRO_COLUMNS.into());
        columns * self.tile_rows.div_ceil(limits::MACRO_ROWS.into())
    }

    /// Workgroups for the batches of the macro-tiles' splats.
    pub(super) fn batches(&self) -> u64 {
        self.macro_pairs.div_ceil(limits::BATCH_SPLATS.into()) + self.macro_tiles()
    }
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
}

impl Cost {
    pub(super) const fn of<P: Interface>(
        invocations: fn(&FrameNumbers) -> u64,
        loads: fn(&FrameNumbers) -> u64,
    ) -> Self {
        Self {
            name: P::NAME,
            invocations,
            loads,
        }
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
