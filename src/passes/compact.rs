//! Stage 2: the survivors' and the cutoff Gaussians' numbers in the order of the file, the counts, and the indirect
//! commands of everything after. No place in a list depends on the order of atomics.

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::shaders;

#[derive(Debug)]
pub(crate) struct Compact {
    scan: ComputePipeline,
    compact: ComputePipeline,
}

impl Compact {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            scan: context.compute("compact_scan", &shaders::COMPACT_SCAN_COMP, &[])?,
            compact: context.compute("compact", &shaders::COMPACT_COMP, &[])?,
        })
    }

    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, b: &Buffers, groups: u32) {
        let scan = [&b.frame, &b.group_counts, &b.group_offsets, &b.counts];
        recorder.dispatch(&self.scan, &scan, &[], Groups::Count(1));
        let compact = [
            &b.frame,
            &b.masks,
            &b.group_offsets,
            &b.survivors,
            &b.cutoffs,
        ];
        recorder.dispatch(&self.compact, &compact, &[], Groups::Count(groups));
    }
}
