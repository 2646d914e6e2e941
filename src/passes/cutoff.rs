//! Stage `cutoff`, one invocation a cutoff Gaussian, writes the cutoff record, from which the fragment stage weights it.

use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::cutoff;
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::{block_list, compact};

/// The stage in a frame that finds its view anew.
pub(crate) static STAGE: Stage = Stage {
    name: "cutoff",
    needed: |plan| plan.finds_view() && plan.view_is_cut(),
    missed: |plan| !plan.reclips(),
    memory: &[STORAGES],
    record,
};

/// The same in a reclipped frame, after stage `reclip`.
pub(crate) static STAGE_OF_RECLIP: Stage = Stage {
    name: "cutoff",
    needed: |plan| plan.reclips() && plan.cuts(),
    missed: |plan| plan.reclips(),
    memory: &[],
    record,
};

memory! {
    cut_records: |plan| match plan.cuts() {
        true => 16 * u64::from(plan.data.weight.cut_stride) * plan.gaussians(),
        false => 0,
    };
}

fn record(recording: &mut Recording<'_, '_>) {
    let buffers = buffers!(cutoff {
        shared::MEMORY => [frame, surfaces, counts],
        SCENE => [gaussians],
        block_list::MEMORY => [shortlists],
        compact::MEMORY => [cutoffs],
        MEMORY => [cut_records],
    });
    recording.dispatch(buffers, (), counted!(cutoff_groups));
}
