//! Stage 10: quads by a mesh shader or by instancing, back to front, blended `over`; the fragment stage consults the
//! cutoff buffer for cut splats only.

use std::mem::offset_of;

use ash::vk;

use crate::error::Result;
use crate::gpu::{Drawer, GraphicsPipeline};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::shaders;
use crate::settings::Raster;
use crate::types::{self, FrameCounts};

#[derive(Debug)]
pub(crate) struct Splat {
    pipeline: GraphicsPipeline,
    mesh: bool,
}

/// Premultiplied `over`.
pub(crate) const OVER: vk::PipelineColorBlendAttachmentState =
    vk::PipelineColorBlendAttachmentState {
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
    format: vk::Format,
    weight: WeightKey,
}

/// What of a frame the weight of cut splats depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct WeightKey {
    mode: u32,
    op: u32,
    decay: u32,
    miss: u32,
    phi: u32,
}

impl SplatKey {
    /// The pipeline a plan needs: after a hard clip nothing is left for the fragment stage to do, and what a mode does
    /// not ask for does not tell its pipelines apart.
    pub(crate) fn new(plan: &Plan, format: vk::Format) -> Self {
        Self {
            mesh: plan.raster == Raster::Mesh,
            format,
            weight: WeightKey::new(plan),
        }
    }
}

impl WeightKey {
    /// What a plan needs.
    pub(crate) fn new(plan: &Plan) -> Self {
        let when = |needed: bool, value: u32| if needed { value } else { 0 };
        let op = match plan.data.plane_count {
            1 => types::OP_ONE,
            _ => plan.data.op,
        };
        Self {
            mode: when(plan.cutoff, plan.mode),
            op: when(plan.cutoff, op),
            decay: when(plan.cutoff, plan.decay),
            miss: when(plan.cutoff && plan.mode == types::MODE_RARA, plan.miss),
            phi: when(plan.cutoff && plan.mode == types::MODE_EXACT, plan.phi),
        }
    }
}

impl WeightKey {
    /// The specialisation constants of glsl/weight.glsl.
    pub(crate) fn constants(self) -> [(u32, u32); 5] {
        [
            (0, self.mode),
            (1, self.op),
            (2, self.decay),
            (3, self.miss),
            (4, self.phi),
        ]
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
        let constants = key.weight.constants();
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
        let buffers = [
            &b.frame,
            &b.counts,
            &b.splats,
            &b.order[plan.sorted()],
            &b.cuts,
        ];
        let [x, y] = origin.map(f32::to_bits);
        let [_, _, cx, cy] = plan.data.focal;
        let principal = [cx + origin[0], cy + origin[1]].map(f32::to_bits);
        let sigma = plan.data.sigma.to_bits();
        let params = [x, y, sigma, plan.cut_stride, principal[0], principal[1]];
        if self.mesh {
            let at = offset_of!(FrameCounts, mesh_groups) as u64;
            drawer.draw_mesh_tasks_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        } else {
            let at = offset_of!(FrameCounts, draw) as u64;
            drawer.draw_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        }
    }
}
