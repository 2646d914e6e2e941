//! The passes of a radix sort for GPUs: reduce, then scan. A workgroup owns a partition of consecutive keys, so that all its
//! invocations read and write neighbouring memory. Stage `sort` sorts the splats with it, and stage `bin` the pairs of
//! macro-tile and splat.

use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::Pipeline;
use crate::passes::recording::{Groups, Recording};
use crate::passes::resources::EyeName;
use crate::passes::shaders::{radix_count, radix_scan, radix_scatter};
use crate::passes::shared;
use crate::passes::storage::{Storage, buffers};
use rara_base::limits;
use rara_gpu::{DeviceShape, LEAST_SUBGROUP};

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

/// The keys that are sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Keys {
    /// Those of the splats, of which the device may skip passes.
    Splats,
    /// The macro-tiles of pairs of macro-tile and splat.
    Pairs,
}

/// The pipelines of a pass.
#[derive(Debug)]
pub(super) struct RadixPipelines {
    count: Pipeline<radix_count::Program>,
    scan: Pipeline<radix_scan::Program>,
    scatter: Pipeline<radix_scatter::Program>,
}

impl RadixPipelines {
    pub(super) fn new(plan: &EyePlan, keys: Keys) -> Self {
        let pairs = keys == Keys::Pairs;
        // By ballots where the device can be asked for subgroups.
        let scatter = match plan.cut.shape {
            DeviceShape::Gpu { subgroup } if subgroup > 0 => &radix_scatter::SUBGROUP_COMP,
            _ => &radix_scatter::COMP,
        };
        let count = Pipeline::new(&radix_count::COMP, radix_count::Constants { pairs });
        let scan = Pipeline::new(&radix_scan::COMP, radix_scan::Constants { pairs });
        let scatter = Pipeline::new(scatter, radix_scatter::Constants { pairs });
        match keys {
            Keys::Splats => Self {
                count,
                scan,
                scatter,
            },
            Keys::Pairs => Self {
                count: count.named("pair_radix_count"),
                scan: scan.named("pair_radix_scan"),
                scatter: scatter.named("pair_radix_scatter"),
            },
        }
    }
}

/// Words of the histogram for as many keys: for each partition its keys of each digit, and its least and greatest key; and
/// the keys of each digit in all.
pub(super) fn histogram_words(keys: u64) -> u64 {
    let partitions = keys.div_ceil(limits::RADIX_PARTITION.into());
    let digits = 1 << limits::SORT_BITS;
    partitions * (digits + 2) + digits
}

/// A pass: the keys and what they order go from the first pair of buffers to the second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pass {
    /// Its number, from 0, and how many there are.
    pub(super) number: u32,
    pub(super) passes: u32,
    pub(super) keys: [&'static Storage<EyePlan>; 2],
    pub(super) order: [&'static Storage<EyePlan>; 2],
    /// The keys for whichever pass is the first that the device does not skip.
    pub(super) first_keys: &'static Storage<EyePlan>,
    pub(super) histogram: &'static Storage<EyePlan>,
    /// Where one pass that sorts all pairs leaves where those of each of so many macro-tiles begin.
    pub(super) macro_begins: Option<(&'static Storage<EyePlan>, u32)>,
}

impl Pass {
    /// Records the count of each partition's digits.
    pub(super) fn count(
        &self,
        pipelines: &RadixPipelines,
        recording: &mut Recording<'_, '_, EyePlan>,
        groups: Groups<EyeName>,
    ) {
        let keys = if self.number == 0 {
            self.first_keys
        } else {
            self.keys[0]
        };
        let buffers = buffers!(radix_count {
            shared::MEMORY => [frame, counts];
            keys,
            histogram: self.histogram,
        });
        let params = radix_count::Params { pass: self.number };
        recording.dispatch_pipeline(&pipelines.count, buffers, params, groups);
    }

    /// Records what follows the count: where each partition's keys of each digit go, and the way there.
    pub(super) fn carry(
        &self,
        pipelines: &RadixPipelines,
        recording: &mut Recording<'_, '_, EyePlan>,
        groups: Groups<EyeName>,
    ) {
        let buffers = buffers!(radix_scan {
            shared::MEMORY => [frame, counts];
            histogram: self.histogram,
        });
        let params = radix_scan::Params {
            pass: self.number,
            passes: self.passes,
        };
        let digits = Groups::Count(1 << limits::SORT_BITS);
        recording.dispatch_pipeline(&pipelines.scan, buffers, params, digits);
        let (macro_begins, macro_tiles) = self.macro_begins.unwrap_or((self.order[1], 0));
        let buffers = buffers!(radix_scatter {
            shared::MEMORY => [frame, counts];
            histogram: self.histogram,
            keys: self.keys[0],
            order: self.order[0],
            sorted_keys: self.keys[1],
            sorted_order: self.order[1],
            depth_keys: self.first_keys,
            macro_begins,
        });
        let params = radix_scatter::Params {
            pass: self.number,
            macro_tiles,
        };
        recording.dispatch_pipeline(&pipelines.scatter, buffers, params, groups);
    }
}
