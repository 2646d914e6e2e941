//! A radix sort by partitions of consecutive keys, each owned by a workgroup, as suits graphics processors. Its scratch is
//! `histogram`, and `crowds` for those of one depth that are more than a workgroup orders.

use crate::gpu::{Groups, Recorder};
use crate::limits;
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost, FrameNumbers};
use crate::passes::plan::Plan;
use crate::passes::radix::{self, Kernels, Keys, Pass};
#[cfg(feature = "lab")]
use crate::passes::shaders::{radix_count, radix_scan, radix_scatter};
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
    // It reads and writes the keys and the survivors' numbers, which before the first of the passes nobody has written, and reads
    // the counts.
    Cost::of::<radix_scatter::Program>(
        workgroup_a_partition,
        |_| 4 + KEYS,
        |n| {
            let all = 4 * n.sort_passes.max(1) - 1;
            n.survivors * all * cost::WORD / n.sort_passes.max(1) + n.histogram()
        },
    ),
    // How many keys there are, those half a partition away, its own and those beside them; then those of one depth. It reads the
    // keys; for those of one depth it reads and writes the survivors, for each of four digits where there are many, and looks up
    // their numbers.
    Cost::of::<radix_ties::Program>(
        workgroup_a_partition,
        |n| 3 + most_of_ties(n),
        |n| {
            let number = cost::gathered(cost::WORD) + cost::gathered(cost::GAUSSIAN);
            n.survivors * cost::WORD + n.tied * (number + 4 * 4 * cost::WORD)
        },
    )
    .turning(ties_turns),
    // Whether there are crowds; how many the stretch has of each, where the crowd begins and the counts of the stretches before;
    // then, for each of its partitions, who stands for a number and of which crowd it is one. Of its numbers it reads the bits,
    // and of those of a crowd the rest.
    Cost::of::<radix_crowds::Program>(
        |n| n.stretches() * u64::from(limits::RADIX_GROUP_SIZE),
        |n| match n.tied > crowd_size(n) {
            false => 1,
            true => 3 + n.stretches().div_ceil(8) + 3 * n.partitions().div_ceil(n.stretches()),
        },
        |n| match n.tied > crowd_size(n) {
            false => 0,
            true => n.survivors / 8 + n.tied * (2 * cost::gathered(cost::WORD) + cost::WORD),
        },
    )
    .turning(|n| if n.tied > crowd_size(n) { 1.0 } else { 0.0 }),
];

/// Keys of an invocation.
#[cfg(feature = "lab")]
const KEYS: u64 = (limits::RADIX_PARTITION / limits::RADIX_GROUP_SIZE) as u64;

#[cfg(feature = "lab")]
fn workgroup_a_partition(numbers: &FrameNumbers) -> u64 {
    numbers.partitions() * u64::from(limits::RADIX_GROUP_SIZE)
}

/// The longest chain of loads that puts survivors of one depth into order, where as many have it as in the frame, or fewer.
#[cfg(feature = "lab")]
fn most_of_ties(numbers: &FrameNumbers) -> u64 {
    let search = u64::from(numbers.survivors.max(1).ilog2()) + 1;
    // A survivor, its Gaussian and the number of that.
    let number = 3;
    let together = numbers.tied.min(crowd_size(numbers));
    let alone = together.min(KEYS).div_ceil(4) * (1 + number + 1);
    if together <= KEYS {
        return alone;
    }
    let ranked = search + number;
    if together <= limits::RADIX_GROUP_SIZE.into() {
        return alone + ranked;
    }
    let turns = together.div_ceil(limits::RADIX_PARTITION.into());
    let digits = u64::from(numbers.survivors.max(1).ilog2() / limits::SORT_BITS + 1);
    // The numbers; for each digit a survivor and its number to count and to sort it, and the survivor to carry it; the copy back.
    let sorted = search + turns * (number + digits * 5 + 1);
    alone.max(sorted)
}

/// How many survivors of one depth are no crowd yet, as in glsl/crowds.glsl.
#[cfg(feature = "lab")]
fn crowd_size(numbers: &FrameNumbers) -> u64 {
    let size = numbers.survivors.div_ceil(limits::MOST_CROWDS.into());
    size.max(limits::RADIX_PARTITION.into())
}

/// The turns of the loops, nearly all of which are of splats of one depth: the compiler takes three inside each other for granted
/// where a frame's few have one or two turns. What is left is straight code, a hundredth of that estimate.
#[cfg(feature = "lab")]
fn ties_turns(_: &FrameNumbers) -> f64 {
    0.01
}

/// Stretches of so many Gaussians' numbers, as in glsl/crowds.glsl.
pub(in crate::passes) fn stretches(gaussians: u64) -> u64 {
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
