//! The engine: its instance, its device, and a frame, which is waited for.

use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex};

use super::EXTENT;
use super::target::{image, readback, readback_size, render_pass};
use crate::canvas::host;
use crate::canvas::host::validation::{self, Messages, Messenger};
use rara::Picture;
use rara::ash::{Device, Entry, Instance, vk};
use rara::gpu::{AdoptDesc, Support};
use rara::gpu_allocator::vulkan::{Allocation, Allocator, AllocatorCreateDesc};
use rara::gpu_allocator::{AllocationSizes, AllocatorDebugSettings};

pub(super) struct Host {
    version: u32,
    instance: Instance,
    messenger: Option<Messenger>,
    messages: Box<Messages>,
    physical_device: vk::PhysicalDevice,
    support: Support,
    device: Device,
    queue: vk::Queue,
    pub(super) allocator: Arc<Mutex<Allocator>>,
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    image: (vk::Image, vk::ImageView, Allocation),
    readback: (vk::Buffer, Allocation),
    pub(super) render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    /// Keeps the loader's library open, also after a panic: a layer's threads may still be in it.
    _entry: ManuallyDrop<Entry>,
}

impl Host {
    /// # Safety
    /// Everything made here is alive until [`Host::close`].
    pub(super) unsafe fn new(version: u32) -> Self {
        // SAFETY: every handle is used while it is alive, and what is pointed to outlives the calls.
        unsafe {
            let entry = Entry::load().expect("a Vulkan loader");
            let messages = Box::new(Messages::default());
            let made = validation::instance(&entry, version, true, &messages);
            let (instance, messenger) =
                made.expect("the validation layer (tools/test installs it)");
            let part = std::env::var("RARA_TEST_DEVICE").unwrap_or_default();
            let chosen = host::choose(&instance, version, &part);
            let (physical_device, support) = chosen.expect("a device that draws splats");
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

    pub(super) fn lend(&self) -> AdoptDesc {
        AdoptDesc::new(
            self.version,
            self.instance.clone(),
            self.physical_device,
            self.device.clone(),
            (self.queue, self.support.queue_family),
        )
        .mesh_shader(self.support.mesh_shader)
        .push_descriptor(self.support.push_descriptor)
        .full_subgroups(self.support.full_subgroups[1] > 0)
        .debug_utils(true)
        .pipeline_statistics(self.support.pipeline_statistics)
        .allocator(Some(self.allocator.clone()))
    }

    /// # Safety
    /// All that `before` and `inside` record with lives until this returns.
    pub(super) unsafe fn frame(
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
        // Upside down, as engines with y up have it. It is not that of the splats.
        let viewport = vk::Viewport {
            y: EXTENT.height as f32,
            width: EXTENT.width as f32,
            height: -(EXTENT.height as f32),
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
    pub(super) unsafe fn close(self) -> Vec<String> {
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
