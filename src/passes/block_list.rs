//! Lists the blocks whose Gaussians differ, for one stage.

use crate::gpu::{Buffer, Recorder};
use crate::passes::blocks::groups_of_list;
use crate::passes::buffers::buffers;
use crate::passes::shaders::block_list;
use crate::passes::stage::Frame;

pub(super) use block_list::Program;

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
    frame.dispatch(recorder, buffers, params, groups_of_list(frame.plan));
}
