//! A radix sort by runs of consecutive keys, each owned by one invocation. The runs are few and long, as suits processors.
//! Its scratch is `histogram`.

use crate::passes::eye_plan::EyePlan;
use crate::passes::project;
use crate::passes::recording::{Groups, Recording, counted};
use crate::passes::shaders::{sort_count, sort_scan, sort_scatter, sort_ties};
use crate::passes::shared;
use crate::passes::sort::keys::{KEYS, MEMORY, ORDER, groups_of_count, groups_of_pass};
use crate::passes::storage::buffers;

/// Sorts the splats by their depths, and those of one depth by their number in the scene. Of the passes that the scene's
/// bounds ask for, the device skips the first ones, as many as there are leading digits in which the keys agree (sort.glsl).
pub(super) fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let depth_keys = &project::MEMORY.depth_keys;
    let passes = recording.plan.way.sort_passes;
    for pass in 0..passes {
        let (from, to) = ((pass % 2) as usize, (pass % 2) as usize ^ 1);
        let buffers = buffers!(sort_count {
            shared::MEMORY => [frame, counts],
            MEMORY => [histogram];
            keys: if pass == 0 { depth_keys } else { KEYS[from] },
        });
        let params = sort_count::Params { pass };
        recording.dispatch(buffers, params, groups_of_count(pass));
        let buffers = buffers!(sort_scan {
            shared::MEMORY => [frame, counts],
            MEMORY => [histogram],
        });
        let params = sort_scan::Params { pass, passes };
        recording.dispatch(buffers, params, Groups::Count(1));
        let buffers = buffers!(sort_scatter {
            shared::MEMORY => [frame, counts],
            MEMORY => [histogram];
            depth_keys,
            keys: KEYS[from],
            order: ORDER[from],
            sorted_keys: KEYS[to],
            sorted_order: ORDER[to],
        });
        let params = sort_scatter::Params { pass };
        recording.dispatch(buffers, params, groups_of_pass(pass));
    }
    if recording.plan.reordered {
        let sorted = recording.plan.sorted();
        let buffers = buffers!(sort_ties {
            shared::MEMORY => [frame, counts],
            MEMORY => [histogram];
            depth_keys,
            keys: KEYS[sorted],
            order: ORDER[sorted],
            scratch: ORDER[sorted ^ 1],
        });
        recording.dispatch(buffers, (), counted!(sort_groups));
    }
}
