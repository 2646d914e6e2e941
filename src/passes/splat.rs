//! Stage 6: quads by a mesh shader or by instancing, back to front, blended `over`; the fragment stage consults the
//! cutoff buffer for cut splats only.

use std::mem::offset_of;

use ash::vk;

use crate::error::Result;
use crate::gpu::{Drawer, GraphicsPipeline};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::shaders;
use crate::types::{self, FrameCounts};

#[derive(Debug)]
pub(crate) struct Splat {
    pipeline: GraphicsPipeline,
    mesh: bool,
}

/// Premultiplied `over`.
const OVER: vk::PipelineColorBlendAttachmentState = vk::PipelineColorBlendAttachmentState {
    blend_enable: vk::TRUE,
    src_color_blend_factor: vk::BlendFactor::ONE,
    dst_color_blend_factor: vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
    color_blend_op: vk::BlendOp::ADD,
    src_alpha_blend_factor: vk::BlendFactor::ONE,
    dst_alpha_blend_factor: vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
    alpha_blend_op: vk::BlendOp::ADD,
    color_write_mask: vk::ColorComponentFlags::RGBA,
};

/// What tells one pipeline from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SplatKey {
    mesh: bool,
    mode: u32,
    op: u32,
    decay: u32,
    miss: u32,
}

impl SplatKey {
    /// The pipeline a plan needs: after a hard clip nothing is left for the fragment stage to do.
    pub(crate) fn new(plan: &Plan, mesh: bool) -> Self {
        if !plan.cutoff {
            return Self {
                mesh,
                mode: types::MODE_NONE,
                op: 0,
                decay: 0,
                miss: 0,
            };
        }
        let miss = if plan.mode == types::MODE_RARA {
            plan.data.miss
        } else {
            0
        };
        Self {
            mesh,
            mode: plan.mode,
            op: plan.data.op,
            decay: plan.data.decay,
            miss,
        }
    }
}

impl Splat {
    /// What the weight depends on is fixed in the pipeline: without a clip the fragment shader holds no clip code.
    pub(crate) fn new(context: &Context<'_>, key: SplatKey) -> Result<Self> {
        let mesh = key.mesh;
        let front = if mesh {
            &shaders::SPLAT_MESH
        } else {
            &shaders::SPLAT_VERT
        };
        let constants = [(0, key.mode), (1, key.op), (2, key.decay), (3, key.miss)];
        let pipeline = context.graphics("splat", front, &shaders::SPLAT_FRAG, &constants, OVER)?;
        Ok(Self { pipeline, mesh })
    }

    /// Draws inside the host's rendering scope; `origin` is where its viewport begins, px.
    pub(crate) fn record(
        &self,
        drawer: &mut Drawer<'_>,
        b: &Buffers,
        plan: &Plan,
        origin: [f32; 2],
    ) {
        let buffers = [&b.frame, &b.counts, &b.splats, &b.order[0], &b.cuts];
        let [x, y] = origin.map(f32::to_bits);
        let params = [x, y, plan.data.sigma.to_bits(), plan.cut_stride];
        if self.mesh {
            let at = offset_of!(FrameCounts, mesh_groups) as u64;
            drawer.draw_mesh_tasks_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        } else {
            let at = offset_of!(FrameCounts, draw) as u64;
            drawer.draw_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        }
    }
}
