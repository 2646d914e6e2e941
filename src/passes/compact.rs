//! Stage 4: the survivors' and the cutoff Gaussians' numbers in the order of the scene, the counts, and the indirect
//! commands of everything after. No place in a list depends on the order of atomics.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::shaders;
use crate::types::FrameCounts;

#[derive(Debug, Clone)]
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

    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, b: &Buffers) {
        let scan = [
            &b.frame,
            &b.block_sides,
            &b.block_counts,
            &b.block_offsets,
            &b.block_list,
            &b.counts,
        ];
        recorder.dispatch(&self.scan, &scan, &[], Groups::Count(1));
        let compact = [
            &b.frame,
            &b.block_list,
            &b.counts,
            &b.block_sides,
            &b.masks,
            &b.block_offsets,
            &b.survivors,
            &b.cutoffs,
        ];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, compact_groups) as u64);
        recorder.dispatch(&self.compact, &compact, &[], groups);
    }
}
