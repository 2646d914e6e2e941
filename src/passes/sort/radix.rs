//! A radix sort by partitions of consecutive keys, each owned by a workgroup, as suits graphics processors. Its scratch is
//! `histogram`, and `crowds` for those of one depth that are more than a workgroup orders.

use crate::passes::radix::{Kernels, Keys, Pass};
use crate::passes::recording::{Groups, Recording, counted};
use crate::passes::shaders::{radix_crowds, radix_ties};
use crate::passes::shared::{self, SCENE};
use crate::passes::sort::keys::{KEYS, MEMORY, ORDER, groups_of_count, groups_of_pass, stretches};
use crate::passes::storage::buffers;
use crate::passes::{compact, project};

/// Sorts as the other kernels do (`runs.rs`), pass by pass, and leaves out the same passes.
pub(super) fn record(recording: &mut Recording<'_, '_>) {
    let plan = recording.plan;
    let depth_keys = &project::MEMORY.depth_keys;
    let passes = plan.way.sort_passes;
    let kernels = Kernels::new(plan, Keys::Survivors);
    for number in 0..passes {
        let pair = [number, number + 1].map(|pair| (pair % 2) as usize);
        let pass = Pass {
            number,
            passes,
            keys: pair.map(|pair| KEYS[pair]),
            order: pair.map(|pair| ORDER[pair]),
            first_keys: depth_keys,
            histogram: &MEMORY.histogram,
            macro_begins: None,
        };
        pass.count(&kernels, recording, groups_of_count(number));
        pass.carry(&kernels, recording, groups_of_pass(number));
    }
    if plan.reordered {
        let sorted = plan.sorted();
        recording.fill(&MEMORY.crowds, 0);
        let buffers = buffers!(radix_ties {
            shared::MEMORY => [frame, counts],
            SCENE => [gaussians],
            compact::MEMORY => [survivors],
            MEMORY => [crowds];
            keys: KEYS[sorted],
            order: ORDER[sorted],
            scratch: ORDER[sorted ^ 1],
            numbers: KEYS[sorted ^ 1],
            // Whose keys have been carried away.
            crowd_members: depth_keys,
        });
        recording.dispatch(buffers, (), counted!(sort_groups));
        let buffers = buffers!(radix_crowds {
            shared::MEMORY => [frame, counts],
            MEMORY => [crowds];
            order: ORDER[sorted],
            crowd_members: depth_keys,
        });
        let stretches = stretches(plan.gaussians()) as u32;
        recording.dispatch(buffers, (), Groups::Count(stretches));
    }
}
