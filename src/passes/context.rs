//! What every pipeline is created with.

use ash::vk;

use crate::error::Result;
use crate::gpu::{
    Bindings, ComputeDesc, ComputePipeline, Device, GraphicsDesc, GraphicsPipeline, Shader,
};

/// Device, bindings and formats that the stages' pipelines share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context<'a> {
    pub(crate) device: &'a Device,
    pub(crate) bindings: Bindings,
    pub(crate) color_format: vk::Format,
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
        blend: vk::PipelineColorBlendAttachmentState,
    ) -> Result<GraphicsPipeline> {
        let topology = vk::PrimitiveTopology::TRIANGLE_STRIP;
        let (bindings, color_format) = (self.bindings, self.color_format);
        let blend = Some(blend);
        let desc = GraphicsDesc {
            name,
            front,
            fragment,
            constants,
            color_format,
            blend,
            topology,
            bindings,
        };
        GraphicsPipeline::new(self.device, &desc)
    }
}
