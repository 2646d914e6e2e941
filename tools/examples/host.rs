//! A small engine that knows nothing of splats: its own instance, device, queue and targets, two frames in flight. It
//! paints stripes of its own into its targets, so that what draws afterwards draws onto something.

#[path = "slot.rs"]
mod slot;
#[path = "validation.rs"]
pub(crate) mod validation;

use rara::ash::{Device, Entry, Instance, vk};
use rara::gpu::{self, AdoptDesc, Support};
use rara::{Error, Result};
use slot::Slot;
use validation::{Messages, Messenger};

/// Frames that the host records before it waits for the oldest.
pub(crate) const FRAMES: usize = 2;

/// The version of Vulkan that its instance is created for.
const VERSION: u32 = vk::API_VERSION_1_3;

/// A description of a host.
pub(crate) struct HostDesc<'a> {
    /// Part of the device's name; `None` is the first that can draw splats.
    pub(crate) device: Option<&'a str>,
    /// Load the Khronos validation layer with checks of synchronisation and best practices.
    pub(crate) validation: bool,
    /// Enable what is optional: mesh shaders, push descriptors, pipeline statistics, several views a scope.
    pub(crate) optional: bool,
    /// Size of the targets.
    pub(crate) extent: vk::Extent2D,
    /// Format of the targets: RGBA in 8 bits, halves or floats.
    pub(crate) format: vk::Format,
}

pub(crate) struct Host {
    instance: Instance,
    messenger: Option<Messenger>,
    messages: Box<Messages>,
    physical_device: vk::PhysicalDevice,
    support: Support,
    device: Device,
    queue: vk::Queue,
    pipeline_cache: vk::PipelineCache,
    extent: vk::Extent2D,
    format: vk::Format,
    slots: Vec<Slot>,
    /// Frames submitted so far.
    submitted: usize,
    /// Keeps the loader's library open.
    _entry: Entry,
}

/// Width of the host's stripes, px.
const STRIPE: u32 = 16;

impl Host {
    pub(crate) fn new(desc: &HostDesc<'_>) -> Result<Self> {
        // SAFETY: the system's Vulkan loader has no initialisation that could break the process; from here on every
        // handle is used while it is alive, and what is pointed to outlives the calls.
        unsafe {
            let entry = Entry::load().map_err(|error| Error::Device(error.to_string()))?;
            let messages = Box::new(Messages::default());
            let (instance, messenger) =
                validation::instance(&entry, VERSION, desc.validation, &messages)?;

            let (physical_device, mut support) =
                choose(&instance, VERSION, desc.device.unwrap_or_default())?;
            support.mesh_shader &= desc.optional;
            support.push_descriptor &= desc.optional;
            support.pipeline_statistics &= desc.optional;
            let counts = vk::PhysicalDeviceFeatures::default()
                .pipeline_statistics_query(support.pipeline_statistics);
            let extensions: Vec<_> = support.extensions().iter().map(|e| e.as_ptr()).collect();
            let mut features = support.features();
            // For hosts that draw the eyes of one image together.
            let mut views = vk::PhysicalDeviceMultiviewFeatures::default().multiview(desc.optional);
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(support.queue_family)
                .queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&extensions)
                .enabled_features(&counts)
                .push_next(&mut views);
            let device = instance
                .create_device(physical_device, &features.chain(info), None)
                .map_err(rara_gpu::failed("vkCreateDevice"))?;

            let pipeline_cache = device
                .create_pipeline_cache(&vk::PipelineCacheCreateInfo::default(), None)
                .map_err(rara_gpu::failed("vkCreatePipelineCache"))?;
            let mut host = Self {
                queue: device.get_device_queue(support.queue_family, 0),
                instance,
                messenger,
                messages,
                physical_device,
                support,
                device,
                pipeline_cache,
                extent: desc.extent,
                format: desc.format,
                slots: Vec::new(),
                submitted: 0,
                _entry: entry,
            };
            for _ in 0..FRAMES {
                host.slots.push(host.slot()?);
            }
            Ok(host)
        }
    }

    /// The handles that [`rara::gpu::Device::adopt`] needs. The host must outlive whatever is made from it.
    pub(crate) fn lend(&self) -> AdoptDesc {
        AdoptDesc::new(
            VERSION,
            self.instance.clone(),
            self.physical_device,
            self.device.clone(),
            (self.queue, self.support.queue_family),
        )
        .mesh_shader(self.support.mesh_shader)
        .push_descriptor(self.support.push_descriptor)
        .full_subgroups(self.support.full_subgroups[1] > 0)
        .debug_utils(self.messenger.is_some())
        .pipeline_statistics(self.support.pipeline_statistics)
        .pipeline_cache(self.pipeline_cache)
    }

    /// Waits until the frame `FRAMES` ago is done, so that what it used may be used again. Returns its picture, if there
    /// was such a frame.
    pub(crate) fn wait(&mut self) -> Result<Option<Vec<[f32; 4]>>> {
        if self.submitted < FRAMES {
            return Ok(None);
        }
        self.picture_of(self.submitted - FRAMES).map(Some)
    }

    /// Waits for the last frame and returns its picture.
    pub(crate) fn wait_for_all(&mut self) -> Result<Vec<[f32; 4]>> {
        self.picture_of(self.submitted - 1)
    }

    /// Begins a frame's commands.
    pub(crate) fn begin(&mut self) -> Result<vk::CommandBuffer> {
        let slot = &self.slots[self.submitted % FRAMES];
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: `wait` waited for the slot's last frame.
        unsafe {
            self.device
                .reset_command_pool(slot.pool, vk::CommandPoolResetFlags::empty())
                .map_err(rara_gpu::failed("vkResetCommandPool"))?;
            self.device
                .begin_command_buffer(slot.cmd, &info)
                .map_err(rara_gpu::failed("vkBeginCommandBuffer"))?;
        }
        Ok(slot.cmd)
    }

    /// Begins rendering and paints the stripes; viewport and scissor are `area`.
    pub(crate) fn begin_rendering(&mut self, area: vk::Rect2D) {
        let slot = &self.slots[self.submitted % FRAMES];
        self.layout(
            slot,
            (vk::ImageLayout::UNDEFINED, vk::AccessFlags2::TRANSFER_READ),
            (
                vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
                vk::AccessFlags2::COLOR_ATTACHMENT_READ | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
            ),
        );
        let colour = |x: u32| vk::ClearValue {
            color: vk::ClearColorValue {
                float32: self.backdrop(x),
            },
        };
        let attachments = [vk::RenderingAttachmentInfo::default()
            .image_view(slot.view)
            .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(colour(0))];
        let info = vk::RenderingInfo::default()
            .render_area(self.extent.into())
            .layer_count(1)
            .color_attachments(&attachments);
        let viewport = vk::Viewport {
            x: area.offset.x as f32,
            y: area.offset.y as f32,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: the slot's command buffer is recording, between `begin` and `submit`.
        unsafe {
            self.device.cmd_begin_rendering(slot.cmd, &info);
            for x in (0..self.extent.width).step_by(STRIPE as usize) {
                let stripe = [vk::ClearAttachment {
                    aspect_mask: vk::ImageAspectFlags::COLOR,
                    color_attachment: 0,
                    clear_value: colour(x),
                }];
                let rect = [vk::ClearRect {
                    rect: vk::Rect2D {
                        offset: vk::Offset2D { x: x as i32, y: 0 },
                        extent: vk::Extent2D {
                            width: STRIPE.min(self.extent.width - x),
                            height: self.extent.height,
                        },
                    },
                    base_array_layer: 0,
                    layer_count: 1,
                }];
                self.device.cmd_clear_attachments(slot.cmd, &stripe, &rect);
            }
            self.device.cmd_set_viewport(slot.cmd, 0, &[viewport]);
            self.device.cmd_set_scissor(slot.cmd, 0, &[area]);
        }
    }

    /// The colour that the host itself paints into column `x`: opaque, and exact in 8 bits and in half precision.
    pub(crate) fn backdrop(&self, x: u32) -> [f32; 4] {
        let step = (x / STRIPE % 6) as f32;
        [0.2 * step, 1.0 - 0.2 * step, 0.4, 1.0].map(|v| (v * 255.0).round() / 255.0)
    }

    /// Ends rendering, copies the target to where the host can read it, and submits the frame.
    pub(crate) fn submit(&mut self) -> Result<()> {
        let slot = &self.slots[self.submitted % FRAMES];
        // SAFETY: the slot's command buffer is recording inside a rendering scope; its fence was waited for.
        unsafe { self.device.cmd_end_rendering(slot.cmd) };
        self.layout(
            slot,
            (
                vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
                vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
            ),
            (
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                vk::AccessFlags2::TRANSFER_READ,
            ),
        );
        let region = [vk::BufferImageCopy::default()
            .image_subresource(
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .layer_count(1),
            )
            .image_extent(self.extent.into())];
        let visible = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(slot.cmd)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        // SAFETY: as above; image and buffer are the slot's own.
        unsafe {
            self.device.cmd_copy_image_to_buffer(
                slot.cmd,
                slot.image,
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                slot.readback,
                &region,
            );
            let info = vk::DependencyInfo::default().memory_barriers(&visible);
            self.device.cmd_pipeline_barrier2(slot.cmd, &info);
            self.device
                .end_command_buffer(slot.cmd)
                .map_err(rara_gpu::failed("vkEndCommandBuffer"))?;
            self.device
                .reset_fences(&[slot.fence])
                .map_err(rara_gpu::failed("vkResetFences"))?;
            self.device
                .queue_submit2(self.queue, &submit, slot.fence)
                .map_err(rara_gpu::failed("vkQueueSubmit2"))?;
        }
        self.submitted += 1;
        Ok(())
    }

    /// Destroys everything; returns the messages of the validation layer, also about objects that were left alive.
    pub(crate) fn close(self) -> Vec<String> {
        let Self { device, .. } = &self;
        // SAFETY: the device is idle after the first call, and nothing is used afterwards; null handles are ignored.
        unsafe {
            let _ = device.device_wait_idle();
            for slot in &self.slots {
                device.destroy_command_pool(slot.pool, None);
                device.destroy_fence(slot.fence, None);
                device.destroy_image_view(slot.view, None);
                device.destroy_image(slot.image, None);
                device.free_memory(slot.image_memory, None);
                device.destroy_buffer(slot.readback, None);
                device.free_memory(slot.readback_memory, None);
            }
            device.destroy_pipeline_cache(self.pipeline_cache, None);
            device.destroy_device(None);
            if let Some((loader, messenger)) = &self.messenger {
                loader.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
        std::mem::take(&mut self.messages.lock().expect("no holder panics"))
    }
}

/// The first device that can draw splats and has this in its name, and what rara needs of it: that is known before the
/// device is opened, and goes into the host's own creation of it.
///
/// # Safety
/// The instance is alive.
pub(crate) unsafe fn choose(
    instance: &Instance,
    version: u32,
    part: &str,
) -> Result<(vk::PhysicalDevice, Support)> {
    // SAFETY: the caller vouches for the instance, whose own the devices are.
    unsafe {
        let wanted = |physical: &vk::PhysicalDevice| {
            let properties = instance.get_physical_device_properties(*physical);
            let name = properties.device_name_as_c_str().unwrap_or(c"?");
            let name = name.to_string_lossy().to_lowercase();
            name.contains(&part.to_lowercase())
        };
        let devices = instance
            .enumerate_physical_devices()
            .map_err(rara_gpu::failed("vkEnumeratePhysicalDevices"))?;
        devices
            .into_iter()
            .filter(wanted)
            .find_map(|physical| Some((physical, gpu::check(instance, physical, version).ok()?)))
            .ok_or_else(|| Error::Device("no device can draw splats".into()))
    }
}
