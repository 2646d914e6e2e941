//! Stage 3, a Gaussian an invocation, of the blocks that are not settled as a whole: view culling by footprint, opacity
//! and size, and the clip's class.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::types::FrameCounts;

#[derive(Debug, Clone)]
pub(crate) struct Classify {
    pipeline: ComputePipeline,
}

impl Classify {
    /// With `clip` false the shader holds no clip code.
    pub(crate) fn new(context: &Context<'_>, clip: bool) -> Result<Self> {
        Ok(Self {
            pipeline: context.compute("classify", &shaders::CLASSIFY_COMP, &[(0, clip.into())])?,
        })
    }

    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, scene: &SceneBuffers, b: &Buffers) {
        let buffers = [
            &b.frame,
            &scene.gaussians,
            &b.block_list,
            &b.counts,
            &b.clip_sides,
            &b.clip_masks,
            &b.masks,
            &b.block_counts,
        ];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, classify_groups) as u64);
        recorder.dispatch(&self.pipeline, &buffers, &[], groups);
    }
}
