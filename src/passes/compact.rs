//! Stage `compact` lists the survivors and the cutoff Gaussians in the order of the scene, and writes the counts and the
//! indirect commands of all later stages. No place in a list depends on the order of atomics.

use crate::gpu::Recorder;
use crate::passes::blocks::groups_of_list;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::shaders::{compact, compact_scan};
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::when_finding_view(
    "compact",
    |plan, need| {
        need(key::<compact_scan::Program>(plan));
        need(key::<compact::Program>(plan));
    },
    record,
);

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = buffers!(compact_scan {
        b => [frame, block_sides, block_counts, block_offsets, block_list, counts],
    });
    frame.dispatch(recorder, buffers, (), groups_of_list(frame.plan));
    let buffers = buffers!(compact {
        b => [frame, block_list, counts, block_sides, masks, block_offsets, survivors, cutoffs],
    });
    let groups = indirect!(b.counts, FrameCounts, compact_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
