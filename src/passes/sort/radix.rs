//! A radix sort by partitions of consecutive keys, each owned by a workgroup, as suits graphics processors. Its scratch is
//! `histogram`, and `crowds` for those of one depth that are more than a workgroup orders.

use crate::gpu::{Groups, Recorder};
use crate::limits;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::plan::Plan;
use crate::passes::radix::{self, Kernels, Keys, Pass};
use crate::passes::shaders::{radix_crowds, radix_ties};
use crate::passes::sort::{of_count, of_pass};
use crate::passes::stage::{Frame, KernelSet, key};
use crate::types::FrameCounts;

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |plan, need| {
        Kernels::new(plan, Keys::Survivors).need(need);
        need(key::<radix_ties::Program>(plan));
        need(key::<radix_crowds::Program>(plan));
    },
    record,
};

/// Stretches of so many Gaussians' numbers, as in glsl/crowds.glsl.
fn stretches(gaussians: u64) -> u64 {
    let partitions = gaussians.div_ceil(limits::RADIX_PARTITION.into());
    let of_stretch = partitions.div_ceil(limits::MOST_STRETCHES.into());
    partitions.div_ceil(of_stretch.max(limits::LEAST_STRETCH.into()))
}

/// Words of the crowds: whether there are any, their places, their counts, and a bit for each number.
pub(super) fn crowd_words(gaussians: u32) -> u64 {
    let tables = stretches(gaussians.into()) + 1;
    1 + tables * u64::from(limits::MOST_CROWDS) + u64::from(gaussians.div_ceil(u32::BITS))
}

/// Words of the histogram for as many keys as there are Gaussians.
pub(super) fn histogram_words(plan: &Plan) -> u64 {
    radix::histogram_words(plan.gaussians().into())
}

/// Sorts as the other kernels do (`runs.rs`), pass by pass, and leaves out the same passes.
fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let passes = frame.plan.way.sort_passes;
    let kernels = Kernels::new(frame.plan, Keys::Survivors);
    for number in 0..passes {
        let pair = [number, number + 1].map(|pair| (pair % 2) as usize);
        let pass = Pass {
            number,
            passes,
            keys: pair.map(|pair| &b.keys[pair]),
            order: pair.map(|pair| &b.order[pair]),
            first_keys: &b.depth_keys,
            histogram: &b.histogram,
            macro_begins: None,
        };
        pass.count(&kernels, frame, recorder, of_count(&b.counts, number));
        pass.carry(&kernels, frame, recorder, of_pass(&b.counts, number));
    }
    if frame.scene.reordered {
        let sorted = frame.plan.sorted();
        recorder.fill(&b.crowds, 0, b.crowds.size(), 0);
        let buffers = buffers!(radix_ties {
            b => [frame, counts, survivors, crowds],
            frame.scene => [gaussians];
            keys: &b.keys[sorted],
            order: &b.order[sorted],
            scratch: &b.order[sorted ^ 1],
            numbers: &b.keys[sorted ^ 1],
            // Whose keys have been carried away.
            crowd_members: &b.depth_keys,
        });
        let partitions = indirect!(b.counts, FrameCounts, sort_groups);
        frame.dispatch(recorder, buffers, (), partitions);
        let buffers = buffers!(radix_crowds {
            b => [frame, counts, crowds];
            order: &b.order[sorted],
            crowd_members: &b.depth_keys,
        });
        let stretches = stretches(frame.plan.gaussians().into()) as u32;
        frame.dispatch(recorder, buffers, (), Groups::Count(stretches));
    }
}
