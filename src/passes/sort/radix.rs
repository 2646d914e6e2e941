//! A radix sort by partitions of consecutive keys, each owned by a workgroup, as suits graphics processors. Its scratch is
//! `histogram`, and `large_ties` for those of one depth that are more than a workgroup orders.

use crate::passes::eye_plan::EyePlan;
use crate::passes::project;
use crate::passes::radix::{Keys, Pass, RadixPipelines};
use crate::passes::recording::{Groups, Recording, counted};
use crate::passes::shaders::{radix_large_ties, radix_ties};
use crate::passes::shared;
use crate::passes::sort::keys::{KEYS, MEMORY, ORDER, groups_of_count, groups_of_pass, stretches};
use crate::passes::storage::buffers;

/// Sorts as the other pipelines do (`runs.rs`), pass by pass, and leaves out the same passes.
pub(super) fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let plan = recording.plan;
    let depth_keys = &project::MEMORY.depth_keys;
    let passes = plan.way.sort_passes;
    let pipelines = RadixPipelines::new(plan, Keys::Splats);
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
        pass.count(&pipelines, recording, groups_of_count(number));
        pass.carry(&pipelines, recording, groups_of_pass(number));
    }
    if plan.reordered {
        let sorted = plan.sorted();
        recording.fill(&MEMORY.large_ties, 0);
        let buffers = buffers!(radix_ties {
            shared::MEMORY => [frame, counts],
            MEMORY => [large_ties];
            keys: KEYS[sorted],
            order: ORDER[sorted],
            scratch: ORDER[sorted ^ 1],
            depth_keys,
            // Whose keys have been carried away.
            tie_members: depth_keys,
        });
        recording.dispatch(buffers, (), counted!(sort_groups));
        let buffers = buffers!(radix_large_ties {
            shared::MEMORY => [frame, counts],
            MEMORY => [large_ties];
            order: ORDER[sorted],
            tie_members: depth_keys,
        });
        let stretches = stretches(plan.gaussians()) as u32;
        recording.dispatch(buffers, (), Groups::Count(stretches));
    }
}
