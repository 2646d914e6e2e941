//! A picture beside any window: drawn into on the device, then read back.

use ash::vk;

use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::gpu::{Buffer, BufferDesc, Device, Image, ImageDesc, Location};
use crate::picture::Picture;
use crate::precision::TargetFormat;

/// An image for frames, replaced where a frame needs another size or format.
#[derive(Debug, Default)]
pub(super) struct Target {
    format: TargetFormat,
    image: Option<Image>,
    readback: Option<Buffer>,
    /// The bits of the background that the renderer's last frame was drawn on, if that is what the image shows.
    held: Option<Option<[u32; 3]>>,
}

impl Target {
    /// Sets the format of the next frame's pixels.
    pub(super) fn set_format(&mut self, device: &Device, format: TargetFormat) -> Result<()> {
        if self.image.is_some() && self.format == format {
            return Ok(());
        }
        *self = Self::default();
        check_blending(device, format)?;
        self.format = format;
        Ok(())
    }

    /// Makes an image of the camera's size, if there is none.
    pub(super) fn set_size(&mut self, device: &Device, camera: &Camera) -> Result<()> {
        let (width, height) = (camera.width, camera.height);
        let extent = vk::Extent2D { width, height };
        if self
            .image
            .as_ref()
            .is_some_and(|image| image.extent() == extent)
        {
            return Ok(());
        }
        // Free first: both together may not fit.
        (self.image, self.readback, self.held) = (None, None, None);
        self.image = Some(device.create_image(&ImageDesc {
            name: "target",
            width,
            height,
            format: self.format.vulkan(),
        })?);
        Ok(())
    }

    /// The image to be drawn into; what it shows is not known any more.
    pub(super) fn drawn_into(&mut self) -> &Image {
        self.held = None;
        self.image.as_ref().expect("set_size() makes it")
    }

    /// Notes that the image shows the renderer's last frame on this background.
    pub(super) fn set_held(&mut self, background: Option<[f32; 3]>) {
        self.held = Some(bits(background));
    }

    /// True when the image shows the renderer's last frame on this background.
    pub(super) fn holds(&self, background: Option<[f32; 3]>) -> bool {
        self.held == Some(bits(background))
    }

    /// Notes that the renderer's next frame is another one.
    pub(super) fn forget(&mut self) {
        self.held = None;
    }

    /// Reads the image back.
    pub(super) fn read_back(&mut self, device: &Device) -> Result<Picture> {
        let Some(image) = &self.image else {
            return Err(Error::Invalid("nothing has been rendered yet".into()));
        };
        let vk::Extent2D { width, height } = image.extent();
        let size = u64::from(width) * u64::from(height) * self.format.pixel_bytes();
        let readback = match self.readback.take() {
            Some(buffer) => buffer,
            None => device.create_buffer(&BufferDesc {
                name: "readback",
                size,
                location: Location::Readback,
            })?,
        };
        device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording; the image was left ready to be copied from by the frame's end_rendering, and
            // image and buffer outlive the wait.
            unsafe { image.copy_to(cmd, &readback) };
            Ok(())
        })?;
        let pixels = self.format.decode(&readback.mapped()[..size as usize]);
        self.readback = Some(readback);
        Ok(Picture {
            width,
            height,
            pixels,
        })
    }
}

/// Colours that are equal to the bit are drawn alike, also where they are no numbers.
fn bits(background: Option<[f32; 3]>) -> Option<[u32; 3]> {
    background.map(|rgb| rgb.map(f32::to_bits))
}

/// Vulkan promises blending into every format here but 32-bit floats.
fn check_blending(device: &Device, format: TargetFormat) -> Result<()> {
    let features = device.format_features(format.vulkan());
    let blends = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    if features.contains(blends) {
        return Ok(());
    }
    Err(Error::Device(format!(
        "this device cannot blend into pictures of {} bits a channel; choose another target format",
        2 * format.pixel_bytes()
    )))
}
