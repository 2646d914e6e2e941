//! Stage `cutoff`, one invocation a cutoff Gaussian, writes the cutoff record, from which the fragment stage weights it.

use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::{Recording, counted};
use crate::passes::shaders::cutoff;
use crate::passes::shared::{self, SCENE};
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory};
use crate::passes::{clip, compact};

/// The stage in a frame that finds its view anew.
pub(crate) static STAGE: Stage<EyePlan> = Stage {
    name: "cutoff",
    needed: |plan| plan.finds_view() && plan.view_is_cut(),
    missed: |plan| !plan.reclips(),
    memory: &[STORAGES],
    record,
};

/// The same in a reclipped frame, after stage `reclip`.
pub(crate) static STAGE_OF_RECLIP: Stage<EyePlan> = Stage {
    name: "cutoff",
    needed: |plan| plan.reclips() && plan.cut.cuts(),
    missed: |plan| plan.reclips(),
    memory: &[],
    record,
};

memory! { EyePlan:
    /// The records of cutoff Gaussians and, behind them, the meshes of the clip, as pixels walk them.
    cut_records: |plan| match plan.cut.cuts() {
        true => 16 * u64::from(plan.data.weight.meshes) + plan.cut.layers.meshes().bytes(),
        false => 0,
    };
}

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    if recording.plan.cut.layers.have_meshes() {
        let behind = 16 * u64::from(recording.plan.data.weight.meshes);
        recording.copy(&clip::MEMORY.meshes, &MEMORY.cut_records, behind);
    }
    let buffers = buffers!(cutoff {
        shared::MEMORY => [frame, counts],
        SCENE => [gaussians],
        clip::MEMORY => [surfaces, shortlists, meshes],
        compact::MEMORY => [cutoffs],
        MEMORY => [cut_records],
    });
    recording.dispatch(buffers, (), counted!(cutoff_groups));
}
