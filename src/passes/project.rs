//! Stage 6, a survivor an invocation: conic, quad, colour and depth key.

use std::mem::offset_of;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Groups, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::precision::ShFormat;
use crate::settings::Raster;
use crate::types::FrameCounts;

#[derive(Debug, Clone)]
pub(crate) struct Project {
    pipeline: ComputePipeline,
}

/// What tells one pipeline from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ProjectKey {
    cut: bool,
    tiles: bool,
    sh: ShFormat,
}

impl ProjectKey {
    /// The pipeline a plan needs.
    pub(crate) fn new(plan: &Plan) -> Self {
        Self {
            cut: plan.cutoff,
            tiles: plan.raster == Raster::Tiles,
            sh: plan.sh_format,
        }
    }
}

impl Project {
    /// For spherical harmonics stored in one way; with `cut` false the shader knows no cutoff records.
    pub(crate) fn new(context: &Context<'_>, key: ProjectKey) -> Result<Self> {
        let constants = [
            (0, key.cut.into()),
            (1, key.sh.code()),
            (2, key.tiles.into()),
        ];
        Ok(Self {
            pipeline: context.compute("project", &shaders::PROJECT_COMP, &constants)?,
        })
    }

    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, scene: &SceneBuffers, b: &Buffers) {
        let [keys, same_keys] = &b.keys;
        let buffers = [
            &b.frame,
            &scene.gaussians,
            &scene.sh,
            &b.survivors,
            &b.counts,
            &b.splats,
            keys,
            same_keys,
            &b.cuts,
            &b.tile_masks,
        ];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, project_groups) as u64);
        recorder.dispatch(&self.pipeline, &buffers, &[], groups);
    }
}
