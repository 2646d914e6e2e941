//! Stage `compact` lists the survivors and the cutoff Gaussians in the order of the scene, and writes the counts and the
//! indirect commands of all later stages. No place in a list depends on the order of atomics.

use crate::gpu::{Groups, Recorder};
use crate::passes::buffers::indirect;
use crate::passes::shaders::{compact, compact_scan};
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::of_view(
    "compact",
    |plan, need| {
        need(key::<compact_scan::Program>(plan));
        need(key::<compact::Program>(plan));
    },
    record,
);

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = compact_scan::Buffers {
        frame: &b.frame,
        block_sides: &b.block_sides,
        block_counts: &b.block_counts,
        block_offsets: &b.block_offsets,
        block_list: &b.block_list,
        counts: &b.counts,
    };
    frame.dispatch(recorder, buffers, (), Groups::Count(1));
    let buffers = compact::Buffers {
        frame: &b.frame,
        block_list: &b.block_list,
        counts: &b.counts,
        block_sides: &b.block_sides,
        masks: &b.masks,
        block_offsets: &b.block_offsets,
        survivors: &b.survivors,
        cutoffs: &b.cutoffs,
    };
    let groups = indirect!(b.counts, FrameCounts, compact_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
