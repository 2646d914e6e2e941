//! Stage `compact` lists the survivors and the cutoff Gaussians in the order of the scene, and writes the counts and the
//! indirect commands of all later stages. No place in a list depends on the order of atomics.

use crate::gpu::Recorder;
#[cfg(feature = "lab")]
use crate::limits;
use crate::passes::blocks::groups_of_list;
#[cfg(feature = "lab")]
use crate::passes::blocks::loads_of_list;
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost};
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

#[cfg(feature = "lab")]
pub(super) const COSTS: &[Cost] = &[
    // Each block has a side, totals and a layer. It writes the block's places, and the list.
    Cost::of::<compact_scan::Program>(
        |n| n.blocks,
        |n| loads_of_list(n, n.layer()),
        |n| n.blocks * (cost::WORD + cost::TOTALS + 2 * cost::WORD + cost::WORD),
    ),
    // The number of its group's block, the block, its layer, its side, its Gaussian's bits in the two masks; and the words of
    // each mask. It writes the survivors, and the numbers of those that are cut.
    Cost::of::<compact::Program>(
        |n| n.kept_blocks * u64::from(limits::BLOCK_SIZE),
        |n| 2 + n.layer() + 3 + 2 * u64::from(limits::BLOCK_SIZE / u32::BITS),
        |n| {
            let block = 4 * cost::WORD + cost::MASKS;
            n.kept_blocks * block + n.survivors * cost::SURVIVOR + n.cuts() + n.cut * cost::WORD
        },
    ),
];

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
