//! An engine in raw calls of an older age: classic render passes, barriers and submissions of 1.0, and all memory from
//! one `gpu-allocator`, which it lends. Its pictures are the headless ones, byte for byte, in Vulkan 1.3 and in 1.2,
//! where the layer checks that no newer function is called.

use std::cell::RefCell;
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex};

use crate::common;
use crate::host::validation::{self, Messages, Messenger};
use rara::ash::{Device, Entry, Instance, vk};
use rara::gpu::{self, AdoptDesc, Support, Target};
use rara::gpu_allocator::vulkan::{
    Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc,
};
use rara::gpu_allocator::{AllocationSizes, AllocatorDebugSettings, MemoryLocation};
use rara::scene::{Kind, generate};
use rara::{ClipOp, Picture, Raster, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const EXTENT: vk::Extent2D = vk::Extent2D {
    width: 151,
    height: 97,
};
const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

struct Host {
    version: u32,
    instance: Instance,
    messenger: Option<Messenger>,
    messages: Box<Messages>,
    physical_device: vk::PhysicalDevice,
    support: Support,
    device: Device,
    queue: vk::Queue,
    allocator: Arc<Mutex<Allocator>>,
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    image: (vk::Image, vk::ImageView, Allocation),
    readback: (vk::Buffer, Allocation),
    render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    /// Keeps the loader's library open, also after a panic: a layer's threads may still be in it.
    _entry: ManuallyDrop<Entry>,
}

impl Host {
    /// # Safety
    /// Everything made here is alive until [`Host::close`].
    unsafe fn new(version: u32) -> Self {
        // SAFETY: every handle is used while it is alive, and what is pointed to outlives the calls.
        unsafe {
            let entry = Entry::load().expect("a Vulkan loader");
            let messages = Box::new(Messages::default());
            let made = validation::instance(&entry, version, true, &messages);
            let (instance, messenger) =
                made.expect("the validation layer (tools/test installs it)");
            let part = std::env::var("RARA_TEST_DEVICE").unwrap_or_default();
            let (physical_device, support) = instance
                .enumerate_physical_devices()
                .expect("devices")
                .into_iter()
                .filter(|physical| {
                    let properties = instance.get_physical_device_properties(*physical);
                    let name = properties.device_name_as_c_str().unwrap_or(c"?");
                    let name = name.to_string_lossy().to_lowercase();
                    name.contains(&part.to_lowercase())
                })
                .find_map(|physical| {
                    Some((physical, gpu::check(&instance, physical, version).ok()?))
                })
                .expect("a device that draws splats");
            assert_eq!(support.api_version, version);
            let extensions: Vec<_> = support.extensions().iter().map(|e| e.as_ptr()).collect();
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(support.queue_family)
                .queue_priorities(&[1.0])];
            let core = vk::PhysicalDeviceFeatures::default()
                .pipeline_statistics_query(support.pipeline_statistics);
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_features(&core)
                .enabled_extension_names(&extensions);
            let mut features = support.features();
            let device = instance
                .create_device(physical_device, &features.chain(info), None)
                .expect("a device");
            let allocator = Allocator::new(&AllocatorCreateDesc {
                instance: instance.clone(),
                device: device.clone(),
                physical_device,
                debug_settings: AllocatorDebugSettings::default(),
                buffer_device_address: true,
                allocation_sizes: AllocationSizes::default(),
            });
            let mut allocator = allocator.expect("an allocator");
            let image = image(&device, &mut allocator);
            let readback = readback(&device, &mut allocator);
            let render_pass = render_pass(&device);
            let views = [image.1];
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(render_pass)
                .attachments(&views)
                .width(EXTENT.width)
                .height(EXTENT.height)
                .layers(1);
            let framebuffer = device.create_framebuffer(&info, None).expect("memory");
            let info =
                vk::CommandPoolCreateInfo::default().queue_family_index(support.queue_family);
            let pool = device.create_command_pool(&info, None).expect("a pool");
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            let cmd = device.allocate_command_buffers(&info).expect("memory")[0];
            Self {
                version,
                queue: device.get_device_queue(support.queue_family, 0),
                instance,
                messenger,
                messages,
                physical_device,
                support,
                device,
                allocator: Arc::new(Mutex::new(allocator)),
                pool,
                cmd,
                image,
                readback,
                render_pass,
                framebuffer,
                _entry: ManuallyDrop::new(entry),
            }
        }
    }

    fn lend(&self) -> AdoptDesc {
        AdoptDesc::new(
            self.version,
            self.instance.clone(),
            self.physical_device,
            self.device.clone(),
            (self.queue, self.support.queue_family),
        )
        .mesh_shader(self.support.mesh_shader)
        .push_descriptor(self.support.push_descriptor)
        .debug_utils(true)
        .pipeline_statistics(self.support.pipeline_statistics)
        .allocator(Some(self.allocator.clone()))
    }

    /// # Safety
    /// What `before` and `inside` record lives until this returns.
    unsafe fn frame(
        &mut self,
        before: impl FnOnce(vk::CommandBuffer),
        inside: impl FnOnce(vk::CommandBuffer),
    ) -> Picture {
        let (device, cmd) = (&self.device, self.cmd);
        let clear = [vk::ClearValue::default()];
        let pass = vk::RenderPassBeginInfo::default()
            .render_pass(self.render_pass)
            .framebuffer(self.framebuffer)
            .render_area(EXTENT.into())
            .clear_values(&clear);
        let viewport = vk::Viewport {
            width: EXTENT.width as f32,
            height: EXTENT.height as f32,
            max_depth: 1.0,
            ..vk::Viewport::default()
        };
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(EXTENT.into());
        let readable = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ)];
        let commands = [cmd];
        let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
        // SAFETY: the command buffer is idle, as each frame is waited for; handles are alive.
        unsafe {
            let reset = vk::CommandPoolResetFlags::empty();
            device.reset_command_pool(self.pool, reset).expect("resets");
            let begin = vk::CommandBufferBeginInfo::default()
                .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            device.begin_command_buffer(cmd, &begin).expect("begins");
            before(cmd);
            device.cmd_begin_render_pass(cmd, &pass, vk::SubpassContents::INLINE);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[EXTENT.into()]);
            inside(cmd);
            device.cmd_end_render_pass(cmd);
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            let to = self.readback.0;
            device.cmd_copy_image_to_buffer(cmd, self.image.0, layout, to, &[region]);
            device.cmd_pipeline_barrier(
                cmd,
                vk::PipelineStageFlags::TRANSFER,
                vk::PipelineStageFlags::HOST,
                vk::DependencyFlags::empty(),
                &readable,
                &[],
                &[],
            );
            device.end_command_buffer(cmd).expect("ends");
            let fence = vk::Fence::null();
            let submitted = device.queue_submit(self.queue, &submit, fence);
            submitted.expect("submits");
            device.queue_wait_idle(self.queue).expect("waits");
        }
        let bytes = self.readback.1.mapped_slice().expect("mapped");
        let floats: &[f32] = bytemuck::cast_slice(&bytes[..readback_size() as usize]);
        let mut picture = Picture::filled(EXTENT.width, EXTENT.height, [0.0; 4]);
        picture.pixels.copy_from_slice(bytemuck::cast_slice(floats));
        picture
    }

    /// # Safety
    /// Of all that was made from the device only what `new` has made is still alive.
    unsafe fn close(self) -> Vec<String> {
        let device = &self.device;
        // SAFETY: frames are waited for, and each handle is destroyed once, before what it was made from.
        unsafe {
            device.destroy_command_pool(self.pool, None);
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.render_pass, None);
            device.destroy_image_view(self.image.1, None);
            device.destroy_image(self.image.0, None);
            device.destroy_buffer(self.readback.0, None);
            let allocator = Arc::into_inner(self.allocator).expect("rara has given it back");
            let mut allocator = allocator.into_inner().expect("nobody has panicked");
            allocator.free(self.image.2).expect("its own");
            allocator.free(self.readback.1).expect("its own");
            let left = allocator.generate_report().allocations;
            assert!(left.is_empty(), "{left:?}");
            drop(allocator);
            device.destroy_device(None);
            if let Some((loader, messenger)) = &self.messenger {
                loader.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
        self.messages.into_inner().expect("nobody has panicked")
    }
}

/// # Safety
/// The device is alive, and the allocator its own.
unsafe fn image(
    device: &Device,
    allocator: &mut Allocator,
) -> (vk::Image, vk::ImageView, Allocation) {
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(FORMAT)
        .extent(EXTENT.into())
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
    // SAFETY: the caller vouches for the device; the rest is made here.
    unsafe {
        let image = device.create_image(&info, None).expect("an image");
        let memory = allocator.allocate(&AllocationCreateDesc {
            name: "host's target",
            requirements: device.get_image_memory_requirements(image),
            location: MemoryLocation::GpuOnly,
            linear: false,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        let memory = memory.expect("memory");
        let bound = device.bind_image_memory(image, memory.memory(), memory.offset());
        bound.expect("binds");
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(FORMAT)
            .subresource_range(WHOLE);
        let view = device.create_image_view(&info, None).expect("a view");
        (image, view, memory)
    }
}

fn readback_size() -> u64 {
    u64::from(EXTENT.width) * u64::from(EXTENT.height) * 16
}

/// # Safety
/// As for [`image`].
unsafe fn readback(device: &Device, allocator: &mut Allocator) -> (vk::Buffer, Allocation) {
    let info = vk::BufferCreateInfo::default()
        .size(readback_size())
        .usage(vk::BufferUsageFlags::TRANSFER_DST);
    // SAFETY: the caller vouches for the device; the rest is made here.
    unsafe {
        let buffer = device.create_buffer(&info, None).expect("a buffer");
        let memory = allocator.allocate(&AllocationCreateDesc {
            name: "host's readback",
            requirements: device.get_buffer_memory_requirements(buffer),
            location: MemoryLocation::GpuToCpu,
            linear: true,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        let memory = memory.expect("memory");
        let bound = device.bind_buffer_memory(buffer, memory.memory(), memory.offset());
        bound.expect("binds");
        (buffer, memory)
    }
}

/// # Safety
/// The device is alive.
unsafe fn render_pass(device: &Device) -> vk::RenderPass {
    let attachments = [vk::AttachmentDescription::default()
        .format(FORMAT)
        .samples(vk::SampleCountFlags::TYPE_1)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::STORE)
        .final_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL)];
    let colors = [vk::AttachmentReference {
        attachment: 0,
        layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
    }];
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colors)];
    let copied = [vk::SubpassDependency {
        src_subpass: 0,
        dst_subpass: vk::SUBPASS_EXTERNAL,
        src_stage_mask: vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
        dst_stage_mask: vk::PipelineStageFlags::TRANSFER,
        src_access_mask: vk::AccessFlags::COLOR_ATTACHMENT_WRITE,
        dst_access_mask: vk::AccessFlags::TRANSFER_READ,
        dependency_flags: vk::DependencyFlags::empty(),
    }];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&copied);
    // SAFETY: the caller vouches for the device.
    unsafe { device.create_render_pass(&info, None) }.expect("a render pass")
}

#[test]
fn in_vulkan_1_3_the_pictures_are_the_headless_ones() {
    check(vk::API_VERSION_1_3);
}

#[test]
fn in_vulkan_1_2_the_pictures_are_the_headless_ones() {
    check(vk::API_VERSION_1_2);
}

fn check(version: u32) {
    let scene = generate(Kind::General, 3_000, 5);
    let camera = common::views(&scene, 1, (EXTENT.width, EXTENT.height))[0];
    // SAFETY: everything made from the host goes before it.
    let mut host = unsafe { Host::new(version) };
    // SAFETY: as above.
    let device = unsafe { gpu::Device::adopt(host.lend()) }.expect("draws splats");
    let mut rasters = vec![Raster::Tiles, Raster::Quad];
    if device.support().mesh_shader {
        rasters.push(Raster::Mesh);
    }
    let buffers = SceneBuffers::upload(&device, &scene, ShFormat::Float).expect("uploads");
    let names = |host: &Host| -> Vec<String> {
        let report = host.allocator.lock().expect("ours").generate_report();
        report.allocations.into_iter().map(|a| a.name).collect()
    };
    assert!(names(&host).iter().any(|name| name == "host's target"));
    let ours = device.memory_by_name();
    assert!(!ours.is_empty() && ours.iter().all(|part| names(&host).contains(&part.name)));
    assert!(ours.iter().all(|part| !part.name.starts_with("host's")));

    for bindings in common::bindings(&device) {
        // The two paths are compiled from other modules: pictures of one path agree to the bit, those of two to 2e-5 of
        // 255.
        let mut headless = common::headless_by(bindings);
        headless.load(&scene).expect("uploads");
        // Slow drivers, which compile for seconds, get only the last.
        let few = if common::scale() < 1.0 { 2 } else { 0 };
        let clips = |raster: &Raster| {
            [0, 1, 3]
                .map(|planes| (*raster, planes))
                .into_iter()
                .skip(few)
        };
        for (raster, planes) in rasters.iter().flat_map(clips) {
            let clip = common::clip(&scene, planes, ClipOp::And);
            let settings = Settings::default().raster(raster);
            headless.render(&camera, &clip, &settings).expect("renders");
            let truth = headless.picture().expect("reads back");
            let desc = RendererDesc::new(FORMAT)
                .bindings(bindings)
                .timing(true)
                .statistics(true)
                // SAFETY: the render pass outlives the renderer.
                .target(unsafe { Target::render_pass(host.render_pass, 0) });
            let mut renderer = Renderer::new(&device, desc).expect("a renderer");
            let configured = renderer.configure(&buffers, &camera, &clip, &settings);
            configured.expect("configures");
            let renderer = RefCell::new(renderer);
            // SAFETY: the frame is waited for before renderer and scene are dropped; `cmd` is where each call needs it.
            let picture = unsafe {
                host.frame(
                    |cmd| {
                        renderer
                            .borrow_mut()
                            .prepare(cmd, &buffers)
                            .expect("prepares")
                    },
                    |cmd| renderer.borrow_mut().draw(cmd, [0.0, 0.0]).expect("draws"),
                )
            };
            let times = renderer.borrow_mut().pass_times();
            assert!(!times.is_empty() || device.support().timestamp_period == 0.0);
            let statistics = renderer.borrow_mut().pass_statistics();
            assert_eq!(statistics.is_empty(), !device.support().pipeline_statistics);
            assert!(
                picture == truth,
                "{raster:?}, {bindings:?}, {planes} planes: not the headless picture"
            );
        }
    }
    drop((buffers, device));
    // SAFETY: everything of rara's is dropped.
    assert_eq!(unsafe { host.close() }, Vec::<String>::new());
}
