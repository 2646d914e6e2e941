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

/// What distinguishes one pipeline of the splats from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SplatVariant {
    /// Mesh shader or instanced quads.
    pub(crate) mesh: bool,
    /// `MODE_*`: without a clip the fragment shader holds no clip code.
    pub(crate) mode: u32,
    /// `PHI_*`.
    pub(crate) phi: u32,
    /// Of the colour attachment.
    pub(crate) format: vk::Format,
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
    pub(crate) fn new(context: &Context<'_>, variant: SplatVariant) -> Result<Self> {
        let SplatVariant {
            mesh, mode, phi, ..
        } = variant;
        let front = if mesh {
            &shaders::SPLAT_MESH
        } else {
            &shaders::SPLAT_VERT
        };
        let constants = [(0, mode), (1, phi)];
        let pipeline = context.graphics("splat", front, &shaders::SPLAT_FRAG, &constants, OVER)?;
        Ok(Self { pipeline, mesh })
    }

    /// Draws inside the host's rendering scope, in the order of `b.order[sorted]`; `origin` is where its viewport
    /// begins, px.
    pub(crate) fn record(
        &self,
        drawer: &mut Drawer<'_>,
        b: &Buffers,
        sorted: usize,
        origin: [f32; 2],
    ) {
        let order = &b.order[sorted];
        let buffers = [&b.frame, &b.counts, &b.splats, order, &b.cuts];
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
