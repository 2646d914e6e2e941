//! A host whose pipelines have all of Vulkan 1.3's dynamic state and whose viewport is upside down, as engines with y up
//! have it: splats lie upright between its meshes, under its scissor, and it sets its own state again after them.

use std::cell::{OnceCell, RefCell};
use std::io::Cursor;

use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::common;
use rara::ash::{Device, util, vk};
use rara::scene::{Kind, generate};
use rara::{ClipOp, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const SIZE: (u32, u32) = (189, 131);
/// The meshes' centres in the host's clip space, in which y is up.
const UPPER_LEFT: [f32; 2] = [-0.4, 0.3];
const LOWER_RIGHT: [f32; 2] = [0.3, -0.2];

/// The shaders of the C++ host's mesh, an octahedron, as glslang has written them.
const VERTEX: &[u8] = include_bytes!("../../tools/examples/mesh.vert.spv");
const FRAGMENT: &[u8] = include_bytes!("../../tools/examples/mesh.frag.spv");

/// A pipeline of the host's, with its layout.
struct Mesh {
    raw: Device,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

/// All that the pipeline leaves to commands.
const DYNAMIC: [vk::DynamicState; 16] = [
    vk::DynamicState::VIEWPORT_WITH_COUNT,
    vk::DynamicState::SCISSOR_WITH_COUNT,
    vk::DynamicState::CULL_MODE,
    vk::DynamicState::FRONT_FACE,
    vk::DynamicState::PRIMITIVE_TOPOLOGY,
    vk::DynamicState::PRIMITIVE_RESTART_ENABLE,
    vk::DynamicState::RASTERIZER_DISCARD_ENABLE,
    vk::DynamicState::LINE_WIDTH,
    vk::DynamicState::DEPTH_BIAS_ENABLE,
    vk::DynamicState::DEPTH_TEST_ENABLE,
    vk::DynamicState::DEPTH_WRITE_ENABLE,
    vk::DynamicState::DEPTH_COMPARE_OP,
    vk::DynamicState::DEPTH_BOUNDS_TEST_ENABLE,
    vk::DynamicState::STENCIL_TEST_ENABLE,
    vk::DynamicState::STENCIL_OP,
    vk::DynamicState::BLEND_CONSTANTS,
];

impl Mesh {
    /// # Safety
    /// The device outlives the mesh.
    unsafe fn new(raw: &Device) -> Self {
        let push = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::VERTEX)
            .size(80)];
        let info = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(&push);
        // SAFETY: the caller vouches for the device; what is pointed to outlives the calls, and the modules the pipeline's
        // creation.
        unsafe {
            let layout = raw.create_pipeline_layout(&info, None).expect("a layout");
            let modules = [VERTEX, FRAGMENT].map(|module| {
                let code = util::read_spv(&mut Cursor::new(module)).expect("a module");
                let info = vk::ShaderModuleCreateInfo::default().code(&code);
                raw.create_shader_module(&info, None).expect("a module")
            });
            let stage = |stage, module| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage)
                    .module(module)
                    .name(c"main")
            };
            let stages = [
                stage(vk::ShaderStageFlags::VERTEX, modules[0]),
                stage(vk::ShaderStageFlags::FRAGMENT, modules[1]),
            ];
            let input = vk::PipelineVertexInputStateCreateInfo::default();
            let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
                .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
            let viewport = vk::PipelineViewportStateCreateInfo::default();
            let raster = vk::PipelineRasterizationStateCreateInfo::default();
            let samples = vk::PipelineMultisampleStateCreateInfo::default()
                .rasterization_samples(vk::SampleCountFlags::TYPE_1);
            let depth = vk::PipelineDepthStencilStateCreateInfo::default();
            let overwrite = [vk::PipelineColorBlendAttachmentState::default()
                .color_write_mask(vk::ColorComponentFlags::RGBA)];
            let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&overwrite);
            let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&DYNAMIC);
            let formats = [FLOATS];
            let mut rendering =
                vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
            let info = vk::GraphicsPipelineCreateInfo::default()
                .stages(&stages)
                .vertex_input_state(&input)
                .input_assembly_state(&assembly)
                .viewport_state(&viewport)
                .rasterization_state(&raster)
                .multisample_state(&samples)
                .depth_stencil_state(&depth)
                .color_blend_state(&blend)
                .dynamic_state(&dynamic)
                .layout(layout)
                .push_next(&mut rendering);
            let made = raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
            for module in modules {
                raw.destroy_shader_module(module, None);
            }
            Self {
                raw: raw.clone(),
                layout,
                pipeline: made.expect("a pipeline")[0],
            }
        }
    }

    /// Binds the pipeline, sets all of its state, and draws.
    ///
    /// # Safety
    /// `cmd` is recording inside a rendering scope of the pipeline's format.
    unsafe fn draw(&self, cmd: vk::CommandBuffer, [x, y]: [f32; 2]) {
        let raw = &self.raw;
        let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
        let upside_down = vk::Viewport {
            x: 0.0,
            y: height,
            width,
            height: -height,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // The identity, and the octahedron's centre and radius.
        let mut push = [0.0_f32; 20];
        for diagonal in 0..4 {
            push[5 * diagonal] = 1.0;
        }
        push[16..].copy_from_slice(&[x, y, 0.5, 0.25]);
        let (both, keep) = (vk::StencilFaceFlags::FRONT_AND_BACK, vk::StencilOp::KEEP);
        let always = vk::CompareOp::ALWAYS;
        // SAFETY: the caller vouches for `cmd`; the pipeline is alive.
        unsafe {
            raw.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, self.pipeline);
            raw.cmd_set_viewport_with_count(cmd, &[upside_down]);
            raw.cmd_set_scissor_with_count(cmd, &[scissor(SIZE.0)]);
            raw.cmd_set_cull_mode(cmd, vk::CullModeFlags::NONE);
            raw.cmd_set_front_face(cmd, vk::FrontFace::CLOCKWISE);
            raw.cmd_set_primitive_topology(cmd, vk::PrimitiveTopology::TRIANGLE_LIST);
            raw.cmd_set_primitive_restart_enable(cmd, false);
            raw.cmd_set_rasterizer_discard_enable(cmd, false);
            raw.cmd_set_line_width(cmd, 1.0);
            raw.cmd_set_depth_bias_enable(cmd, false);
            raw.cmd_set_depth_test_enable(cmd, false);
            raw.cmd_set_depth_write_enable(cmd, false);
            raw.cmd_set_depth_compare_op(cmd, always);
            raw.cmd_set_depth_bounds_test_enable(cmd, false);
            raw.cmd_set_stencil_test_enable(cmd, false);
            raw.cmd_set_stencil_op(cmd, both, keep, keep, keep, always);
            raw.cmd_set_blend_constants(cmd, &[0.0; 4]);
            let bytes = bytemuck::cast_slice(&push);
            raw.cmd_push_constants(cmd, self.layout, vk::ShaderStageFlags::VERTEX, 0, bytes);
            raw.cmd_draw(cmd, 24, 1, 0, 0);
        }
    }
}

impl Drop for Mesh {
    fn drop(&mut self) {
        // SAFETY: each frame was waited for, and the device outlives the mesh.
        unsafe {
            self.raw.destroy_pipeline(self.pipeline, None);
            self.raw.destroy_pipeline_layout(self.layout, None);
        }
    }
}

/// The left part of the target, so many pixels wide.
fn scissor(width: u32) -> vk::Rect2D {
    let height = SIZE.1;
    vk::Extent2D { width, height }.into()
}

#[test]
fn splats_lie_upright_between_meshes_whose_viewport_is_upside_down() {
    let scene = generate(Kind::General, 3_000, 5);
    let camera = common::views(&scene, 3, SIZE)[1];
    let clip = common::clip(&scene, 2, ClipOp::And);
    with_host(true, |host, device| {
        let lent = host.lend();
        let canvas = Canvas::new(&lent, device, CanvasDesc::new(SIZE, FLOATS));
        // SAFETY: the host outlives the mesh.
        let mesh = unsafe { Mesh::new(&lent.device) };
        let alone = |at| {
            // SAFETY: `cmd` is inside the canvas's scope, which has the pipeline's format.
            let [picture, _] = canvas.draw(|_| (), |cmd| unsafe { mesh.draw(cmd, at) });
            picture
        };
        let (left, right) = (alone(UPPER_LEFT), alone(LOWER_RIGHT));
        let row = |picture: &[[f32; 4]]| {
            let first = picture.iter().position(|pixel| pixel[3] == 1.0);
            first.expect("a mesh") as u32 / SIZE.0
        };
        assert!(row(&left) < row(&right), "up is up in the host's pictures");

        let buffers = SceneBuffers::upload(device, &scene, ShFormat::Float).expect("uploads");
        for raster in common::rasters(device) {
            let mut renderer =
                Renderer::new(device, RendererDesc::new(FLOATS)).expect("a renderer");
            let settings = Settings::default().raster(raster);
            let configured = renderer.configure(&buffers, &camera, &clip, &settings);
            let splats = canvas.draw_frame(&mut renderer, &buffers, configured, &Frame::new(SIZE));
            for seen in [SIZE.0, SIZE.0 / 2] {
                let configured = renderer.configure(&buffers, &camera, &clip, &settings);
                let mut configured = Some(configured.expect("configures"));
                let prepared = OnceCell::new();
                let shared = RefCell::new(&mut renderer);
                let [picture, _] = canvas.draw(
                    // SAFETY: `cmd` is recording outside a scope, and all is waited for.
                    |cmd| unsafe {
                        let frame = configured.take().expect("once");
                        let made = shared.borrow_mut().prepare(cmd, &buffers, None, frame);
                        prepared.get_or_init(|| made.expect("prepares"));
                    },
                    // SAFETY: `cmd` is inside the canvas's scope, which the renderer was made for.
                    |cmd| unsafe {
                        mesh.draw(cmd, UPPER_LEFT);
                        lent.device.cmd_set_scissor(cmd, 0, &[scissor(seen)]);
                        let prepared = prepared.get().expect("it was prepared");
                        let drawn = shared.borrow_mut().draw(cmd, [0.0; 2], prepared);
                        drawn.expect("draws");
                        mesh.draw(cmd, LOWER_RIGHT);
                    },
                );
                let mut shown = 0;
                for (index, pixel) in picture.iter().enumerate() {
                    let column = index as u32 % SIZE.0;
                    let over = match column < seen {
                        true => splats[index],
                        false => [0.0; 4],
                    };
                    let below = left[index];
                    let blended = [0, 1, 2, 3].map(|c| over[c] + (1.0 - over[3]) * below[c]);
                    let expected = match right[index][3] == 1.0 {
                        true => right[index],
                        false => blended,
                    };
                    let pairs = pixel.iter().zip(&expected);
                    let worst = pairs.fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs()));
                    let row = index as u32 / SIZE.0;
                    assert!(
                        worst < 1e-4,
                        "{raster:?}, {column},{row}: {pixel:?}, and not {expected:?}"
                    );
                    shown += usize::from(over[3] > 0.1 && right[index][3] == 0.0);
                }
                assert!(shown > 1_000, "{raster:?}: splats in {shown} pixels");
            }
        }
    });
}
