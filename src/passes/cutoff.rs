//! Stage 5, a cutoff Gaussian an invocation: what the fragment stage needs to weight it, into the cutoff buffer.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::types::FrameCounts;

#[derive(Debug, Clone)]
pub(crate) struct Cutoff {
    pipeline: ComputePipeline,
}

impl Cutoff {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            pipeline: context.compute("cutoff", &shaders::CUTOFF_COMP, &[])?,
        })
    }

    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, scene: &SceneBuffers, b: &Buffers) {
        let buffers = [&b.frame, &scene.gaussians, &b.cutoffs, &b.counts, &b.cuts];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, cutoff_groups) as u64);
        recorder.dispatch(&self.pipeline, &buffers, &[], groups);
    }
}
