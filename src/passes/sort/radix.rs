//! A radix sort by partitions of consecutive keys, each owned by a workgroup, as suits graphics processors. Its scratch is
//! `histogram`.

use crate::gpu::Recorder;
#[cfg(feature = "lab")]
use crate::limits;
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost, FrameNumbers};
use crate::passes::plan::Plan;
use crate::passes::radix::{self, Kernels, Keys, Pass};
use crate::passes::shaders::radix_ties;
#[cfg(feature = "lab")]
use crate::passes::shaders::{radix_count, radix_scan, radix_scatter};
use crate::passes::sort::{of_count, of_pass};
use crate::passes::stage::{Frame, KernelSet, key};
use crate::types::FrameCounts;

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |plan, need| {
        Kernels::new(plan, Keys::Survivors).need(need);
        need(key::<radix_ties::Program>(plan));
    },
    record,
};

#[cfg(feature = "lab")]
pub(in crate::passes) const COSTS: &[Cost] = &[
    // How many keys there are; then its own. It reads the keys, and writes the partitions' counts.
    Cost::of::<radix_count::Program>(
        workgroup_a_partition,
        |_| 1 + KEYS,
        |n| n.survivors * cost::WORD + n.histogram(),
    )
    .turning(|_| KEYS as f64 / 8.0),
    // The partitions' least and greatest keys, which decide about the passes; then their counts of the digit, which it reads,
    // several at once, and writes.
    Cost::of::<radix_scan::Program>(
        |_| (1 << limits::SORT_BITS) * u64::from(limits::RADIX_GROUP_SIZE),
        |n| {
            let ranges = n.partitions().div_ceil(limits::RADIX_GROUP_SIZE.into());
            2 + ranges + radix::scan_turns(n.partitions())
        },
        |n| 2 * n.histogram(),
    )
    .turning(|n| radix::scan_turns(n.partitions()) as f64 / 8.0),
    // How many keys there are, the digits' totals, its own keys, the partition's counts; then the keys once more.
    // It reads and writes the keys and the survivors' numbers, and reads the counts.
    Cost::of::<radix_scatter::Program>(
        workgroup_a_partition,
        |_| 4 + KEYS,
        |n| n.survivors * 4 * cost::WORD + n.histogram(),
    ),
    // For each of its keys the key and those beside it; then those of one depth. It reads the keys; for those of one depth it
    // reads the splats' numbers and, for each of four digits, reads and writes the survivors.
    Cost::of::<radix_ties::Program>(
        workgroup_a_partition,
        |n| 1 + 2 * KEYS + ties(n.tied),
        |n| {
            let tied = cost::gathered(cost::WORD) + 4 * 4 * cost::WORD;
            n.survivors * cost::WORD + n.tied * tied
        },
    )
    .turning(ties_turns),
];

/// Keys of an invocation.
#[cfg(feature = "lab")]
const KEYS: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

#[cfg(feature = "lab")]
fn workgroup_a_partition(numbers: &FrameNumbers) -> u64 {
    numbers.partitions() * u64::from(limits::RADIX_GROUP_SIZE)
}

/// The loads that put so many survivors of one depth into order: alone by insertion, or as a workgroup by digits.
#[cfg(feature = "lab")]
fn ties(tied: u64) -> u64 {
    if tied <= limits::TIES_ALONE.into() {
        // The end; then each survivor and its number, and those of each before it.
        return tied + tied * tied.saturating_sub(1);
    }
    let turns = tied.div_ceil(limits::RADIX_GROUP_SIZE.into());
    if turns == 1 {
        return 3; // the end, the survivor and its number
    }
    let digits = u64::from(tied.ilog2() / limits::SORT_BITS + 1);
    // The end; the numbers; for each digit a survivor and its number to count, to sort and to carry it; the copy back.
    turns + 2 * turns + digits * (2 * turns + 2 * turns.div_ceil(KEYS) + turns) + turns
}

/// The turns of the loops, nearly all of which sort those of one depth: four inside each other, which a compiler takes for
/// granted. What is left is the loop over an invocation's keys, whose 16 turns are a hundredth of that estimate. Where many have
/// one depth, their chain of loads is what lasts.
#[cfg(feature = "lab")]
fn ties_turns(_: &FrameNumbers) -> f64 {
    0.01
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
        };
        pass.count(&kernels, frame, recorder, of_count(&b.counts, number));
        pass.carry(&kernels, frame, recorder, of_pass(&b.counts, number));
    }
    if frame.scene.reordered {
        let sorted = frame.plan.sorted();
        let buffers = buffers!(radix_ties {
            b => [frame, counts, depth_keys];
            keys: &b.keys[sorted],
            order: &b.order[sorted],
            scratch: &b.order[sorted ^ 1],
            numbers: &b.keys[sorted ^ 1],
        });
        let partitions = indirect!(b.counts, FrameCounts, sort_groups);
        frame.dispatch(recorder, buffers, (), partitions);
    }
}
