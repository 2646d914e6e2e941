//! Stage `clip`, only where the clip has changed, finds the side of each block of Gaussians, and of each Gaussian in the
//! blocks that are cut: the paper's three classes (section 3.2). The camera has no part in it.

use crate::gpu::Recorder;
use crate::passes::block_list::{self, ListFor};
use crate::passes::blocks::groups_of_blocks;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::shaders::{clip, clip_blocks};
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage {
    name: "clip",
    needed: |plan| plan.finds_clip(),
    missed: |_| true,
    pipelines: |plan, need| {
        need(key::<clip_blocks::Program>(plan));
        need(key::<block_list::Program>(plan));
        need(key::<clip::Program>(plan));
    },
    record,
};

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (scene, b) = (frame.scene, frame.buffers);
    let buffers = buffers!(clip_blocks {
        b => [frame, surfaces, clip_sides, shortlists],
        scene => [blocks],
    });
    frame.dispatch(recorder, buffers, (), groups_of_blocks(frame.plan));
    block_list::record(frame, recorder, &b.clip_sides, ListFor::Clip);
    let buffers = buffers!(clip {
        b => [frame, surfaces, block_list, counts, clip_masks, shortlists],
        scene => [gaussians],
    });
    let groups = indirect!(b.counts, FrameCounts, clip_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
