//! Stage 5: stable radix sort of the survivors by linear view depth, ties by their number.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::limits;
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::shaders;
use crate::types::FrameCounts;

#[derive(Debug)]
pub(crate) struct Sort {
    count: ComputePipeline,
    scan: ComputePipeline,
    scatter: ComputePipeline,
}

impl Sort {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            count: context.compute("sort_count", &shaders::SORT_COUNT_COMP, &[])?,
            scan: context.compute("sort_scan", &shaders::SORT_SCAN_COMP, &[])?,
            scatter: context.compute("sort_scatter", &shaders::SORT_SCATTER_COMP, &[])?,
        })
    }

    /// Sorts by the lowest `passes` digits of the keys; the result is in `keys[passes % 2]` and `order[passes % 2]`.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, b: &Buffers, passes: u32) {
        let runs = Groups::Indirect(&b.counts, offset_of!(FrameCounts, sort_groups) as u64);
        for pass in 0..passes {
            let (from, to) = ((pass % 2) as usize, (pass % 2) as usize ^ 1);
            let first_bit = [pass * limits::SORT_BITS];
            let count = [&b.frame, &b.counts, &b.keys[from], &b.histogram];
            recorder.dispatch(&self.count, &count, &first_bit, runs);
            let scan = [&b.frame, &b.histogram];
            recorder.dispatch(&self.scan, &scan, &first_bit, Groups::Count(1));
            let (sorted_keys, sorted_order) = (&b.keys[to], &b.order[to]);
            let (keys, order) = (&b.keys[from], &b.order[from]);
            let scatter = [
                &b.frame,
                &b.counts,
                keys,
                order,
                &b.histogram,
                sorted_keys,
                sorted_order,
            ];
            recorder.dispatch(&self.scatter, &scatter, &first_bit, runs);
        }
    }
}
