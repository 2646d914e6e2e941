//! Stage `classify`, one invocation a Gaussian of the blocks that are not settled as a whole, culls by footprint, opacity
//! and size, and finds the side of what is in view.

use crate::gpu::Recorder;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::shaders::classify;
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::when_finding_view(
    "classify",
    |plan, need| need(key::<classify::Program>(plan)),
    record,
);

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = buffers!(classify {
        b => [frame, surfaces, block_list, counts, clip_sides, clip_masks, masks, block_counts, shortlists],
        frame.scene => [gaussians],
    });
    let groups = indirect!(b.counts, FrameCounts, classify_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
