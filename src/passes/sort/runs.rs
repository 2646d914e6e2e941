//! A radix sort by runs of consecutive keys, each owned by one invocation. The runs are few and long, as suits processors.
//! Its scratch is `histogram`.

use crate::gpu::{Groups, Recorder};
use crate::limits;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::shaders::{sort_count, sort_scan, sort_scatter, sort_ties};
use crate::passes::sort::{of_count, of_pass};
use crate::passes::stage::{Frame, KernelSet, key};
use crate::types::FrameCounts;

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |plan, need| {
        need(key::<sort_count::Program>(plan));
        need(key::<sort_scan::Program>(plan));
        need(key::<sort_scatter::Program>(plan));
        need(key::<sort_ties::Program>(plan));
    },
    record,
};

/// Words of the histogram for so many runs: for each its keys of each digit, and its least and greatest key.
pub(super) fn histogram_words(runs: u64) -> u64 {
    runs * ((1 << limits::SORT_BITS) + 2)
}

/// Sorts the survivors by their depths, and those of one depth by their number in the scene. Of the passes that the scene's
/// bounds ask for, the device skips the first ones, as many as there are leading digits in which the keys agree (sort.glsl).
fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let passes = frame.plan.way.sort_passes;
    let pairs = [(&b.keys[0], &b.order[0]), (&b.keys[1], &b.order[1])];
    for pass in 0..passes {
        let (keys, order) = pairs[(pass % 2) as usize];
        let (sorted_keys, sorted_order) = pairs[(pass % 2) as usize ^ 1];
        let buffers = buffers!(sort_count {
            b => [frame, counts, histogram];
            keys: if pass == 0 { &b.depth_keys } else { keys },
        });
        let groups = of_count(&b.counts, pass);
        let params = sort_count::Params { pass };
        frame.dispatch(recorder, buffers, params, groups);
        let buffers = buffers!(sort_scan {
            b => [frame, counts, histogram],
        });
        let params = sort_scan::Params { pass, passes };
        frame.dispatch(recorder, buffers, params, Groups::Count(1));
        let buffers = buffers!(sort_scatter {
            b => [frame, counts, histogram, depth_keys];
            keys, order, sorted_keys, sorted_order,
        });
        let params = sort_scatter::Params { pass };
        frame.dispatch(recorder, buffers, params, of_pass(&b.counts, pass));
    }
    if frame.scene.reordered {
        let sorted = frame.plan.sorted();
        let buffers = buffers!(sort_ties {
            b => [frame, counts, survivors, histogram],
            frame.scene => [gaussians];
            keys: &b.keys[sorted],
            order: &b.order[sorted],
            scratch: &b.order[sorted ^ 1],
            numbers: &b.keys[sorted ^ 1],
        });
        let runs = indirect!(b.counts, FrameCounts, sort_groups);
        frame.dispatch(recorder, buffers, (), runs);
    }
}
