//! Stage 1, a Gaussian an invocation: view culling by footprint, opacity and size; the paper's three classes
//! (section 3.2).

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;

#[derive(Debug)]
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

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        scene: &SceneBuffers,
        b: &Buffers,
        groups: u32,
    ) {
        let buffers = [&b.frame, &scene.gaussians, &b.masks, &b.group_counts];
        recorder.dispatch(&self.pipeline, &buffers, &[], Groups::Count(groups));
    }
}
