//! What the host draws by itself: a background, and walls that face the camera.

use crate::host::Host;
use crate::target::{DEPTH, Target};
use rara::glam::{DMat4, DVec4};

/// A wall at a depth before the camera: its corners in clip space, as shares of the picture, and its colour.
#[derive(Clone, Copy)]
pub(crate) struct Wall {
    /// The corners, -1 to 1, y up.
    pub(crate) low: [f64; 2],
    pub(crate) high: [f64; 2],
    /// World units before the eye.
    pub(crate) depth: f64,
    pub(crate) color: [f32; 4],
}

const SHADER: &str = "
struct Corner {
    @builtin(position) place: vec4f,
    @location(0) color: vec4f,
}

@vertex
fn corner(@location(0) place: vec4f, @location(1) color: vec4f) -> Corner {
    return Corner(place, color);
}

@fragment
fn paint(corner: Corner) -> @location(0) vec4f {
    return corner.color;
}
";

pub(crate) struct Meshes {
    pipeline: wgpu::RenderPipeline,
    corners: wgpu::Buffer,
    count: u32,
    background: wgpu::Color,
}

impl Meshes {
    /// Walls as a projection shows them, over a background.
    pub(crate) fn new(
        host: &Host,
        format: wgpu::TextureFormat,
        (background, walls, projection): (wgpu::Color, &[Wall], DMat4),
    ) -> Self {
        let corners: Vec<[f32; 8]> = walls
            .iter()
            .flat_map(|wall| {
                let ([left, low], [right, high]) = (wall.low, wall.high);
                [
                    (left, low),
                    (right, low),
                    (left, high),
                    (left, high),
                    (right, low),
                    (right, high),
                ]
                .map(|(x, y)| corner(wall, projection, [x, y]))
            })
            .collect();
        let bytes: &[u8] = bytemuck::cast_slice(&corners);
        let buffer = host.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("corners"),
            size: bytes.len().max(32) as u64,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        host.queue.write_buffer(&buffer, 0, bytes);
        Self {
            pipeline: pipeline(&host.device, format),
            corners: buffer,
            count: corners.len() as u32,
            background,
        }
    }

    /// Clears the target and draws the walls.
    pub(crate) fn draw(&self, encoder: &mut wgpu::CommandEncoder, target: &Target) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("meshes"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.color_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.background),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &target.depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0), // infinitely far away
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

/// A corner of a wall in clip space, then its colour.
fn corner(wall: &Wall, projection: DMat4, [x, y]: [f64; 2]) -> [f32; 8] {
    // Where in the view, which looks along -z, the picture's place is at that depth.
    let ahead = projection * DVec4::new(0.0, 0.0, -wall.depth, 1.0);
    let place = DVec4::new(
        (x * ahead.w - ahead.x) / projection.x_axis.x,
        (y * ahead.w - ahead.y) / projection.y_axis.y,
        -wall.depth,
        1.0,
    );
    let [x, y, z, w] = (projection * place).as_vec4().to_array();
    let [red, green, blue, alpha] = wall.color;
    [x, y, z, w, red, green, blue, alpha]
}

fn pipeline(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("meshes"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("meshes"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 32,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater), // reversed: nearer is more
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
