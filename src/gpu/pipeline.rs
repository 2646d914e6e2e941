//! Compute and graphics pipelines from reflected shaders.

use std::ffi::CStr;
use std::sync::Arc;

use ash::vk;

use super::access::Access;
use super::attachments::Attachments;
use super::device::Device;
use super::failure::failed;
use super::layout::Layout;
use super::shader::Bindings;
use super::shader::{BufferAccess, Shader};
use super::shape::DeviceShape;
use super::specialized::specialized;
use rara_base::error::{Error, Result};

/// Entry point of every shader.
const MAIN: &CStr = c"main";

/// The description from which a compute pipeline is created.
#[derive(Debug, Clone, Copy)]
pub struct ComputeDesc<'a> {
    pub name: &'static str,
    pub shader: &'a Shader,
    /// Specialisation constants: id and value.
    pub constants: &'a [(u32, u32)],
    pub bindings: Bindings,
}

/// A compute pipeline, shared by its clones; dropping the last frees it, when the device is done with it.
#[derive(Debug, Clone)]
pub struct ComputePipeline(Arc<Pipeline>);

impl ComputePipeline {
    pub fn new(device: &Device, desc: &ComputeDesc<'_>) -> Result<Self> {
        let layout = Layout::new(device, desc.name, &[desc.shader], desc.bindings)?;
        let module = Module::new(device, desc.shader, desc.bindings, desc.constants)?;
        let mut stage = module.stage();
        let mut size = vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo::default();
        if let Some(asked) = subgroup(device).filter(|_| desc.shader.subgroups) {
            size = size.required_subgroup_size(asked);
            stage = stage
                .flags(vk::PipelineShaderStageCreateFlags::REQUIRE_FULL_SUBGROUPS)
                .push_next(&mut size);
        }
        let info = [vk::ComputePipelineCreateInfo::default()
            .stage(stage)
            .layout(layout.raw)];
        #[cfg(feature = "lab")]
        let info = info.map(|info| info.flags(device.pipeline_flags()));
        let (raw, cache) = (device.raw(), device.pipeline_cache());
        // SAFETY: module and layout are the device's and alive.
        let made = unsafe { raw.create_compute_pipelines(cache, &info, None) };
        let made = made.map_err(|(_, result)| result);
        let inner = Pipeline::new(device, desc.name, layout, made, "vkCreateComputePipelines")?;
        #[cfg(feature = "lab")]
        device.note_pipeline(
            (desc.name, inner.raw),
            &[desc.shader],
            desc.constants,
            size.required_subgroup_size,
        )?;
        Ok(Self(Arc::new(inner)))
    }

    pub fn name(&self) -> &'static str {
        self.0.name
    }

    #[doc(hidden)]
    pub fn inner(&self) -> &Pipeline {
        &self.0
    }

    /// The access to each of the shader's bindings, as the shader declares it.
    pub(crate) fn accesses(&self) -> impl Iterator<Item = (usize, Access)> {
        self.0.layout.uses.iter().map(|buffer| {
            let access = match buffer.access {
                BufferAccess::Read => Access::ComputeRead,
                BufferAccess::Write => Access::ComputeWrite,
                BufferAccess::ReadWrite => Access::ComputeReadWrite,
            };
            (buffer.binding as usize, access)
        })
    }
}

/// The size of the whole subgroups that a device's compute shaders ask for, where they can.
fn subgroup(device: &Device) -> Option<u32> {
    match device.shape() {
        DeviceShape::Gpu { subgroup } => Some(subgroup).filter(|&size| size > 0),
        DeviceShape::Cpu => None,
    }
}

/// The use that a graphics pipeline makes of a depth attachment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DepthUse {
    /// It leaves it alone.
    Ignored,
    /// It leaves out the fragments behind it.
    Tested,
    /// It leaves out the fragments behind it, and writes the depths of the others and no colours.
    Written,
}

/// The description from which a graphics pipeline is created.
///
/// Pipelines have dynamic viewport and scissor, no vertex input, no culling and no stencil test. Their shaders only read buffers.
#[derive(Debug, Clone, Copy)]
pub struct GraphicsDesc<'a> {
    pub name: &'static str,
    /// The vertex or mesh shader.
    pub front: &'a Shader,
    pub fragment: &'a Shader,
    /// Specialisation constants of both stages: id and value.
    pub constants: &'a [(u32, u32)],
    pub attachments: Attachments,
    /// The use of the depth attachment, where there is one.
    pub depth: DepthUse,
    /// How fragments are blended; `None` overwrites.
    pub blend: Option<vk::PipelineColorBlendAttachmentState>,
    /// The primitives that vertices make; unused with a mesh shader.
    pub topology: vk::PrimitiveTopology,
    pub bindings: Bindings,
}

/// A graphics pipeline, shared by its clones; dropping the last frees it, when the device is done with it.
#[derive(Debug, Clone)]
pub struct GraphicsPipeline {
    inner: Arc<Pipeline>,
    mesh: bool,
}

impl GraphicsPipeline {
    pub fn new(device: &Device, desc: &GraphicsDesc<'_>) -> Result<Self> {
        let mesh = desc.front.stage == vk::ShaderStageFlags::MESH_EXT;
        assert!(
            mesh || desc.front.stage == vk::ShaderStageFlags::VERTEX,
            "pipeline \"{}\": its front must be a vertex or mesh shader",
            desc.name
        );
        if mesh && !device.support().mesh_shader {
            return Err(Error::Device(format!(
                "pipeline \"{}\" needs VK_EXT_mesh_shader, which this device lacks or was made without",
                desc.name
            )));
        }
        let layout = Layout::new(
            device,
            desc.name,
            &[desc.front, desc.fragment],
            desc.bindings,
        )?;
        if let Some(written) = layout
            .uses
            .iter()
            .find(|buffer| buffer.access != BufferAccess::Read)
        {
            panic!(
                "pipeline \"{}\": draws only read, declare buffer {} readonly",
                desc.name, written.name
            );
        }
        let module = |shader| Module::new(device, shader, desc.bindings, desc.constants);
        let (front, fragment) = (module(desc.front)?, module(desc.fragment)?);
        let stages = [front.stage(), fragment.stage()];

        let into = &desc.attachments;
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(desc.topology);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let multisample =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(into.samples);
        let writes_depth = desc.depth == DepthUse::Written;
        let written = match writes_depth {
            true => vk::ColorComponentFlags::empty(),
            false => vk::ColorComponentFlags::RGBA,
        };
        let overwrite = vk::PipelineColorBlendAttachmentState::default().color_write_mask(written);
        let blends = [desc.blend.unwrap_or(overwrite)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let nearer = match into.depth {
            Some(depth) if depth.reversed => vk::CompareOp::GREATER_OR_EQUAL,
            _ => vk::CompareOp::LESS_OR_EQUAL,
        };
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(desc.depth != DepthUse::Ignored)
            .depth_write_enable(writes_depth)
            .depth_compare_op(nearer);
        let dynamic_states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
        let formats = [into.color];
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .view_mask(into.target.view_mask)
            .color_attachment_formats(&formats);
        if let Some(depth) = into.depth {
            rendering = rendering.depth_attachment_format(depth.format);
            if depth.stencil {
                rendering = rendering.stencil_attachment_format(depth.format);
            }
        }
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout.raw);
        if into.depth.is_some() {
            info = info.depth_stencil_state(&depth);
        }
        info = match into.target.pass {
            None => info.push_next(&mut rendering),
            Some((render_pass, subpass)) => info.render_pass(render_pass).subpass(subpass),
        };
        if !mesh {
            info = info
                .vertex_input_state(&vertex_input)
                .input_assembly_state(&assembly);
        }
        #[cfg(feature = "lab")]
        let info = info.flags(device.pipeline_flags());
        let (raw, cache) = (device.raw(), device.pipeline_cache());
        // SAFETY: modules and layout are the device's and alive; everything pointed to outlives the call. Whoever named
        // a render pass vouched for it in `Target::render_pass`.
        let made = unsafe { raw.create_graphics_pipelines(cache, &[info], None) };
        let made = made.map_err(|(_, result)| result);
        let inner = Pipeline::new(device, desc.name, layout, made, "vkCreateGraphicsPipelines")?;
        #[cfg(feature = "lab")]
        device.note_pipeline(
            (desc.name, inner.raw),
            &[desc.front, desc.fragment],
            desc.constants,
            0,
        )?;
        Ok(Self {
            inner: Arc::new(inner),
            mesh,
        })
    }

    pub fn name(&self) -> &'static str {
        self.inner.name
    }

    pub fn is_mesh(&self) -> bool {
        self.mesh
    }

    #[doc(hidden)]
    pub fn inner(&self) -> &Pipeline {
        &self.inner
    }
}

/// The part that both kinds of pipelines share.
#[derive(Debug)]
pub struct Pipeline {
    pub name: &'static str,
    pub raw: vk::Pipeline,
    pub layout: Layout,
    device: Device,
}

impl Pipeline {
    fn new(
        device: &Device,
        name: &'static str,
        layout: Layout,
        made: std::result::Result<Vec<vk::Pipeline>, vk::Result>,
        call: &'static str,
    ) -> Result<Self> {
        let raw = made.map_err(failed(call))?[0];
        device.account().count_pipeline();
        device.set_name(raw, name);
        Ok(Self {
            name,
            raw,
            layout,
            device: device.clone(),
        })
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: whoever submitted work with the pipeline waited for it.
        unsafe { self.device.raw().destroy_pipeline(self.raw, None) };
    }
}

/// A shader module, needed only until the pipeline is made.
struct Module<'a> {
    device: &'a Device,
    shader: &'a Shader,
    raw: vk::ShaderModule,
}

impl<'a> Module<'a> {
    fn new(
        device: &'a Device,
        shader: &'a Shader,
        bindings: Bindings,
        constants: &[(u32, u32)],
    ) -> Result<Self> {
        let code = shader.code(bindings);
        #[cfg(feature = "lab")]
        let replaced = super::modules::replaced(shader, bindings)?;
        #[cfg(feature = "lab")]
        let code = replaced.as_deref().unwrap_or(code);
        let code = specialized(code, constants);
        let info = vk::ShaderModuleCreateInfo::default().code(&code);
        // SAFETY: the device is alive, and the words are SPIR-V that this crate's build compiled and checked, with values
        // in place of its constants.
        let raw = unsafe { device.raw().create_shader_module(&info, None) }
            .map_err(failed("vkCreateShaderModule"))?;
        device.set_name(raw, shader.name);
        Ok(Self {
            device,
            shader,
            raw,
        })
    }

    fn stage(&self) -> vk::PipelineShaderStageCreateInfo<'static> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(self.shader.stage)
            .module(self.raw)
            .name(MAIN)
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: modules are not needed once the pipeline is made, or failed to be.
        unsafe { self.device.raw().destroy_shader_module(self.raw, None) };
    }
}
