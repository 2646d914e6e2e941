//! Stage `classify`, one invocation a Gaussian of the blocks that are not settled as a whole, culls by footprint, opacity
//! and size, and finds the side of what is in view.

use crate::gpu::Recorder;
#[cfg(feature = "lab")]
use crate::limits;
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost};
use crate::passes::shaders::classify;
use crate::passes::stage::{Frame, Stage, key};
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::when_finding_view(
    "classify",
    |plan, need| need(key::<classify::Program>(plan)),
    record,
);

#[cfg(feature = "lab")]
pub(super) const COSTS: &[Cost] = &[
    // As clip; where the surfaces are not asked, two loads of what stage clip has found. It reads the Gaussians and, if there
    // is a clip, its side and its masks, and writes masks and totals.
    Cost::of::<classify::Program>(
        |n| n.view_blocks * u64::from(limits::BLOCK_SIZE),
        |n| 2 + n.layer() + 1 + n.asked_surfaces().max(2),
        |n| {
            let clip = n.surfaces.min(1) * (cost::WORD + cost::MASKS);
            n.view_blocks * (cost::WORD + cost::BLOCK + clip + cost::MASKS + cost::TOTALS)
        },
    ),
];

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let buffers = buffers!(classify {
        b => [frame, surfaces, block_list, counts, clip_sides, clip_masks, masks, block_counts, shortlists],
        frame.scene => [gaussians],
    });
    let groups = indirect!(b.counts, FrameCounts, classify_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
