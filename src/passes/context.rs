//! What every pipeline is created with.

use ash::vk;

use crate::error::Result;
use crate::gpu::{
    Attachments, Bindings, ComputeDesc, ComputePipeline, Device, GraphicsDesc, GraphicsPipeline,
    Shader,
};

/// Device, bindings and attachments that the stages' pipelines share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context<'a> {
    pub(crate) device: &'a Device,
    pub(crate) bindings: Bindings,
    pub(crate) attachments: Attachments,
    /// Those of expected depths, where they are drawn.
    pub(crate) expected_depth: Option<Attachments>,
}

impl Context<'_> {
    pub(crate) fn compute(
        &self,
        name: &'static str,
        shader: &'static Shader,
        constants: &[(u32, u32)],
    ) -> Result<ComputePipeline> {
        let bindings = self.bindings;
        ComputePipeline::new(
            self.device,
            &ComputeDesc {
                name,
                shader,
                constants,
                bindings,
            },
        )
    }

    pub(crate) fn graphics(
        &self,
        name: &'static str,
        front: &'static Shader,
        fragment: &'static Shader,
        constants: &[(u32, u32)],
        depth_test: bool,
    ) -> Result<GraphicsPipeline> {
        let desc = GraphicsDesc {
            name,
            front,
            fragment,
            constants,
            attachments: self.attachments,
            depth_test,
            blend: Some(OVER),
            topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
            bindings: self.bindings,
        };
        GraphicsPipeline::new(self.device, &desc)
    }
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
