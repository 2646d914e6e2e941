//! A canvas that a host draws into, for the tests of depth, formats and views: attachments of any format, in dynamic
//! rendering or a classic render pass, with rectangles in the depth buffer for opaque meshes.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

use crate::host::{Host, HostDesc};
use rara::ash::{self, vk};
use rara::gpu::{AdoptDesc, DepthImage, Device};

/// Runs a test with a host and its device, under validation; `optional` enables the device's optional features.
pub fn with_host(optional: bool, test: impl FnOnce(&Host, &Device)) {
    let device = std::env::var("RARA_TEST_DEVICE").ok();
    let host = Host::new(&HostDesc {
        device: device.as_deref(),
        validation: true,
        optional,
        extent: vk::Extent2D {
            width: 1,
            height: 1,
        },
        format: vk::Format::R8G8B8A8_UNORM,
    });
    let host = host.expect("a Vulkan device and the validation layer (tools/test installs both)");
    // SAFETY: the handles belong together; everything made from the device is dropped in `test`.
    let device = unsafe { Device::adopt(host.lend()) }.expect("the host's device draws splats");
    test(&host, &device);
    assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}

pub struct CanvasDesc {
    pub extent: vk::Extent2D,
    pub color: vk::Format,
    /// `UNDEFINED` for none.
    pub second: vk::Format,
    /// `UNDEFINED` for none.
    pub depth: vk::Format,
    pub samples: vk::SampleCountFlags,
    pub render_pass: bool,
    /// The colour before anything is drawn.
    pub clear: [f32; 4],
    /// What the depth buffer holds where there is no mesh.
    pub far: f32,
    /// Meshes that face the camera: their places, and what the depth buffer holds there.
    pub meshes: Vec<(vk::Rect2D, f32)>,
}

impl CanvasDesc {
    pub fn new((width, height): (u32, u32), color: vk::Format) -> Self {
        Self {
            extent: vk::Extent2D { width, height },
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
    render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
}

/// A function that records before a scope, and one that records inside it.
pub type Scope<'a> = (
    &'a mut dyn FnMut(vk::CommandBuffer),
    &'a mut dyn FnMut(vk::CommandBuffer),
);

struct Image {
    raw: vk::Image,
    view: vk::ImageView,
    memory: vk::DeviceMemory,
    format: vk::Format,
}

const COLOR: vk::ImageLayout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
const DEPTH: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
const COPIED: vk::ImageLayout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
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
            render_pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
            desc,
        };
        let one = vk::SampleCountFlags::TYPE_1;
        let d = &canvas.desc;
        let (as_color, as_depth) = (
            vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
            vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
        );
        let color = canvas.image(d.color, as_color, d.samples);
        let resolved = (d.samples != one).then(|| canvas.image(d.color, as_color, one));
        let second = (d.second != UNDEFINED).then(|| canvas.image(d.second, as_color, d.samples));
        let depth = (d.depth != UNDEFINED).then(|| canvas.image(d.depth, as_depth, d.samples));
        (canvas.color, canvas.resolved) = (color, resolved);
        (canvas.second, canvas.depth) = (second, depth);
        if canvas.desc.render_pass {
            canvas.make_render_pass();
        }
        canvas
    }

    /// The canvas's render pass, or null if it has none.
    pub fn render_pass(&self) -> vk::RenderPass {
        self.render_pass
    }

    /// The depth buffer as `prepare_behind` takes it, for a viewport that begins at (x, y).
    pub fn depth_image(&self, x: i32, y: i32) -> DepthImage {
        DepthImage {
            image: self.depth.as_ref().expect("a depth buffer").raw,
            layout: COPIED,
            extent: self.desc.extent,
            layer: 0,
            origin: vk::Offset2D { x, y },
        }
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
        let pixels = u64::from(self.desc.extent.width) * u64::from(self.desc.extent.height);
        let colors = [
            self.resolved.as_ref().or(Some(&self.color)),
            self.second.as_ref(),
        ];
        let buffer = |name| {
            let location = rara::gpu::Location::Readback;
            let desc = rara::gpu::BufferDesc {
                name,
                size: pixels * 16,
                location,
            };
            self.device.create_buffer(&desc).expect("memory")
        };
        let readbacks = ["color_readback", "second_readback"].map(buffer);
        let submitted = self.device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording, and everything that it uses outlives the wait.
            unsafe { self.record(cmd, scopes, &colors, &readbacks) };
            Ok(())
        });
        submitted.expect("submits");
        let read = |(image, buffer): (&Option<&Image>, &rara::gpu::Buffer)| {
            let image = image.as_ref();
            image.map_or(Vec::new(), |i| {
                decoded(i.format, buffer.mapped(), pixels as usize)
            })
        };
        let mut pictures = colors.iter().zip(&readbacks).map(read);
        [0, 1].map(|_| pictures.next().expect("two"))
    }

    /// # Safety
    /// `cmd` is recording.
    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        scopes: &mut [Scope<'_>],
        colors: &[Option<&Image>; 2],
        readbacks: &[rara::gpu::Buffer; 2],
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
            if let Some(depth) = &self.depth {
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
                let region = vk::BufferImageCopy::default()
                    .image_subresource(
                        vk::ImageSubresourceLayers::default()
                            .aspect_mask(vk::ImageAspectFlags::COLOR)
                            .layer_count(1),
                    )
                    .image_extent(self.desc.extent.into());
                let to = buffer.handle();
                self.raw
                    .cmd_copy_image_to_buffer(cmd, image.raw, COPIED, to, &[region]);
            }
            let visible = [vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::HOST)
                .dst_access_mask(vk::AccessFlags2::HOST_READ)];
            let info = vk::DependencyInfo::default().memory_barriers(&visible);
            self.raw.cmd_pipeline_barrier2(cmd, &info);
        }
    }

    /// # Safety
    /// `cmd` is recording outside a scope.
    unsafe fn paint_depth(&self, cmd: vk::CommandBuffer, depth: &Image) {
        let value = |depth| vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 },
        };
        let attachment = vk::RenderingAttachmentInfo::default()
            .image_view(depth.view)
            .image_layout(DEPTH)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(value(self.desc.far));
        let info = vk::RenderingInfo::default()
            .render_area(self.desc.extent.into())
            .layer_count(1)
            .depth_attachment(&attachment);
        // SAFETY: the caller vouches for `cmd`.
        unsafe {
            self.raw.cmd_begin_rendering(cmd, &info);
            for (rect, depth) in &self.desc.meshes {
                let clear = vk::ClearAttachment {
                    aspect_mask: vk::ImageAspectFlags::DEPTH,
                    color_attachment: 0,
                    clear_value: value(*depth),
                };
                let area = vk::ClearRect {
                    rect: *rect,
                    base_array_layer: 0,
                    layer_count: 1,
                };
                self.raw.cmd_clear_attachments(cmd, &[clear], &[area]);
            }
            self.raw.cmd_end_rendering(cmd);
        }
    }

    /// # Safety
    /// `cmd` is recording outside a scope.
    unsafe fn begin(&self, cmd: vk::CommandBuffer, clears: bool) {
        let colour = |float32| vk::ClearValue {
            color: vk::ClearColorValue { float32 },
        };
        let (first, second) = (colour(self.desc.clear), colour([0.0; 4]));
        if self.desc.render_pass {
            let mut clears = vec![first];
            clears.extend(self.second.as_ref().map(|_| second));
            let info = vk::RenderPassBeginInfo::default()
                .render_pass(self.render_pass)
                .framebuffer(self.framebuffer)
                .render_area(self.desc.extent.into())
                .clear_values(&clears);
            let contents = vk::SubpassContents::INLINE;
            // SAFETY: the caller vouches for `cmd`.
            unsafe { self.raw.cmd_begin_render_pass(cmd, &info, contents) };
            return;
        }
        let load = if clears {
            vk::AttachmentLoadOp::CLEAR
        } else {
            vk::AttachmentLoadOp::LOAD
        };
        let attach = |image: &Image, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view)
                .image_layout(COLOR)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let mut colors = vec![attach(&self.color, first)];
        if let Some(resolved) = &self.resolved {
            colors[0] = colors[0]
                .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                .resolve_image_view(resolved.view)
                .resolve_image_layout(COLOR);
        }
        colors.extend(self.second.as_ref().map(|image| attach(image, second)));
        let mut info = vk::RenderingInfo::default()
            .render_area(self.desc.extent.into())
            .layer_count(1)
            .color_attachments(&colors);
        let depth = self.depth.as_ref().map(|depth| {
            vk::RenderingAttachmentInfo::default()
                .image_view(depth.view)
                .image_layout(DEPTH)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)
        });
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.raw.cmd_begin_rendering(cmd, &info) };
    }

    fn make_render_pass(&mut self) {
        let one = self.desc.samples == vk::SampleCountFlags::TYPE_1;
        assert!(
            one && self.second.is_none(),
            "only simple render passes here"
        );
        let attachment = |image: &Image, load, layout| {
            vk::AttachmentDescription::default()
                .format(image.format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
                .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
                .initial_layout(layout)
                .final_layout(layout)
        };
        let mut descriptions = vec![attachment(&self.color, vk::AttachmentLoadOp::CLEAR, COLOR)];
        let mut views = vec![self.color.view];
        if let Some(depth) = &self.depth {
            descriptions.push(attachment(depth, vk::AttachmentLoadOp::LOAD, DEPTH));
            views.push(depth.view);
        }
        let reference = |attachment, layout| vk::AttachmentReference { attachment, layout };
        let colors = [reference(0, COLOR)];
        let depth = reference(1, DEPTH);
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colors);
        if self.depth.is_some() {
            subpass = subpass.depth_stencil_attachment(&depth);
        }
        let subpasses = [subpass];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&descriptions)
            .subpasses(&subpasses);
        // SAFETY: the device is alive, and everything pointed to outlives the calls.
        unsafe {
            self.render_pass = self.raw.create_render_pass(&info, None).expect("a pass");
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(self.render_pass)
                .attachments(&views)
                .width(self.desc.extent.width)
                .height(self.desc.extent.height)
                .layers(1);
            self.framebuffer = self.raw.create_framebuffer(&info, None).expect("memory");
        }
    }

    fn image(
        &self,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
        samples: vk::SampleCountFlags,
    ) -> Image {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(self.desc.extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .usage(usage);
        // SAFETY: the device is alive, and everything pointed to outlives the calls.
        unsafe {
            let raw = self.raw.create_image(&info, None).expect("an image");
            let needs = self.raw.get_image_memory_requirements(raw);
            let offered = self
                .instance
                .get_physical_device_memory_properties(self.physical);
            let fits = |(i, memory): (usize, &vk::MemoryType)| {
                let local = vk::MemoryPropertyFlags::DEVICE_LOCAL;
                needs.memory_type_bits & (1 << i) != 0 && memory.property_flags.contains(local)
            };
            let mut types = offered.memory_types_as_slice().iter().enumerate();
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(types.position(fits).expect("local memory") as u32);
            let memory = self.raw.allocate_memory(&info, None).expect("memory");
            let bound = self.raw.bind_image_memory(raw, memory, 0);
            bound.expect("binds");
            let info = vk::ImageViewCreateInfo::default()
                .image(raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(whole(format));
            let view = self.raw.create_image_view(&info, None).expect("a view");
            Image {
                raw,
                view,
                memory,
                format,
            }
        }
    }

    /// Moves an image from one layout to another, after and before all other commands.
    ///
    /// # Safety
    /// `cmd` is recording outside a scope.
    unsafe fn turn(
        &self,
        cmd: vk::CommandBuffer,
        image: &Image,
        old: vk::ImageLayout,
        new: vk::ImageLayout,
    ) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let access = |layout| match layout {
            COLOR => {
                vk::AccessFlags2::COLOR_ATTACHMENT_READ | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE
            }
            DEPTH => {
                vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ
                    | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE
            }
            COPIED => vk::AccessFlags2::TRANSFER_READ,
            _ => vk::AccessFlags2::NONE,
        };
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(access(old))
            .dst_stage_mask(all)
            .dst_access_mask(access(new))
            .old_layout(old)
            .new_layout(new)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image.raw)
            .subresource_range(whole(image.format))];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.raw.cmd_pipeline_barrier2(cmd, &info) };
    }
}

impl Image {
    fn none() -> Self {
        Self {
            raw: vk::Image::null(),
            view: vk::ImageView::null(),
            memory: vk::DeviceMemory::null(),
            format: UNDEFINED,
        }
    }
}

impl Drop for Canvas {
    fn drop(&mut self) {
        let images = [
            self.resolved.as_ref(),
            self.second.as_ref(),
            self.depth.as_ref(),
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

fn whole(format: vk::Format) -> vk::ImageSubresourceRange {
    let aspect = match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT | vk::Format::X8_D24_UNORM_PACK32 => {
            vk::ImageAspectFlags::DEPTH
        }
        vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        _ => vk::ImageAspectFlags::COLOR,
    };
    vk::ImageSubresourceRange::default()
        .aspect_mask(aspect)
        .level_count(1)
        .layer_count(1)
}

/// Pixels as linear numbers; channels that a format lacks are 0.
fn decoded(format: vk::Format, bytes: &[u8], pixels: usize) -> Vec<[f32; 4]> {
    let (channels, size) = match format {
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => (4, 1),
        vk::Format::R16G16_SFLOAT => (2, 2),
        vk::Format::R16G16B16A16_SFLOAT => (4, 2),
        vk::Format::R32G32_SFLOAT => (2, 4),
        vk::Format::R32G32B32A32_SFLOAT => (4, 4),
        other => panic!("this canvas cannot be read in {other:?}"),
    };
    let is_srgb = format == vk::Format::R8G8B8A8_SRGB;
    let linear = |v: f32| match v {
        v if v <= 0.040_45 => v / 12.92,
        v => ((v + 0.055) / 1.055).powf(2.4),
    };
    let channel = |pixel: &[u8], i: usize| match size {
        _ if i >= channels => 0.0,
        1 if is_srgb && i < 3 => linear(f32::from(pixel[i]) / 255.0),
        1 => f32::from(pixel[i]) / 255.0,
        2 => half(u16::from_le_bytes([pixel[2 * i], pixel[2 * i + 1]])),
        _ => f32::from_le_bytes(pixel[4 * i..][..4].try_into().expect("four bytes")),
    };
    let pixels = bytes.chunks_exact(channels * size).take(pixels);
    pixels
        .map(|p| [0, 1, 2, 3].map(|i| channel(p, i)))
        .collect()
}

/// A half-precision number.
fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    sign * match exponent {
        0 => mantissa * 2.0_f32.powi(-24),
        _ => (1024.0 + mantissa) * 2.0_f32.powi(exponent - 25),
    }
}
