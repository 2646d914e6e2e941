//! The engine's target, the buffer that it is copied to, and the render pass.

use super::{EXTENT, FORMAT};
use rara::ash::{Device, vk};
use rara::gpu_allocator::MemoryLocation;
use rara::gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};

/// # Safety
/// The device is alive, and the allocator its own.
pub(super) unsafe fn image(
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
        let needs = device.get_image_memory_requirements(image);
        let memory = memory(allocator, "host's target", needs, MemoryLocation::GpuOnly);
        let bound = device.bind_image_memory(image, memory.memory(), memory.offset());
        bound.expect("binds");
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(FORMAT)
            .subresource_range(
                vk::ImageSubresourceRange::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .level_count(1)
                    .layer_count(1),
            );
        let view = device.create_image_view(&info, None).expect("a view");
        (image, view, memory)
    }
}

/// Memory of the engine's own: an image's on the device, or a buffer's that is read back.
fn memory(
    allocator: &mut Allocator,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
) -> Allocation {
    let memory = allocator.allocate(&AllocationCreateDesc {
        name,
        requirements,
        location,
        linear: location == MemoryLocation::GpuToCpu,
        allocation_scheme: AllocationScheme::GpuAllocatorManaged,
    });
    memory.expect("memory")
}

pub(super) fn readback_size() -> u64 {
    u64::from(EXTENT.width) * u64::from(EXTENT.height) * 16
}

/// # Safety
/// As for [`image`].
pub(super) unsafe fn readback(
    device: &Device,
    allocator: &mut Allocator,
) -> (vk::Buffer, Allocation) {
    let info = vk::BufferCreateInfo::default()
        .size(readback_size())
        .usage(vk::BufferUsageFlags::TRANSFER_DST);
    // SAFETY: the caller vouches for the device; the rest is made here.
    unsafe {
        let buffer = device.create_buffer(&info, None).expect("a buffer");
        let needs = device.get_buffer_memory_requirements(buffer);
        let memory = memory(
            allocator,
            "host's readback",
            needs,
            MemoryLocation::GpuToCpu,
        );
        let bound = device.bind_buffer_memory(buffer, memory.memory(), memory.offset());
        bound.expect("binds");
        (buffer, memory)
    }
}

/// # Safety
/// The device is alive.
pub(super) unsafe fn render_pass(device: &Device) -> vk::RenderPass {
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
