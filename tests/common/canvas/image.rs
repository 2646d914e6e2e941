//! The images of a canvas.

use rara::ash::vk;

use super::{COLOR, COPIED, Canvas, DEPTH, SAMPLED, UNDEFINED};

pub(super) struct Image {
    pub(super) raw: vk::Image,
    pub(super) view: vk::ImageView,
    pub(super) memory: vk::DeviceMemory,
    pub(super) format: vk::Format,
}

impl Image {
    pub(super) fn none() -> Self {
        Self {
            raw: vk::Image::null(),
            view: vk::ImageView::null(),
            memory: vk::DeviceMemory::null(),
            format: UNDEFINED,
        }
    }
}

impl Canvas {
    pub(super) fn image(
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
            .array_layers(self.desc.layers)
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
                .view_type(match self.desc.layers {
                    1 => vk::ImageViewType::TYPE_2D,
                    _ => vk::ImageViewType::TYPE_2D_ARRAY,
                })
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
    pub(super) unsafe fn turn(
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
            SAMPLED => vk::AccessFlags2::SHADER_READ,
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
        .layer_count(vk::REMAINING_ARRAY_LAYERS)
}
