//! The images that a window shows in turn. They are made to fit it, acquired, drawn into and shown.

use crate::surface::{Surface, lost};
use rara::Result;
use rara::ash::{khr, vk};
use rara_gpu::image::{WHOLE, barrier, begin_rendering, end_rendering, to_be_drawn};
use rara_gpu::{Buffer, Device, Drawer, failed};

/// A window's images; none while the window has no size.
pub(crate) struct Swapchain {
    chain: Option<Chain>,
    format: vk::SurfaceFormatKHR,
    loader: khr::swapchain::Device,
    surface: Surface,
    device: Device,
}

/// One `VkSwapchainKHR`.
struct Chain {
    handle: vk::SwapchainKHR,
    extent: vk::Extent2D,
    transform: vk::SurfaceTransformFlagsKHR,
    /// The window's size for which it was made, as the window system reported it.
    window: (u32, u32),
    images: Vec<SwapchainImage>,
    /// True when it must be made anew before the next frame.
    outdated: bool,
    /// True when another might fit better, although it works.
    suboptimal: bool,
    /// True when its images can be copied to.
    takes_copies: bool,
}

struct SwapchainImage {
    image: vk::Image,
    view: vk::ImageView,
    /// Signalled when the image is drawn. One for each image and not for each frame in flight: only acquiring the image
    /// again shows that its presentation has waited.
    drawn: vk::Semaphore,
}

/// The contents of an image where the drawing into it begins.
pub(crate) enum Ground<'a> {
    /// This colour everywhere.
    Colour([f32; 4]),
    /// A picture that is copied to all of it.
    Copy(&'a Buffer, &'a vk::BufferImageCopy),
}

/// Frames wait for an image no longer than this, so that a compositor that shows nothing does not hang the window.
const PATIENCE_NS: u64 = 500_000_000;

impl Swapchain {
    /// The swapchain of a surface and the device that was opened for it. [`fit`](Self::fit) makes its images.
    pub(crate) fn new(device: &Device, surface: Surface) -> Result<Self> {
        let format = surface.format(device)?;
        Ok(Self {
            chain: None,
            format,
            loader: khr::swapchain::Device::new(surface.instance(), device.raw()),
            surface,
            device: device.clone(),
        })
    }

    /// The images' format.
    pub(crate) fn format(&self) -> vk::Format {
        self.format.format
    }

    /// Makes the images fit a window that has this size, and returns the size that they have: `None` while the window has
    /// no pixels, as it may when it is minimised.
    pub(crate) fn fit(&mut self, window: (u32, u32)) -> Result<Option<vk::Extent2D>> {
        if window.0 == 0 || window.1 == 0 {
            self.clear()?;
            return Ok(None);
        }
        let fits = |chain: &Chain| !chain.outdated && !chain.suboptimal && chain.window == window;
        if let Some(chain) = self.chain.as_ref().filter(|chain| fits(chain)) {
            return Ok(Some(chain.extent));
        }
        let offered = self.surface.capabilities(&self.device)?;
        let extent = extent(&offered, window);
        if extent.width == 0 || extent.height == 0 {
            self.clear()?;
            return Ok(None);
        }
        if let Some(chain) = &mut self.chain {
            let same = (chain.extent, chain.transform) == (extent, offered.current_transform);
            if !chain.outdated && same {
                // A new one would be no better.
                chain.suboptimal = false;
                chain.window = window;
                return Ok(Some(extent));
            }
        }
        self.create(&offered, extent, window)?;
        Ok(Some(extent))
    }

    fn create(
        &mut self,
        offered: &vk::SurfaceCapabilitiesKHR,
        extent: vk::Extent2D,
        window: (u32, u32),
    ) -> Result<()> {
        self.wait()?;
        let old = self.chain.take();
        let opaque = vk::CompositeAlphaFlagsKHR::OPAQUE;
        let alpha = if offered.supported_composite_alpha.contains(opaque) {
            opaque
        } else {
            // There is always some other mode; the pictures have no transparent pixel anyway.
            let bits = offered.supported_composite_alpha.as_raw();
            vk::CompositeAlphaFlagsKHR::from_raw(1 << bits.trailing_zeros())
        };
        let most = match offered.max_image_count {
            0 => u32::MAX,
            most => most,
        };
        // Every window system that is known offers this, and none has to.
        let copied_to = offered.supported_usage_flags & vk::ImageUsageFlags::TRANSFER_DST;
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(self.surface.handle())
            // There is one more than the window system holds on to, so that a frame can be drawn meanwhile.
            .min_image_count((offered.min_image_count + 1).min(most))
            .image_format(self.format.format)
            .image_color_space(self.format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | copied_to)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(offered.current_transform)
            .composite_alpha(alpha)
            // This mode always exists; it neither tears nor draws more than is shown.
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true)
            .old_swapchain(old.as_ref().map_or(vk::SwapchainKHR::null(), |c| c.handle));
        // SAFETY: device and surface are alive, and `info` asks for what the surface offers.
        let made = unsafe { self.loader.create_swapchain(&info, None) };
        if let Some(old) = old {
            self.destroy(old);
        }
        // From here on dropping `self` cleans up.
        let chain = self.chain.insert(Chain {
            handle: made.map_err(lost)?,
            extent,
            transform: offered.current_transform,
            window,
            images: Vec::new(),
            outdated: true,
            suboptimal: false,
            takes_copies: !copied_to.is_empty(),
        });
        // SAFETY: the swapchain was created just now.
        let images = unsafe { self.loader.get_swapchain_images(chain.handle) }
            .map_err(failed("vkGetSwapchainImagesKHR"))?;
        for image in images {
            let info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format.format)
                .subresource_range(WHOLE);
            chain.images.push(SwapchainImage {
                image,
                view: vk::ImageView::null(),
                drawn: vk::Semaphore::null(),
            });
            let shown = chain.images.last_mut().expect("pushed above");
            // SAFETY: the image is the living swapchain's.
            shown.view = unsafe { self.device.raw().create_image_view(&info, None) }
                .map_err(failed("vkCreateImageView"))?;
            let info = vk::SemaphoreCreateInfo::default();
            // SAFETY: the device is alive.
            shown.drawn = unsafe { self.device.raw().create_semaphore(&info, None) }
                .map_err(failed("vkCreateSemaphore"))?;
            self.device.set_name(shown.view, "window");
            self.device.set_name(shown.drawn, "drawn");
        }
        chain.outdated = false;
        Ok(())
    }

    /// Acquires the next image; `acquired` is signalled when it may be drawn into. `None` if there is none right now:
    /// the window's size changed, or nothing of it is shown. Ask again with the next frame, after [`fit`](Self::fit).
    ///
    /// # Safety
    /// Nothing waits for `acquired` and nothing will signal it.
    pub(crate) unsafe fn acquire(&mut self, acquired: vk::Semaphore) -> Result<Option<usize>> {
        let Some(chain) = self.chain.as_mut().filter(|chain| !chain.outdated) else {
            return Ok(None);
        };
        // SAFETY: the swapchain is alive and not retired; the caller vouches for the semaphore.
        let next = unsafe {
            self.loader
                .acquire_next_image(chain.handle, PATIENCE_NS, acquired, vk::Fence::null())
        };
        match next {
            Ok((index, suboptimal)) => {
                chain.suboptimal |= suboptimal;
                Ok(Some(index as usize))
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                chain.outdated = true;
                Ok(None)
            }
            Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => Ok(None),
            Err(error) => Err(lost(error)),
        }
    }

    /// The semaphore that is signalled when an acquired image is drawn; [`present`](Self::present) waits for it.
    pub(crate) fn drawn(&self, image: usize) -> vk::Semaphore {
        self.chain().images[image].drawn
    }

    /// Records the beginning of rendering to an acquired image over what it holds at first; viewport and scissor are the image.
    ///
    /// # Safety
    /// `cmd` is recording on the device outside rendering. Its submission waits, in the stage of colour output, for the
    /// semaphore that the image was acquired with. A copy is of all of the image and from within the buffer, the images
    /// [can be copied to](Self::copied_to), and the host has written the buffer, which outlives the execution.
    pub(crate) unsafe fn begin_rendering(
        &self,
        cmd: vk::CommandBuffer,
        image: usize,
        ground: Ground<'_>,
    ) {
        let chain = self.chain();
        let shown = &chain.images[image];
        // The first barrier comes after the wait for the image, which is in this stage.
        let waited = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT;
        let (clear, to_draw) = match ground {
            Ground::Colour(clear) => (Some(clear), to_be_drawn().src_stage_mask(waited)),
            Ground::Copy(buffer, copy) => {
                // SAFETY: the caller vouches for `cmd`, buffer and copy.
                unsafe { self.copy_ground(cmd, shown.image, (buffer, copy)) };
                let copied = to_be_drawn()
                    .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                    .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                    .old_layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL);
                (None, copied)
            }
        };
        // SAFETY: the caller vouches for `cmd`; the view is the image's own and covers the render area.
        unsafe {
            barrier(&self.device, cmd, shown.image, to_draw);
            begin_rendering(&self.device, cmd, (shown.view, chain.extent), clear);
            Drawer::new(&self.device, cmd, None).viewport(chain.extent.into());
        }
    }

    /// Records a copy to all of an acquired image, whatever it holds.
    ///
    /// # Safety
    /// The same as of [`begin_rendering`](Self::begin_rendering).
    unsafe fn copy_ground(
        &self,
        cmd: vk::CommandBuffer,
        image: vk::Image,
        (buffer, copy): (&Buffer, &vk::BufferImageCopy),
    ) {
        let copied_to = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let to_copy = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .old_layout(vk::ImageLayout::UNDEFINED)
            .new_layout(copied_to);
        let copies = std::slice::from_ref(copy);
        // SAFETY: the caller vouches for `cmd`, the image, buffer and copy.
        unsafe {
            barrier(&self.device, cmd, image, to_copy);
            let raw = self.device.raw();
            raw.cmd_copy_buffer_to_image(cmd, buffer.handle(), image, copied_to, copies);
        }
    }

    /// The size of the images, if they can be copied to.
    pub(crate) fn copied_to(&self) -> Option<(u32, u32)> {
        let chain = self.chain.as_ref().filter(|chain| chain.takes_copies)?;
        Some((chain.extent.width, chain.extent.height))
    }

    /// Records the end of rendering, copies to the image what `panels` say, and makes the image ready to be shown.
    ///
    /// # Safety
    /// `cmd` is the one of [`begin_rendering`](Self::begin_rendering), still inside its rendering. The copies are within the
    /// image and the buffer, no two of them in one place of the image, the images [can be copied to](Self::copied_to), and the
    /// host has written the buffer, which outlives the execution.
    pub(crate) unsafe fn end_rendering(
        &self,
        cmd: vk::CommandBuffer,
        image: usize,
        panels: Option<(&Buffer, &[vk::BufferImageCopy])>,
    ) {
        let image = self.chain().images[image].image;
        let drawn = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE)
            .old_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL);
        // Presentation waits for a semaphore, which does the rest.
        let to_show = |from: vk::ImageMemoryBarrier2<'static>| {
            from.dst_stage_mask(vk::PipelineStageFlags2::NONE)
                .new_layout(vk::ImageLayout::PRESENT_SRC_KHR)
        };
        // SAFETY: the caller vouches for `cmd`, that the image is being rendered to, and for buffer and copies.
        unsafe {
            end_rendering(&self.device, cmd);
            let Some((buffer, copies)) = panels else {
                return barrier(&self.device, cmd, image, to_show(drawn));
            };
            let copied_to = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            let to_copy = drawn
                .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .new_layout(copied_to);
            barrier(&self.device, cmd, image, to_copy);
            let raw = self.device.raw();
            raw.cmd_copy_buffer_to_image(cmd, buffer.handle(), image, copied_to, copies);
            let copied = vk::ImageMemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .old_layout(copied_to);
            barrier(&self.device, cmd, image, to_show(copied));
        }
    }

    /// Shows an image once it is drawn.
    ///
    /// # Safety
    /// The image was acquired, and what draws it and signals [`drawn`](Self::drawn) was submitted.
    pub(crate) unsafe fn present(&mut self, image: usize) -> Result<()> {
        let chain = self.chain.as_mut().expect("an image was acquired");
        let drawn = [chain.images[image].drawn];
        let (chains, images) = ([chain.handle], [image as u32]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&drawn)
            .swapchains(&chains)
            .image_indices(&images);
        let queue = self.device.lock_queue();
        // SAFETY: the lock keeps our threads from the queue, which belongs to nobody else; its family shows pictures in
        // this window. The caller vouches for image and semaphore.
        match unsafe { self.loader.queue_present(*queue, &info) } {
            Ok(suboptimal) => chain.suboptimal |= suboptimal,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => chain.outdated = true,
            Err(error) => return Err(lost(error)),
        }
        Ok(())
    }

    /// Frees the images of a window that shows nothing.
    fn clear(&mut self) -> Result<()> {
        if let Some(chain) = self.chain.take() {
            let waited = self.wait();
            self.destroy(chain);
            waited?;
        }
        Ok(())
    }

    fn chain(&self) -> &Chain {
        self.chain.as_ref().expect("an image was acquired")
    }

    /// Waits until nothing uses the images any more.
    fn wait(&self) -> Result<()> {
        let _queue = self.device.lock_queue();
        // SAFETY: the device is alive, and its only queue locked.
        unsafe { self.device.raw().device_wait_idle() }.map_err(failed("vkDeviceWaitIdle"))
    }

    /// Destroys a chain that was waited for.
    fn destroy(&self, chain: Chain) {
        let raw = self.device.raw();
        // SAFETY: all callers have waited for the device, or lost it; null handles are ignored.
        unsafe {
            for shown in &chain.images {
                raw.destroy_image_view(shown.view, None);
                raw.destroy_semaphore(shown.drawn, None);
            }
            self.loader.destroy_swapchain(chain.handle, None);
        }
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        let _ = self.clear(); // a lost device has nothing to wait for
    }
}

/// The images' size: the surface's, or the window's where the surface follows the images.
fn extent(offered: &vk::SurfaceCapabilitiesKHR, (width, height): (u32, u32)) -> vk::Extent2D {
    if offered.current_extent.width != u32::MAX {
        return offered.current_extent;
    }
    let (least, most) = (offered.min_image_extent, offered.max_image_extent);
    vk::Extent2D {
        width: width.clamp(least.width, most.width.max(least.width)),
        height: height.clamp(least.height, most.height.max(least.height)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_surface_decides_the_size_unless_it_follows_the_images() {
        let square = |side| vk::Extent2D {
            width: side,
            height: side,
        };
        let mut offered = vk::SurfaceCapabilitiesKHR {
            current_extent: square(300),
            min_image_extent: square(1),
            max_image_extent: square(4096),
            ..Default::default()
        };
        assert_eq!(extent(&offered, (640, 480)), square(300));
        offered.current_extent = square(u32::MAX);
        let free = extent(&offered, (640, 9000));
        assert_eq!((free.width, free.height), (640, 4096));
    }
}
