//! A picture beside any window: drawn into on the device, or made there by tiles, then read back.

use std::borrow::Cow;

use ash::vk;

use super::stored::PictureBytes;
use crate::passes::TilePicture;
use rara_base::error::{Error, Result};
use rara_gpu::{Buffer, BufferDesc, Device, Image, ImageDesc, Location};
use rara_scene::camera::Camera;
use rara_scene::picture::linear_light;
use rara_scene::precision::TargetFormat;

/// A picture for frames, replaced where a frame needs another size or format: an image that is drawn into or, without one,
/// what the renderer's tiles have made.
#[derive(Debug, Default)]
pub(super) struct Target {
    /// True when the tiles' picture may be the picture.
    takes_tiles: bool,
    format: TargetFormat,
    /// True when the last frame's pixels are linear light.
    linear: bool,
    /// The tiles' picture, if the last frame's is that, and its size.
    tiles: Option<(TilePicture, vk::Extent2D)>,
    image: Option<Image>,
    readback: Option<Buffer>,
    /// The bits of the background that the renderer's last frame was drawn on, if that is what the image shows.
    held: Option<Option<[u32; 3]>>,
}

impl Target {
    /// A target whose picture may be that of the renderer's tiles, as nothing else is drawn between two of its frames.
    pub(super) fn of_tiles() -> Self {
        Self {
            takes_tiles: true,
            ..Self::default()
        }
    }

    /// Sets the format of the next frame's pixels, and returns it: what is wanted, or what takes its place on this device.
    pub(super) fn set_format(
        &mut self,
        device: &Device,
        wanted: TargetFormat,
    ) -> Result<TargetFormat> {
        let format = blendable_on(device, wanted)?;
        let is_made = self.image.is_some() || self.tiles.is_some();
        if is_made && self.format == format {
            return Ok(format);
        }
        *self = Self {
            takes_tiles: self.takes_tiles,
            ..Self::default()
        };
        if format != wanted {
            log::warn!(
                "this device cannot blend into pictures of {} bits a channel: they have {}, and round at each blend",
                bits_of(wanted),
                bits_of(format)
            );
        }
        self.format = format;
        Ok(format)
    }

    /// Says whether the next frame's pixels are linear light.
    pub(super) fn set_linear(&mut self, linear: bool) {
        if self.linear != linear {
            (self.tiles, self.held) = (None, None);
        }
        self.linear = linear;
    }

    /// The format in which the tiles' picture may be the picture; `None` where that is drawn, as on a background.
    pub(super) fn of_tiles_on(&self, background: Option<[f32; 3]>) -> Option<TargetFormat> {
        (self.takes_tiles && background.is_none()).then_some(self.format)
    }

    /// Makes an image of the camera's size, if there is none.
    pub(super) fn make_image(&mut self, device: &Device, camera: &Camera) -> Result<()> {
        let extent = extent(camera);
        if self
            .image
            .as_ref()
            .is_some_and(|image| image.extent() == extent)
        {
            return Ok(());
        }
        self.free_image(); // first: both together may not fit
        self.image = Some(device.create_image(&ImageDesc {
            name: "target",
            width: extent.width,
            height: extent.height,
            format: vulkan_format(self.format),
        })?);
        Ok(())
    }

    /// Frees the image, which a frame does without whose picture is the tiles'.
    pub(super) fn free_image(&mut self) {
        (self.image, self.readback, self.held) = (None, None, None);
    }

    /// The image to be drawn into, unless the picture is the tiles'; what the target shows is not known any more.
    pub(super) fn drawn_into(&mut self) -> Option<&Image> {
        (self.tiles, self.held) = (None, None);
        self.image.as_ref()
    }

    /// The pixels on which a frame is drawn, as they are in the image.
    pub(super) fn clear_colour(&self, background: Option<[f32; 3]>) -> [f32; 4] {
        background.map_or([0.0; 4], |rgb| {
            let [r, g, b] = match self.linear {
                true => rgb.map(linear_light),
                false => rgb,
            };
            [r, g, b, 1.0]
        })
    }

    /// Notes that the image shows the renderer's last frame on this background.
    pub(super) fn set_held(&mut self, background: Option<[f32; 3]>) {
        self.held = Some(bits(background));
    }

    /// Notes that the tiles' picture of the renderer's last frame is the picture.
    pub(super) fn set_tiles(&mut self, tiles: TilePicture, camera: &Camera) {
        self.tiles = Some((tiles, extent(camera)));
    }

    /// True when the target shows the renderer's last frame: it is the tiles' picture or, without one, the image shows it on
    /// this background.
    pub(super) fn holds(&self, tiles: Option<&TilePicture>, background: Option<[f32; 3]>) -> bool {
        match (tiles, &self.tiles) {
            (Some(tiles), Some((held, _))) => tiles.is(held),
            (Some(_), None) => false,
            (None, _) => self.held == Some(bits(background)),
        }
    }

    /// Notes that the renderer's next frame is another one.
    pub(super) fn forget(&mut self) {
        self.held = None;
    }

    #[cfg(test)]
    pub(super) fn read_back(&mut self, device: &Device) -> Result<rara_scene::picture::Picture> {
        self.stored(device, |stored| stored.decode())
    }

    /// Does something with the bytes of the picture, which are where the host can read them.
    pub(super) fn stored<R>(
        &mut self,
        device: &Device,
        act: impl FnOnce(PictureBytes<'_>) -> R,
    ) -> Result<R> {
        let format = self.format;
        if let Some((tiles, extent)) = &self.tiles {
            let [begins, pixels] = TilePicture::sizes(*extent, format);
            return Ok(act(PictureBytes {
                begins: &read(device, &tiles.begins, begins)?,
                pixels: &read(device, &tiles.pixels, pixels)?,
                extent: *extent,
                format,
                linear: self.linear,
            }));
        }
        let Some(image) = &self.image else {
            return Err(Error::Invalid("nothing has been rendered yet".into()));
        };
        let extent = image.extent();
        let size = self.bytes(extent);
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
        let result = act(PictureBytes {
            begins: &[],
            pixels: &readback.mapped()[..size as usize],
            extent,
            format,
            linear: self.linear,
        });
        self.readback = Some(readback);
        Ok(result)
    }

    fn bytes(&self, extent: vk::Extent2D) -> u64 {
        u64::from(extent.width) * u64::from(extent.height) * self.format.pixel_bytes()
    }
}

/// The first bytes of a buffer: in place, where the host can read them.
fn read<'a>(device: &Device, buffer: &'a Buffer, size: u64) -> Result<Cow<'a, [u8]>> {
    Ok(match buffer.location() {
        Location::Readback => Cow::Borrowed(&buffer.mapped()[..size as usize]),
        _ => Cow::Owned(device.download_range(buffer, 0, size)?),
    })
}

fn extent(camera: &Camera) -> vk::Extent2D {
    vk::Extent2D {
        width: camera.width,
        height: camera.height,
    }
}

/// Colours that are equal to the bit are drawn alike, also where they are no numbers.
fn bits(background: Option<[f32; 3]>) -> Option<[u32; 3]> {
    background.map(|rgb| rgb.map(f32::to_bits))
}

pub(super) const fn vulkan_format(format: TargetFormat) -> vk::Format {
    match format {
        TargetFormat::Unorm8 => vk::Format::R8G8B8A8_UNORM,
        TargetFormat::Half => vk::Format::R16G16B16A16_SFLOAT,
        TargetFormat::Float => vk::Format::R32G32B32A32_SFLOAT,
    }
}

/// The format that takes a wanted one's place on a device: itself, or 16-bit floats, into which every device blends, where the
/// device cannot blend into 32-bit ones. Where it can they stay: GPUs may write them at half the rate, but dozens of blends into
/// 16-bit ones are off by 0.6 to 5 of 255 (the guide's chapter on testing), which is more than all else in a picture.
pub(super) fn blendable_on(device: &Device, wanted: TargetFormat) -> Result<TargetFormat> {
    let blends = |format: TargetFormat| {
        let features = device.format_features(vulkan_format(format));
        features.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND)
    };
    blendable(wanted, blends).ok_or_else(|| {
        Error::Device(format!(
            "this device cannot blend into pictures of {} bits a channel; choose another target format",
            bits_of(wanted)
        ))
    })
}

fn blendable(wanted: TargetFormat, blends: impl Fn(TargetFormat) -> bool) -> Option<TargetFormat> {
    let others: &[TargetFormat] = match wanted {
        TargetFormat::Float => &[TargetFormat::Half],
        _ => &[],
    };
    let mut candidates = [wanted].into_iter().chain(others.iter().copied());
    candidates.find(|format| blends(*format))
}

fn bits_of(format: TargetFormat) -> u64 {
    2 * format.pixel_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_bits_take_the_place_of_those_that_cannot_be_blended() {
        use TargetFormat::{Float, Half, Unorm8};
        let all = |_| true;
        let no_floats = |format| format != Float;
        assert_eq!(blendable(Float, all), Some(Float));
        assert_eq!(blendable(Float, no_floats), Some(Half));
        assert_eq!(blendable(Unorm8, no_floats), Some(Unorm8));
        assert_eq!(blendable(Half, |format| format == Unorm8), None);
    }
}
