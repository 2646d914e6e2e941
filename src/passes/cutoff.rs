//! Stage `cutoff`, one invocation a cutoff Gaussian, writes the cutoff record, from which the fragment stage weights it.

use crate::gpu::Recorder;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::shaders::cutoff;
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

/// The stage in a frame that finds its view anew.
pub(crate) const STAGE: Stage = Stage {
    name: "cutoff",
    needed: |plan| plan.finds_view() && plan.view_is_cut(),
    missed: |plan| !plan.reclips(),
    pipelines: |plan, need| need(key::<cutoff::Program>(plan)),
    record,
};

/// The same in a reclipped frame, after stage `reclip`.
pub(crate) const STAGE_OF_RECLIP: Stage = Stage {
    needed: |plan| plan.reclips() && plan.cuts(),
    missed: |plan| plan.reclips(),
    ..STAGE
};

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = buffers!(cutoff {
        b => [frame, surfaces, cutoffs, counts, cut_records, shortlists],
        frame.scene => [gaussians],
    });
    let groups = indirect!(b.counts, FrameCounts, cutoff_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
