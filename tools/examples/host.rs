//! A small engine that knows nothing of splats: its own instance, device, queue and targets, two frames in flight. It
//! paints stripes of its own into its targets, so that what draws afterwards draws onto something.

#[path = "validation.rs"]
pub(crate) mod validation;

use rara::ash::{Device, Entry, Instance, vk};
use rara::gpu::{self, AdoptDesc, Support};
use rara::{Error, Result};
use validation::{Messages, Messenger};

/// Frames that the host records before it waits for the oldest.
pub(crate) const FRAMES: usize = 2;

/// What its instance is created for.
const VERSION: u32 = vk::API_VERSION_1_3;

/// What a host is created with.
pub(crate) struct HostDesc<'a> {
    /// Part of the device's name; `None` is the first that can draw splats.
    pub(crate) device: Option<&'a str>,
    /// Load the Khronos validation layer with checks of synchronisation and best practices.
    pub(crate) validation: bool,
    /// Enable what is optional: mesh shaders, push descriptors.
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

/// The part of the host that each frame in flight has to itself.
struct Slot {
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
    image: vk::Image,
    image_memory: vk::DeviceMemory,
    view: vk::ImageView,
    readback: vk::Buffer,
    readback_memory: vk::DeviceMemory,
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Host {
    pub(crate) fn new(desc: &HostDesc<'_>) -> Result<Self> {
        // SAFETY: the system's Vulkan loader has no initialisation that could break the process; from here on every
        // handle is used while it is alive, and what is pointed to outlives the calls.
        unsafe {
            let entry = Entry::load().map_err(|error| Error::Device(error.to_string()))?;
            let messages = Box::new(Messages::default());
            let (instance, messenger) =
                validation::instance(&entry, VERSION, desc.validation, &messages)?;

            // What rara needs of a device is known before there is one, and goes into the host's own creation.
            let wanted = |physical: &vk::PhysicalDevice| {
                let properties = instance.get_physical_device_properties(*physical);
                let name = properties.device_name_as_c_str().unwrap_or(c"?");
                let part = desc.device.unwrap_or_default().to_lowercase();
                name.to_string_lossy().to_lowercase().contains(&part)
            };
            let devices = instance
                .enumerate_physical_devices()
                .map_err(Error::vulkan("vkEnumeratePhysicalDevices"))?;
            let (physical_device, mut support) = devices
                .into_iter()
                .filter(wanted)
                .find_map(|physical| {
                    Some((physical, gpu::check(&instance, physical, VERSION).ok()?))
                })
                .ok_or_else(|| Error::Device("no device can draw splats".into()))?;
            support.mesh_shader &= desc.optional;
            support.push_descriptor &= desc.optional;
            let extensions: Vec<_> = support.extensions().iter().map(|e| e.as_ptr()).collect();
            let mut features = support.features();
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(support.queue_family)
                .queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&extensions);
            let device = instance
                .create_device(physical_device, &features.chain(info), None)
                .map_err(Error::vulkan("vkCreateDevice"))?;

            let pipeline_cache = device
                .create_pipeline_cache(&vk::PipelineCacheCreateInfo::default(), None)
                .map_err(Error::vulkan("vkCreatePipelineCache"))?;
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

    /// What [`rara::gpu::Device::adopt`] needs. The host must outlive whatever is made from it.
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
        .debug_utils(self.messenger.is_some())
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
                .map_err(Error::vulkan("vkResetCommandPool"))?;
            self.device
                .begin_command_buffer(slot.cmd, &info)
                .map_err(Error::vulkan("vkBeginCommandBuffer"))?;
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

    /// What the host itself paints into column `x`: opaque, and exact in 8 bits and in half precision.
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
                .map_err(Error::vulkan("vkEndCommandBuffer"))?;
            self.device
                .reset_fences(&[slot.fence])
                .map_err(Error::vulkan("vkResetFences"))?;
            self.device
                .queue_submit2(self.queue, &submit, slot.fence)
                .map_err(Error::vulkan("vkQueueSubmit2"))?;
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

    fn picture_of(&self, frame: usize) -> Result<Vec<[f32; 4]>> {
        let slot = &self.slots[frame % FRAMES];
        let bytes = self.readback_size() as usize;
        // SAFETY: the fence belongs to the frame's submission, after which the mapped memory is complete; it is mapped
        // nowhere else, and holds at least so many bytes.
        let data = unsafe {
            self.device
                .wait_for_fences(&[slot.fence], true, u64::MAX)
                .map_err(Error::vulkan("vkWaitForFences"))?;
            let flags = vk::MemoryMapFlags::empty();
            let at = self
                .device
                .map_memory(slot.readback_memory, 0, vk::WHOLE_SIZE, flags)
                .map_err(Error::vulkan("vkMapMemory"))?;
            let data = std::slice::from_raw_parts(at.cast::<u8>(), bytes).to_vec();
            self.device.unmap_memory(slot.readback_memory);
            data
        };
        let pixels = data.chunks_exact(self.pixel_size());
        let channel = |pixel: &[u8], i: usize| match self.pixel_size() {
            4 => f32::from(pixel[i]) / 255.0,
            8 => half(u16::from_le_bytes([pixel[2 * i], pixel[2 * i + 1]])),
            _ => f32::from_le_bytes(pixel[4 * i..][..4].try_into().expect("four bytes")),
        };
        Ok(pixels
            .map(|pixel| [0, 1, 2, 3].map(|i| channel(pixel, i)))
            .collect())
    }

    fn pixel_size(&self) -> usize {
        match self.format {
            vk::Format::R8G8B8A8_UNORM => 4,
            vk::Format::R16G16B16A16_SFLOAT => 8,
            vk::Format::R32G32B32A32_SFLOAT => 16,
            other => panic!("this host has no targets of format {other:?}"),
        }
    }

    fn readback_size(&self) -> u64 {
        u64::from(self.extent.width) * u64::from(self.extent.height) * self.pixel_size() as u64
    }

    /// # Safety
    /// The host's device is alive.
    unsafe fn slot(&self) -> Result<Slot> {
        let device = &self.device;
        // SAFETY: the caller vouches for the device; everything else is made here.
        unsafe {
            let info =
                vk::CommandPoolCreateInfo::default().queue_family_index(self.support.queue_family);
            let pool = device
                .create_command_pool(&info, None)
                .map_err(Error::vulkan("vkCreateCommandPool"))?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            let cmd = device
                .allocate_command_buffers(&info)
                .map_err(Error::vulkan("vkAllocateCommandBuffers"))?[0];
            let fence = device
                .create_fence(&vk::FenceCreateInfo::default(), None)
                .map_err(Error::vulkan("vkCreateFence"))?;

            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(self.format)
                .extent(self.extent.into())
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::TYPE_1)
                .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
            let image = device
                .create_image(&info, None)
                .map_err(Error::vulkan("vkCreateImage"))?;
            let image_memory = self.memory(
                device.get_image_memory_requirements(image),
                vk::MemoryPropertyFlags::DEVICE_LOCAL,
            )?;
            device
                .bind_image_memory(image, image_memory, 0)
                .map_err(Error::vulkan("vkBindImageMemory"))?;
            let info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format)
                .subresource_range(WHOLE);
            let view = device
                .create_image_view(&info, None)
                .map_err(Error::vulkan("vkCreateImageView"))?;

            let info = vk::BufferCreateInfo::default()
                .size(self.readback_size())
                .usage(vk::BufferUsageFlags::TRANSFER_DST);
            let readback = device
                .create_buffer(&info, None)
                .map_err(Error::vulkan("vkCreateBuffer"))?;
            let readback_memory = self.memory(
                device.get_buffer_memory_requirements(readback),
                vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
            )?;
            device
                .bind_buffer_memory(readback, readback_memory, 0)
                .map_err(Error::vulkan("vkBindBufferMemory"))?;
            Ok(Slot {
                pool,
                cmd,
                fence,
                image,
                image_memory,
                view,
                readback,
                readback_memory,
            })
        }
    }

    /// # Safety
    /// The host's device is alive.
    unsafe fn memory(
        &self,
        needs: vk::MemoryRequirements,
        wanted: vk::MemoryPropertyFlags,
    ) -> Result<vk::DeviceMemory> {
        // SAFETY: the caller vouches for the device, and the instance outlives it.
        unsafe {
            let offered = self
                .instance
                .get_physical_device_memory_properties(self.physical_device);
            let fits = |(i, memory): (usize, &vk::MemoryType)| {
                needs.memory_type_bits & (1 << i) != 0 && memory.property_flags.contains(wanted)
            };
            let index = offered
                .memory_types_as_slice()
                .iter()
                .enumerate()
                .position(fits);
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(index.expect("Vulkan promises such memory") as u32);
            self.device
                .allocate_memory(&info, None)
                .map_err(Error::vulkan("vkAllocateMemory"))
        }
    }

    /// Moves the slot's target from one layout and use to another.
    fn layout(
        &self,
        slot: &Slot,
        (old, before): (vk::ImageLayout, vk::AccessFlags2),
        (new, after): (vk::ImageLayout, vk::AccessFlags2),
    ) {
        let stages = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT
            | vk::PipelineStageFlags2::ALL_TRANSFER;
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(stages)
            .src_access_mask(before)
            .dst_stage_mask(stages)
            .dst_access_mask(after)
            .old_layout(old)
            .new_layout(new)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(slot.image)
            .subresource_range(WHOLE)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: the slot's command buffer is recording outside rendering.
        unsafe { self.device.cmd_pipeline_barrier2(slot.cmd, &info) };
    }
}

/// Width of the host's stripes, px.
const STRIPE: u32 = 16;

/// A half-precision number.
fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    sign * match exponent {
        0 => mantissa * 2.0_f32.powi(-24),
        31 if mantissa == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        _ => (1024.0 + mantissa) * 2.0_f32.powi(exponent - 25),
    }
}
