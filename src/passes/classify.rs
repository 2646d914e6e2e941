//! Stage `classify`, one invocation a Gaussian of the blocks that are not settled as a whole, culls by footprint, opacity
//! and size, and finds the side of what is in view.

use crate::gpu::Recorder;
use crate::passes::buffers::indirect;
use crate::passes::shaders::classify;
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::of_view(
    "classify",
    |plan, need| need(key::<classify::Program>(plan)),
    record,
);

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = classify::Buffers {
        frame: &b.frame,
        surfaces: &b.surfaces,
        gaussians: &frame.scene.gaussians,
        block_list: &b.block_list,
        counts: &b.counts,
        clip_sides: &b.clip_sides,
        clip_masks: &b.clip_masks,
        masks: &b.masks,
        block_counts: &b.block_counts,
    };
    let groups = indirect!(b.counts, FrameCounts, classify_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
