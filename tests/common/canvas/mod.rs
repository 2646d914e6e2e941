//! A canvas that a host draws into, for the tests of depth, formats and views: attachments of any format, in dynamic
//! rendering or a classic render pass, with rectangles in the depth buffer for opaque meshes.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

mod frame;
#[path = "../../../tools/examples/host.rs"]
pub mod host;
mod image;
mod pixels;
mod scope;

use rara::ash::{self, vk};
use rara::gpu::{AdoptDesc, DepthImage, Device};

pub use frame::Frame;
use host::{Host, HostDesc};
use image::Image;
use pixels::decoded;

/// The example's host with the device under test, under validation; `optional` enables the device's optional features.
pub fn open_host(format: vk::Format, extent: vk::Extent2D, optional: bool) -> Host {
    let device = std::env::var("RARA_TEST_DEVICE").ok();
    let host = Host::new(&HostDesc {
        device: device.as_deref(),
        validation: true,
        optional,
        extent,
        format,
    });
    host.expect("a Vulkan device and the validation layer (tools/test installs both)")
}

/// The host's device as rara's.
pub fn adopt(host: &Host) -> Device {
    // SAFETY: the handles belong together; every test drops what it makes of the device before it closes the host.
    unsafe { Device::adopt(host.lend()) }.expect("the host's device draws splats")
}

/// The size of the targets of a host that draws nothing into them.
pub const ONE_PIXEL: vk::Extent2D = vk::Extent2D {
    width: 1,
    height: 1,
};

/// Runs a test with a host and its device.
pub fn with_host(optional: bool, test: impl FnOnce(&Host, &Device)) {
    let host = open_host(vk::Format::R8G8B8A8_UNORM, ONE_PIXEL, optional);
    let device = adopt(&host);
    test(&host, &device);
    assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}

pub struct CanvasDesc {
    pub extent: vk::Extent2D,
    /// Layers of the images; of several, each is a view of the scopes (multiview).
    pub layers: u32,
    pub color: vk::Format,
    /// `UNDEFINED` for none.
    pub second: vk::Format,
    /// `UNDEFINED` for none.
    pub depth: vk::Format,
    pub samples: vk::SampleCountFlags,
    pub render_pass: bool,
    /// The colour before anything is drawn.
    pub clear: [f32; 4],
    /// The value of the depth buffer where there is no mesh.
    pub far: f32,
    /// Meshes that face the camera: their places, and the values of the depth buffer there.
    pub meshes: Vec<(vk::Rect2D, f32)>,
}

impl CanvasDesc {
    pub fn new((width, height): (u32, u32), color: vk::Format) -> Self {
        Self {
            extent: vk::Extent2D { width, height },
            layers: 1,
            color,
            second: vk::Format::UNDEFINED,
            depth: vk::Format::UNDEFINED,
            samples: vk::SampleCountFlags::TYPE_1,
            render_pass: false,
            clear: [0.0; 4],
            far: 1.0,
            meshes: Vec::new(),
        }
    }
}

pub struct Canvas {
    desc: CanvasDesc,
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    raw: ash::Device,
    device: Device,
    color: Image,
    /// For canvases of several samples.
    resolved: Option<Image>,
    second: Option<Image>,
    depth: Option<Image>,
    /// The same of one sample, for canvases of several.
    resolved_depth: Option<Image>,
    render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
}

/// A function that records before a scope, and one that records inside it.
pub type Scope<'a> = (
    &'a mut dyn FnMut(vk::CommandBuffer),
    &'a mut dyn FnMut(vk::CommandBuffer),
);

const COLOR: vk::ImageLayout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
const DEPTH: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
const COPIED: vk::ImageLayout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
const SAMPLED: vk::ImageLayout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
const UNDEFINED: vk::Format = vk::Format::UNDEFINED;

impl Canvas {
    /// A canvas on a host's device, which must outlive it.
    pub fn new(lent: &AdoptDesc, device: &Device, desc: CanvasDesc) -> Self {
        let mut canvas = Self {
            instance: lent.instance.clone(),
            physical: lent.physical_device,
            raw: lent.device.clone(),
            device: device.clone(),
            color: Image::none(),
            resolved: None,
            second: None,
            depth: None,
            resolved_depth: None,
            render_pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
            desc,
        };
        let one = vk::SampleCountFlags::TYPE_1;
        let d = &canvas.desc;
        let (as_color, as_depth) = (
            vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
            vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
                | vk::ImageUsageFlags::TRANSFER_SRC
                | vk::ImageUsageFlags::SAMPLED,
        );
        let color = canvas.image(d.color, as_color, d.samples);
        let resolved = (d.samples != one).then(|| canvas.image(d.color, as_color, one));
        let second = (d.second != UNDEFINED).then(|| canvas.image(d.second, as_color, d.samples));
        let depth = (d.depth != UNDEFINED).then(|| canvas.image(d.depth, as_depth, d.samples));
        let resolves = depth.is_some() && resolved.is_some();
        let resolved_depth = resolves.then(|| canvas.image(d.depth, as_depth, one));
        (canvas.color, canvas.resolved) = (color, resolved);
        (canvas.second, canvas.depth) = (second, depth);
        canvas.resolved_depth = resolved_depth;
        if canvas.desc.render_pass {
            canvas.make_render_pass();
        }
        canvas
    }

    /// The canvas's render pass, or null if it has none.
    pub fn render_pass(&self) -> vk::RenderPass {
        self.render_pass
    }

    /// The depths of one sample.
    fn read_depth(&self) -> &Image {
        let depth = self.resolved_depth.as_ref().or(self.depth.as_ref());
        depth.expect("a depth buffer")
    }

    /// The depth buffer as `prepare` takes it, for a viewport that begins at (x, y).
    pub fn depth_image(&self, x: i32, y: i32) -> DepthImage {
        DepthImage {
            image: self.read_depth().raw,
            view: vk::ImageView::null(),
            layout: COPIED,
            extent: self.desc.extent,
            layer: 0,
            origin: vk::Offset2D { x, y },
        }
    }

    /// The same as it is sampled, by what [`sampling`](Self::sampling) records.
    pub fn depth_view(&self, x: i32, y: i32) -> DepthImage {
        DepthImage {
            image: vk::Image::null(),
            view: self.read_depth().view,
            layout: SAMPLED,
            ..self.depth_image(x, y)
        }
    }

    /// Lets what is recorded before a scope sample the depth buffer.
    pub fn sampling(&self, cmd: vk::CommandBuffer, record: impl FnOnce()) {
        let depth = self.read_depth();
        // SAFETY: called from within `draw`, whose command buffer is recording outside a scope.
        unsafe { self.turn(cmd, depth, COPIED, SAMPLED) };
        record();
        // SAFETY: as above.
        unsafe { self.turn(cmd, depth, SAMPLED, COPIED) };
    }

    /// Sets viewport and scissor.
    pub fn viewport(&self, cmd: vk::CommandBuffer, x: i32, y: i32, (width, height): (u32, u32)) {
        let area = vk::Rect2D {
            offset: vk::Offset2D {
                x: x.max(0),
                y: y.max(0),
            },
            extent: vk::Extent2D { width, height },
        };
        let viewport = vk::Viewport {
            x: x as f32,
            y: y as f32,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: called from within `draw`, whose command buffer is recording.
        unsafe {
            self.raw.cmd_set_viewport(cmd, 0, &[viewport]);
            self.raw.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Draws a frame and waits: the meshes' depths, what `before` records outside a scope, and what `inside` records in
    /// it. Returns the pictures of the colour attachments.
    pub fn draw(
        &self,
        mut before: impl FnMut(vk::CommandBuffer),
        mut inside: impl FnMut(vk::CommandBuffer),
    ) -> [Vec<[f32; 4]>; 2] {
        self.draw_scopes(&mut [(&mut before, &mut inside)])
    }

    /// Draws several scopes, one after the other, in one command buffer.
    pub fn draw_scopes(&self, scopes: &mut [Scope<'_>]) -> [Vec<[f32; 4]>; 2] {
        let mut drawn = Self::draw_together(&mut [(self, scopes)]);
        drawn.pop().expect("one canvas")
    }

    /// Draws scopes of several canvases of one device in one command buffer, canvas by canvas.
    pub fn draw_together(canvases: &mut [(&Self, &mut [Scope<'_>])]) -> Vec<[Vec<[f32; 4]>; 2]> {
        let device = canvases[0].0.device.clone();
        let readbacks: Vec<_> = canvases
            .iter()
            .map(|(canvas, _)| canvas.readbacks())
            .collect();
        let submitted = device.submit_and_wait(|cmd| {
            for ((canvas, scopes), readbacks) in canvases.iter_mut().zip(&readbacks) {
                // SAFETY: `cmd` is recording, and everything that it uses outlives the wait.
                unsafe { canvas.record(cmd, scopes, &canvas.colors(), readbacks) };
            }
            Ok(())
        });
        submitted.expect("submits");
        let pairs = canvases.iter().zip(&readbacks);
        pairs
            .map(|((canvas, _), buffers)| canvas.read(buffers))
            .collect()
    }

    /// What the depth buffer holds after a frame, of 32-bit floats.
    pub fn depths(&self) -> Vec<f32> {
        assert_eq!(self.desc.depth, vk::Format::D32_SFLOAT);
        let [readback, _] = self.readbacks();
        let submitted = self.device.submit_and_wait(|cmd| {
            let depth = self.depth_image(0, 0).image;
            // SAFETY: `cmd` is recording; the frame before left the image ready to be copied.
            unsafe { self.copy_for_host(cmd, (depth, vk::ImageAspectFlags::DEPTH), &readback) };
            Ok(())
        });
        submitted.expect("submits");
        let held = readback.mapped().chunks_exact(4).take(self.pixels());
        held.map(|bytes| f32::from_ne_bytes(bytes.try_into().expect("four")))
            .collect()
    }

    /// The images that a frame leaves, if there are such attachments.
    fn colors(&self) -> [Option<&Image>; 2] {
        let first = self.resolved.as_ref().or(Some(&self.color));
        [first, self.second.as_ref()]
    }

    /// Those of all layers, one after the other.
    fn pixels(&self) -> usize {
        (self.desc.extent.width * self.desc.extent.height * self.desc.layers) as usize
    }

    /// The view mask of its scopes.
    fn view_mask(&self) -> u32 {
        match self.desc.layers {
            1 => 0,
            layers => (1 << layers) - 1,
        }
    }

    /// Room for what they hold.
    fn readbacks(&self) -> [rara_gpu::Buffer; 2] {
        ["color_readback", "second_readback"].map(|name| {
            let desc = rara_gpu::BufferDesc {
                name,
                size: 16 * self.pixels() as u64,
                location: rara::gpu::Location::Readback,
            };
            self.device.create_buffer(&desc).expect("memory")
        })
    }

    fn read(&self, buffers: &[rara_gpu::Buffer; 2]) -> [Vec<[f32; 4]>; 2] {
        let colors = self.colors();
        [0, 1].map(|at| {
            let format = colors[at].map(|image| image.format);
            let bytes = buffers[at].mapped();
            format.map_or(Vec::new(), |format| decoded(format, bytes, self.pixels()))
        })
    }

    /// # Safety
    /// `cmd` is recording.
    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        scopes: &mut [Scope<'_>],
        colors: &[Option<&Image>; 2],
        readbacks: &[rara_gpu::Buffer; 2],
    ) {
        let undefined = vk::ImageLayout::UNDEFINED;
        let drawn = [
            Some(&self.color),
            self.resolved.as_ref(),
            self.second.as_ref(),
        ];
        // SAFETY: the caller vouches for `cmd`; images, views and buffers are alive.
        unsafe {
            for image in drawn.into_iter().flatten() {
                self.turn(cmd, image, undefined, COLOR);
            }
            for depth in self.depth.iter().chain(&self.resolved_depth) {
                self.turn(cmd, depth, undefined, DEPTH);
                self.paint_depth(cmd, depth);
                self.turn(cmd, depth, DEPTH, COPIED);
            }
            for (number, (before, inside)) in scopes.iter_mut().enumerate() {
                before(cmd);
                if let Some(depth) = &self.depth {
                    self.turn(cmd, depth, COPIED, DEPTH);
                }
                self.begin(cmd, number == 0);
                inside(cmd);
                if self.desc.render_pass {
                    self.raw.cmd_end_render_pass(cmd);
                } else {
                    self.raw.cmd_end_rendering(cmd);
                }
                self.turn(cmd, &self.color, COLOR, COLOR);
                if let Some(depth) = &self.depth {
                    self.turn(cmd, depth, DEPTH, COPIED);
                }
            }
            for (image, buffer) in colors.iter().zip(readbacks) {
                let Some(image) = image else { continue };
                self.turn(cmd, image, COLOR, COPIED);
                self.copy_for_host(cmd, (image.raw, vk::ImageAspectFlags::COLOR), buffer);
            }
        }
    }

    /// Copies an image to where the host reads it after the submission.
    ///
    /// # Safety
    /// `cmd` is recording, and the image is ready to be copied.
    unsafe fn copy_for_host(
        &self,
        cmd: vk::CommandBuffer,
        (image, aspect): (vk::Image, vk::ImageAspectFlags),
        to: &rara_gpu::Buffer,
    ) {
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(aspect)
            .layer_count(self.desc.layers);
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(self.desc.extent.into());
        let visible = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let info = vk::DependencyInfo::default().memory_barriers(&visible);
        // SAFETY: the caller vouches for `cmd` and the image; the buffer is alive.
        unsafe {
            self.raw
                .cmd_copy_image_to_buffer(cmd, image, COPIED, to.handle(), &[region]);
            self.raw.cmd_pipeline_barrier2(cmd, &info);
        }
    }
}

impl Drop for Canvas {
    fn drop(&mut self) {
        let images = [
            self.resolved.as_ref(),
            self.second.as_ref(),
            self.depth.as_ref(),
            self.resolved_depth.as_ref(),
        ];
        // SAFETY: each frame was waited for; null handles are ignored.
        unsafe {
            self.raw.destroy_framebuffer(self.framebuffer, None);
            self.raw.destroy_render_pass(self.render_pass, None);
            for image in images.into_iter().flatten().chain([&self.color]) {
                self.raw.destroy_image_view(image.view, None);
                self.raw.destroy_image(image.raw, None);
                self.raw.free_memory(image.memory, None);
            }
        }
    }
}
