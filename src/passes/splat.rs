//! Stage 6: quads by a mesh shader or by instancing, back to front, blended `over`; the fragment stage consults the
//! cutoff buffer for cut splats only.

use std::mem::offset_of;

use ash::vk;

use crate::error::Result;
use crate::gpu::{Drawer, GraphicsPipeline};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::shaders;
use crate::types::FrameCounts;

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

impl Splat {
    /// `mode` is `MODE_*`: without a clip the fragment shader holds no clip code.
    pub(crate) fn new(context: &Context<'_>, mesh: bool, mode: u32) -> Result<Self> {
        let front = if mesh {
            &shaders::SPLAT_MESH
        } else {
            &shaders::SPLAT_VERT
        };
        let pipeline =
            context.graphics("splat", front, &shaders::SPLAT_FRAG, &[(0, mode)], OVER)?;
        Ok(Self { pipeline, mesh })
    }

    /// Draws inside the host's rendering scope; `origin` is where its viewport begins, px.
    pub(crate) fn record(&self, drawer: &mut Drawer<'_>, b: &Buffers, origin: [f32; 2]) {
        let buffers = [&b.frame, &b.counts, &b.splats, &b.order[0], &b.cuts];
        let params = origin.map(f32::to_bits);
        if self.mesh {
            let at = offset_of!(FrameCounts, mesh_groups) as u64;
            drawer.draw_mesh_tasks_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        } else {
            let at = offset_of!(FrameCounts, draw) as u64;
            drawer.draw_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        }
    }
}
