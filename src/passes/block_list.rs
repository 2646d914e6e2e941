//! Lists the blocks whose Gaussians differ, for one stage.

use crate::gpu::{Buffer, Groups, Recorder};
#[cfg(feature = "lab")]
use crate::limits;
use crate::passes::buffers::buffers;
#[cfg(feature = "lab")]
use crate::passes::cost::Cost;
use crate::passes::shaders::block_list;
use crate::passes::stage::Frame;

pub(super) use block_list::Program;

#[cfg(feature = "lab")]
pub(super) const COSTS: &[Cost] = &[
    // It goes through its run of blocks to count, and once more to list.
    Cost::of::<Program>(|_| limits::BLOCK_SIZE.into(), |n| 1 + 2 * n.block_run()),
];

/// The stage that will look at the blocks of the list.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ListFor {
    Clip = 0,
    Classify = 1,
}

/// Lists those whose two low bits in `sides` say that they differ.
pub(crate) fn record(
    frame: &Frame<'_>,
    recorder: &mut Recorder<'_>,
    sides: &Buffer,
    list_for: ListFor,
) {
    let b = frame.buffers;
    let buffers = buffers!(block_list {
        b => [frame, block_list, counts];
        sides,
    });
    let params = block_list::Params {
        stage: list_for as u32,
    };
    frame.dispatch(recorder, buffers, params, Groups::Count(1));
}
