//! A radix sort by partitions of consecutive keys, each owned by a workgroup: reduce, then scan. All invocations of a workgroup
//! read and write neighbouring memory, as suits graphics processors. Its scratch is `histogram`.

use crate::gpu::{DeviceShape, Groups, LEAST_SUBGROUP, Recorder};
use crate::limits;
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{Cost, FrameNumbers};
use crate::passes::pipelines::Kernel;
use crate::passes::plan::Plan;
use crate::passes::shaders::{radix_count, radix_scan, radix_scatter, radix_ties};
use crate::passes::sort::{of_count, of_pass};
use crate::passes::stage::{Frame, KernelSet, key};
use crate::types::FrameCounts;

pub(super) const KERNELS: KernelSet = KernelSet {
    pipelines: |plan, need| {
        need(key::<radix_count::Program>(plan));
        need(key::<radix_scan::Program>(plan));
        need(scatter(plan).key());
        need(key::<radix_ties::Program>(plan));
    },
    record,
};

// The shaders take for granted that every device has such workgroups, that they have an invocation a digit, whose halves are
// alike, that counts have 16 bits, that those of the smallest subgroups have room, and that subgroups of up to 128 are whole.
const _: () = {
    let digits = 1 << limits::SORT_BITS;
    assert!(digits == limits::RADIX_GROUP_SIZE && limits::SORT_BITS.is_multiple_of(2));
    assert!(limits::RADIX_GROUP_SIZE <= limits::BLOCK_SIZE);
    assert!(limits::RADIX_PARTITION < 1 << 16);
    assert!(limits::RADIX_GROUP_SIZE / LEAST_SUBGROUP * digits / 2 <= limits::RADIX_PARTITION);
    assert!(limits::RADIX_GROUP_SIZE.is_multiple_of(128));
};

#[cfg(feature = "lab")]
pub(in crate::passes) const COSTS: &[Cost] = &[
    // How many keys there are; then its own.
    Cost::of::<radix_count::Program>(workgroup_a_partition, |_| 1 + KEYS),
    // The partitions' least and greatest keys, which decide about the passes; then their counts of the digit.
    Cost::of::<radix_scan::Program>(
        |_| (1 << limits::SORT_BITS) * u64::from(limits::RADIX_GROUP_SIZE),
        |n| 2 + 2 * n.partitions().div_ceil(limits::RADIX_GROUP_SIZE.into()),
    ),
    // How many keys there are, the digits' totals, its own keys, the partition's counts; then the keys once more.
    Cost::of::<radix_scatter::Program>(workgroup_a_partition, |_| 4 + KEYS),
    // For each of its keys the key and those beside it; then those of one depth.
    Cost::of::<radix_ties::Program>(workgroup_a_partition, |n| 1 + 2 * KEYS + ties(n.tied)),
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

/// The step that carries the keys: by ballots where the device can be asked for subgroups.
fn scatter(plan: &Plan) -> Kernel<radix_scatter::Program> {
    let shader = match plan.way.shape {
        DeviceShape::Gpu { subgroup } if subgroup > 0 => &radix_scatter::SUBGROUP_COMP,
        _ => &radix_scatter::COMP,
    };
    Kernel::new(shader, ())
}

/// Words of the histogram for as many keys as there are Gaussians: for each partition its keys of each digit, and its least
/// and greatest key; and the keys of each digit in all.
pub(super) fn histogram_words(gaussians: u64) -> u64 {
    let partitions = gaussians.div_ceil(limits::RADIX_PARTITION.into());
    let digits = 1 << limits::SORT_BITS;
    partitions * (digits + 2) + digits
}

/// Sorts as the other kernels do (`runs.rs`), pass by pass, and leaves out the same passes.
fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let b = frame.buffers;
    let passes = frame.plan.way.sort_passes;
    for pass in 0..passes {
        let [from, to] = [pass, pass + 1].map(|pair| (pair % 2) as usize);
        let buffers = buffers!(radix_count {
            b => [frame, counts, histogram];
            keys: &b.keys[from],
        });
        let groups = of_count(&b.counts, pass);
        frame.dispatch(recorder, buffers, radix_count::Params { pass }, groups);
        let buffers = buffers!(radix_scan {
            b => [frame, counts, histogram],
        });
        let params = radix_scan::Params { pass, passes };
        let digits = Groups::Count(1 << limits::SORT_BITS);
        frame.dispatch(recorder, buffers, params, digits);
        let buffers = buffers!(radix_scatter {
            b => [frame, counts, histogram];
            keys: &b.keys[from],
            order: &b.order[from],
            sorted_keys: &b.keys[to],
            sorted_order: &b.order[to],
        });
        let groups = of_pass(&b.counts, pass);
        let params = radix_scatter::Params { pass };
        scatter(frame.plan).dispatch(frame.pipelines, recorder, buffers, params, groups);
    }
    if frame.scene.reordered {
        let sorted = frame.plan.sorted();
        let buffers = buffers!(radix_ties {
            b => [frame, counts, splats];
            keys: &b.keys[sorted],
            order: &b.order[sorted],
            scratch: &b.order[sorted ^ 1],
            numbers: &b.keys[sorted ^ 1],
        });
        let partitions = indirect!(b.counts, FrameCounts, sort_groups);
        frame.dispatch(recorder, buffers, (), partitions);
    }
}
