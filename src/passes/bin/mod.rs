//! Stage `bin`: the splats of each tile, by depth.
//!
//! It is given the survivors' outlines, as masks or as splats, and their [order](super::sort::sorted); it leaves the tiles'
//! lists and where they begin, how many pairs of tile and splat there are, and on GPUs lists of the tiles themselves. The plan says which kernels do it: each set
//! has a file here, shaders and scratch of its own, and may use the buffers that the sort has left over.

mod macro_tiles;
mod spans;

use crate::error::Result;
use crate::gpu::{Buffer, DeviceShape};
use crate::passes::plan::Plan;
use crate::passes::stage::{KernelSet, Stage};

pub(crate) const STAGE: Stage = Stage {
    name: "bin",
    needed: |plan| plan.finds_view() && plan.is_tiled(),
    missed: |plan| plan.is_tiled() || plan.gaussians() == 0,
    pipelines: |plan, need| (kernels(plan).pipelines)(plan, need),
    record: |frame, recorder| (kernels(frame.plan).record)(frame, recorder),
};

/// The kernels that suit the plan's kind of device.
fn kernels(plan: &Plan) -> &'static KernelSet {
    match plan.way.shape {
        DeviceShape::Cpu => &spans::KERNELS,
        DeviceShape::Gpu { .. } => &macro_tiles::KERNELS,
    }
}

/// The scratch of a set of kernels.
#[derive(Debug)]
pub(in crate::passes) enum Scratch {
    Spans(Box<spans::Scratch>),
    MacroTiles(Box<macro_tiles::Scratch>),
}

/// The words of each of a scratch's buffers; the rest is 0.
pub(in crate::passes) type ScratchWords = [u64; 9];

impl Scratch {
    /// The words that a plan for tiles asks for.
    pub(in crate::passes) fn words(plan: &Plan) -> ScratchWords {
        match plan.way.shape {
            DeviceShape::Cpu => spans::words(plan),
            DeviceShape::Gpu { .. } => macro_tiles::words(plan),
        }
    }

    /// The buffers' names, in the order of their words.
    pub(in crate::passes) fn names(shape: DeviceShape) -> &'static [&'static str] {
        match shape {
            DeviceShape::Cpu => &spans::NAMES,
            DeviceShape::Gpu { .. } => &macro_tiles::NAMES,
        }
    }

    /// That of the kernels for a kind of device; `gpu` makes the buffer of a name.
    pub(in crate::passes) fn new(
        shape: DeviceShape,
        gpu: &mut dyn FnMut(&'static str) -> Result<Buffer>,
    ) -> Result<Self> {
        Ok(match shape {
            DeviceShape::Cpu => Self::Spans(spans::Scratch::new(gpu)?.into()),
            DeviceShape::Gpu { .. } => Self::MacroTiles(macro_tiles::Scratch::new(gpu)?.into()),
        })
    }

    /// The lists of tiles that the kernels for GPUs make.
    pub(in crate::passes) fn tile_list(&self) -> Option<&Buffer> {
        match self {
            Self::Spans(_) => None,
            Self::MacroTiles(scratch) => Some(scratch.tile_list()),
        }
    }

    /// Its buffers.
    pub(in crate::passes) fn all(&self) -> Vec<&Buffer> {
        match self {
            Self::Spans(scratch) => scratch.all().into(),
            Self::MacroTiles(scratch) => scratch.all().into(),
        }
    }

    fn spans(&self) -> &spans::Scratch {
        match self {
            Self::Spans(scratch) => scratch,
            Self::MacroTiles(_) => unreachable!("a device keeps its shape"),
        }
    }

    fn macro_tiles(&self) -> &macro_tiles::Scratch {
        match self {
            Self::MacroTiles(scratch) => scratch,
            Self::Spans(_) => unreachable!("a device keeps its shape"),
        }
    }
}
