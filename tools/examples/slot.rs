//! The part of the host that each frame in flight has to itself: commands, a target, and memory to read it back from.

use half::f16;
use rara::Result;
use rara::ash::vk;

use super::{FRAMES, Host};

/// The objects of one frame in flight.
pub(super) struct Slot {
    pub(super) pool: vk::CommandPool,
    pub(super) cmd: vk::CommandBuffer,
    pub(super) fence: vk::Fence,
    pub(super) image: vk::Image,
    pub(super) image_memory: vk::DeviceMemory,
    pub(super) view: vk::ImageView,
    pub(super) readback: vk::Buffer,
    pub(super) readback_memory: vk::DeviceMemory,
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Host {
    /// Waits for a frame and returns its picture.
    pub(super) fn picture_of(&self, frame: usize) -> Result<Vec<[f32; 4]>> {
        let slot = &self.slots[frame % FRAMES];
        let bytes = self.readback_size() as usize;
        // SAFETY: the fence belongs to the frame's submission, after which the mapped memory is complete; it is mapped
        // nowhere else, and holds at least so many bytes.
        let data = unsafe {
            self.device
                .wait_for_fences(&[slot.fence], true, u64::MAX)
                .map_err(rara_gpu::failed("vkWaitForFences"))?;
            let flags = vk::MemoryMapFlags::empty();
            let at = self
                .device
                .map_memory(slot.readback_memory, 0, vk::WHOLE_SIZE, flags)
                .map_err(rara_gpu::failed("vkMapMemory"))?;
            let data = std::slice::from_raw_parts(at.cast::<u8>(), bytes).to_vec();
            self.device.unmap_memory(slot.readback_memory);
            data
        };
        let pixels = data.chunks_exact(self.pixel_size());
        let channel = |pixel: &[u8], i: usize| match self.pixel_size() {
            4 => f32::from(pixel[i]) / 255.0,
            8 => f16::from_le_bytes([pixel[2 * i], pixel[2 * i + 1]]).to_f32(),
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
    pub(super) unsafe fn slot(&self) -> Result<Slot> {
        let device = &self.device;
        // SAFETY: the caller vouches for the device; everything else is made here.
        unsafe {
            let info =
                vk::CommandPoolCreateInfo::default().queue_family_index(self.support.queue_family);
            let pool = device
                .create_command_pool(&info, None)
                .map_err(rara_gpu::failed("vkCreateCommandPool"))?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            let cmd = device
                .allocate_command_buffers(&info)
                .map_err(rara_gpu::failed("vkAllocateCommandBuffers"))?[0];
            let fence = device
                .create_fence(&vk::FenceCreateInfo::default(), None)
                .map_err(rara_gpu::failed("vkCreateFence"))?;

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
                .map_err(rara_gpu::failed("vkCreateImage"))?;
            let image_memory = self.memory(
                device.get_image_memory_requirements(image),
                vk::MemoryPropertyFlags::DEVICE_LOCAL,
            )?;
            device
                .bind_image_memory(image, image_memory, 0)
                .map_err(rara_gpu::failed("vkBindImageMemory"))?;
            let info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format)
                .subresource_range(WHOLE);
            let view = device
                .create_image_view(&info, None)
                .map_err(rara_gpu::failed("vkCreateImageView"))?;

            let info = vk::BufferCreateInfo::default()
                .size(self.readback_size())
                .usage(vk::BufferUsageFlags::TRANSFER_DST);
            let readback = device
                .create_buffer(&info, None)
                .map_err(rara_gpu::failed("vkCreateBuffer"))?;
            let readback_memory = self.memory(
                device.get_buffer_memory_requirements(readback),
                vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
            )?;
            device
                .bind_buffer_memory(readback, readback_memory, 0)
                .map_err(rara_gpu::failed("vkBindBufferMemory"))?;
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
                .map_err(rara_gpu::failed("vkAllocateMemory"))
        }
    }

    /// Moves the slot's target from one layout and use to another.
    pub(super) fn layout(
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
