//! A 2D colour target for headless use. A host draws into images of its own.

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme};

use super::device::Device;
use super::failure::failed;
use super::label::{begin_label, end_label};
use super::lent::Memory;
use super::memory::{Buffer, bytes};
use rara_base::error::{Error, Result};

/// The description from which an image is created.
#[derive(Debug, Clone, Copy)]
pub struct ImageDesc<'a> {
    /// The name for debuggers, validation messages and errors.
    pub name: &'a str,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// A colour format that can be rendered to.
    pub format: vk::Format,
}

/// A 2D image that is rendered to and copied from; dropping it frees it, when the device is done with it.
#[derive(Debug)]
pub struct Image {
    device: Device,
    handle: vk::Image,
    view: vk::ImageView,
    extent: vk::Extent2D,
    format: vk::Format,
    name: Box<str>,
    allocation: Option<Memory>,
}

/// Every target has one level and one layer of colour.
pub const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Device {
    #[doc(hidden)]
    pub fn create_image(&self, desc: &ImageDesc<'_>) -> Result<Image> {
        let limit = self.support().max_image_size;
        if desc.width == 0 || desc.height == 0 || desc.width.max(desc.height) > limit {
            let size = format!("{} x {}", desc.width, desc.height);
            return Err(Error::Invalid(format!(
                "a picture of {size} is not possible: each side is 1 to {limit} pixels on this device"
            )));
        }
        let extent = vk::Extent2D {
            width: desc.width,
            height: desc.height,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(desc.format)
            .extent(extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
        // SAFETY: the device is alive as long as `self`.
        let handle =
            unsafe { self.raw().create_image(&info, None) }.map_err(failed("vkCreateImage"))?;
        // From here on dropping `image` cleans up.
        let mut image = Image {
            device: self.clone(),
            handle,
            view: vk::ImageView::null(),
            extent,
            format: desc.format,
            name: desc.name.into(),
            allocation: None,
        };
        // SAFETY: the image was created just now.
        let requirements = unsafe { self.raw().get_image_memory_requirements(handle) };
        let allocation = self.allocate(&AllocationCreateDesc {
            name: desc.name,
            requirements,
            location: MemoryLocation::GpuOnly,
            linear: false,
            // Drivers compress render targets only in memory of their own.
            allocation_scheme: AllocationScheme::DedicatedImage(handle),
        });
        let allocation = allocation.map_err(|refusal| {
            refusal.error(|why| {
                Error::Memory(format!(
                    "image \"{}\" of {} x {} ({}) could not be allocated ({why}); make the picture smaller",
                    desc.name,
                    desc.width,
                    desc.height,
                    bytes(requirements.size)
                ))
            })
        })?;
        let allocation = image.allocation.insert(allocation);
        // SAFETY: the memory fits the requirements it was allocated for, and the image is not bound yet.
        unsafe {
            self.raw()
                .bind_image_memory(handle, allocation.memory(), allocation.offset())
        }
        .map_err(failed("vkBindImageMemory"))?;
        let info = vk::ImageViewCreateInfo::default()
            .image(handle)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(desc.format)
            .subresource_range(WHOLE);
        // SAFETY: the image is bound and has the view's format.
        image.view = unsafe { self.raw().create_image_view(&info, None) }
            .map_err(failed("vkCreateImageView"))?;
        self.set_name(handle, desc.name);
        self.set_name(image.view, desc.name);
        Ok(image)
    }
}

impl Image {
    pub fn handle(&self) -> vk::Image {
        self.handle
    }

    pub fn view(&self) -> vk::ImageView {
        self.view
    }

    pub fn extent(&self) -> vk::Extent2D {
        self.extent
    }

    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// Clears the image and begins rendering to all of it, whatever happened to it before.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on this image's device, outside rendering; the image must outlive its execution.
    pub unsafe fn begin_rendering(&self, cmd: vk::CommandBuffer, clear: [f32; 4]) {
        let to_draw = to_be_drawn()
            .src_stage_mask(
                vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT
                    | vk::PipelineStageFlags2::ALL_TRANSFER,
            )
            .src_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE);
        begin_label(&self.device, cmd, &self.name);
        // SAFETY: the caller vouches for `cmd`; the view is the image's own and covers the render area.
        unsafe {
            barrier(&self.device, cmd, self.handle, to_draw);
            begin_rendering(&self.device, cmd, (self.view, self.extent), Some(clear));
        }
    }

    /// Ends rendering and makes the picture ready to be copied.
    ///
    /// # Safety
    ///
    /// `cmd` must be the one of [`Image::begin_rendering`], still inside its rendering.
    pub unsafe fn end_rendering(&self, cmd: vk::CommandBuffer) {
        let to_copy = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .dst_access_mask(vk::AccessFlags2::TRANSFER_READ)
            .old_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .new_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        // SAFETY: the caller vouches for `cmd`, and that the image is being rendered to.
        unsafe {
            end_rendering(&self.device, cmd);
            barrier(&self.device, cmd, self.handle, to_copy);
        }
        end_label(&self.device, cmd);
    }

    /// Copies the rendered picture, rows from the top without gaps, to the beginning of `target`. The barrier between
    /// the copy and `target`'s next use is included: the host may read it after the fence.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on this image's device after [`Image::end_rendering`], outside rendering; image and
    /// buffer must outlive its execution, and nothing else may be using `target`.
    pub unsafe fn copy_to(&self, cmd: vk::CommandBuffer, target: &Buffer) {
        let region = vk::BufferImageCopy::default()
            .image_subresource(
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .layer_count(1),
            )
            .image_extent(self.extent.into());
        let visible = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST | vk::PipelineStageFlags2::ALL_TRANSFER)
            .dst_access_mask(vk::AccessFlags2::HOST_READ | vk::AccessFlags2::TRANSFER_READ)];
        begin_label(&self.device, cmd, target.name());
        // SAFETY: the caller vouches for `cmd` and the image's layout.
        unsafe {
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            self.device.raw().cmd_copy_image_to_buffer(
                cmd,
                self.handle,
                layout,
                target.handle(),
                &[region],
            );
            let info = vk::DependencyInfo::default().memory_barriers(&visible);
            self.device.commands().pipeline_barrier(cmd, &info);
        }
        end_label(&self.device, cmd);
    }
}

/// Records the barrier that takes a target from one layout and use to the next.
///
/// # Safety
///
/// `cmd` must be recording on the device, outside rendering, and the image must outlive its execution.
pub unsafe fn barrier(
    device: &Device,
    cmd: vk::CommandBuffer,
    image: vk::Image,
    barrier: vk::ImageMemoryBarrier2<'_>,
) {
    let barriers = [barrier
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(WHOLE)];
    let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
    // SAFETY: the caller vouches for `cmd` and image.
    unsafe { device.commands().pipeline_barrier(cmd, &info) };
}

/// The barrier that makes a target ready to be drawn into, whatever it held; the caller adds the uses that it waits for.
pub fn to_be_drawn() -> vk::ImageMemoryBarrier2<'static> {
    vk::ImageMemoryBarrier2::default()
        .dst_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
        .dst_access_mask(
            vk::AccessFlags2::COLOR_ATTACHMENT_READ | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
        )
        // An undefined layout drops the old contents, which the clear would overwrite anyway.
        .old_layout(vk::ImageLayout::UNDEFINED)
        .new_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
}

/// Begins rendering to all of a target, which is cleared where a colour is given and otherwise keeps what it holds.
///
/// # Safety
///
/// `cmd` must be recording on the device, outside rendering; the view is of a target of this extent, ready to be drawn
/// into, and outlives the execution.
pub unsafe fn begin_rendering(
    device: &Device,
    cmd: vk::CommandBuffer,
    (view, extent): (vk::ImageView, vk::Extent2D),
    clear: Option<[f32; 4]>,
) {
    let load = match clear {
        Some(_) => vk::AttachmentLoadOp::CLEAR,
        None => vk::AttachmentLoadOp::LOAD,
    };
    let attachments = [vk::RenderingAttachmentInfo::default()
        .image_view(view)
        .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        .load_op(load)
        .store_op(vk::AttachmentStoreOp::STORE)
        .clear_value(vk::ClearValue {
            color: vk::ClearColorValue {
                float32: clear.unwrap_or_default(),
            },
        })];
    let info = vk::RenderingInfo::default()
        .render_area(extent.into())
        .layer_count(1)
        .color_attachments(&attachments);
    // SAFETY: the caller vouches for `cmd` and the view.
    unsafe { device.commands().begin_rendering(cmd, &info) };
}

/// Ends the rendering to a target.
///
/// # Safety
///
/// `cmd` must be recording on the device, inside the rendering of [`begin_rendering`].
pub unsafe fn end_rendering(device: &Device, cmd: vk::CommandBuffer) {
    // SAFETY: the caller vouches for `cmd`.
    unsafe { device.commands().end_rendering(cmd) };
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: whoever submitted work with the image waited for it; a null view is ignored.
        unsafe {
            self.device.raw().destroy_image_view(self.view, None);
            self.device.raw().destroy_image(self.handle, None);
        }
        if let Some(allocation) = self.allocation.take() {
            self.device.free(&self.name, allocation);
        }
    }
}
