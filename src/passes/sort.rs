//! Stage 7: stable radix sort of the survivors by linear view depth, ties by their number in the file.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::limits;
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::types::FrameCounts;

// So many passes have indirect commands of their own in FrameCounts.
const _: () = assert!(u32::BITS.div_ceil(limits::SORT_BITS) <= 4);

#[derive(Debug, Clone)]
pub(crate) struct Sort {
    count: ComputePipeline,
    scan: ComputePipeline,
    scatter: ComputePipeline,
    ties: ComputePipeline,
}

impl Sort {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            count: context.compute("sort_count", &shaders::SORT_COUNT_COMP, &[])?,
            scan: context.compute("sort_scan", &shaders::SORT_SCAN_COMP, &[])?,
            scatter: context.compute("sort_scatter", &shaders::SORT_SCATTER_COMP, &[])?,
            ties: context.compute("sort_ties", &shaders::SORT_TIES_COMP, &[])?,
        })
    }

    /// Sorts the survivors by their depths, and those of one depth by their number in the file; the result is in
    /// `keys[plan.sorted()]` and `order[plan.sorted()]`. Of the passes that the scene's bounds ask for the device leaves
    /// out the first ones, as many as there are leading digits in which the keys agree (sort.glsl).
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        scene: &SceneBuffers,
        b: &Buffers,
        plan: &Plan,
    ) {
        let sorts = |pass: usize| {
            let size = size_of::<[u32; 4]>();
            let at = offset_of!(FrameCounts, sort_pass_groups) + pass * size;
            Groups::Indirect(&b.counts, at as u64)
        };
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, sort_groups) as u64);
        let pairs = [(&b.keys[0], &b.order[0]), (&b.keys[1], &b.order[1])];
        for pass in 0..plan.sort_passes as usize {
            let params = [pass as u32, plan.sort_passes];
            let (keys, order) = pairs[pass % 2];
            let (sorted_keys, sorted_order) = pairs[(pass % 2) ^ 1];
            let count = [&b.frame, &b.counts, keys, &b.histogram];
            // What the first pass that there is sorts by has been counted before anybody knew which one it is.
            let counts = if pass == 0 { groups } else { sorts(pass - 1) };
            recorder.dispatch(&self.count, &count, &params, counts);
            let scan = [&b.frame, &b.counts, &b.histogram];
            recorder.dispatch(&self.scan, &scan, &params, Groups::Count(1));
            let scatter = [
                &b.frame,
                &b.counts,
                keys,
                order,
                &b.histogram,
                sorted_keys,
                sorted_order,
            ];
            recorder.dispatch(&self.scatter, &scatter, &params, sorts(pass));
        }
        if scene.reordered {
            let sorted = plan.sorted();
            let ties = [
                &b.frame,
                &b.counts,
                &b.keys[sorted],
                &b.order[sorted],
                &b.order[sorted ^ 1],
                &b.splats,
            ];
            recorder.dispatch(&self.ties, &ties, &[], groups);
        }
    }
}
