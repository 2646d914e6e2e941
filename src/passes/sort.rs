//! Stage 7: stable radix sort of the survivors by linear view depth, ties by their number in the file.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Groups, Recorder};
use crate::limits;
use crate::passes::buffers::{Buffers, TileBuffers};
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::types::FrameCounts;

#[derive(Debug)]
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
    /// `keys[plan.sorted()]` and `order[plan.sorted()]`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        scene: &SceneBuffers,
        b: &Buffers,
        plan: &Plan,
    ) {
        let groups = offset_of!(FrameCounts, sort_groups) as u64;
        let pairs = [(&b.keys[0], &b.order[0]), (&b.keys[1], &b.order[1])];
        self.passes(recorder, b, [0, groups as u32], pairs, 0..plan.sort_passes);
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
            recorder.dispatch(
                &self.ties,
                &ties,
                &[0, 0],
                Groups::Indirect(&b.counts, groups),
            );
        }
    }

    /// Sorts the pairs of tile and splat, which lie in order of the lowest digit already, by the others.
    pub(crate) fn record_pairs(
        &self,
        recorder: &mut Recorder<'_>,
        b: &Buffers,
        t: &TileBuffers,
        digits: u32,
    ) {
        let groups = offset_of!(FrameCounts, pair_groups) as u64;
        let pairs = [
            (&t.pair_tiles[0], &t.pair_splats[0]),
            (&t.pair_tiles[1], &t.pair_splats[1]),
        ];
        self.passes(recorder, b, [1, groups as u32], pairs, 1..digits);
    }

    /// What is sorted, as the shaders know it, and where its indirect dispatch stands; the first pass reads `pairs[0]`.
    fn passes(
        &self,
        recorder: &mut Recorder<'_>,
        b: &Buffers,
        [what, groups]: [u32; 2],
        pairs: [(&Buffer, &Buffer); 2],
        digits: std::ops::Range<u32>,
    ) {
        let runs = Groups::Indirect(&b.counts, groups.into());
        for (pass, digit) in digits.enumerate() {
            let first_bit = [digit * limits::SORT_BITS, what];
            let ((keys, order), (sorted_keys, sorted_order)) =
                (pairs[pass % 2], pairs[(pass % 2) ^ 1]);
            let count = [&b.frame, &b.counts, keys, &b.histogram];
            recorder.dispatch(&self.count, &count, &first_bit, runs);
            let scan = [&b.frame, &b.histogram];
            recorder.dispatch(&self.scan, &scan, &first_bit, Groups::Count(1));
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
