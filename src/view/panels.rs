//! Opaque pictures that a window shows over its own: their bytes, and where they are copied to.

use crate::in_flight::FRAMES;
use rara::ash::vk;
use rara::{Picture, Result};
use rara_gpu::{Buffer, BufferDesc, Device, Location};

/// A picture that [`Windowed`](super::Windowed) shows over its own, as for text. It is opaque: its alpha does not count.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The position of the panel's top left corner, in px from the window's. Parts beyond the edges of the window are not
    /// drawn.
    pub at: (u32, u32),
    /// The pixels of the panel, encoded like the colours of the window.
    pub picture: Picture,
}

/// Where the bytes of each panel begin: a multiple of the bytes of any pixel.
const ALIGNMENT: usize = 16;

/// A panel as the window's images store it.
struct PanelTexture {
    at: (u32, u32),
    size: (u32, u32),
    bytes: Vec<u8>,
}

#[derive(Default)]
pub(crate) struct Panels {
    stored: Vec<PanelTexture>,
    /// The picture in the scene's place, if there is one.
    cover: Option<PanelTexture>,
    /// A buffer a frame in flight, as large as the most bytes so far.
    buffers: [Option<Buffer>; FRAMES],
}

impl Panels {
    /// Takes these panels for the next frames, in images of this format.
    pub(crate) fn set(&mut self, panels: &[Panel], format: vk::Format) {
        let stored = |panel: &Panel| stored(panel.at, &panel.picture, format);
        self.stored = panels.iter().filter_map(stored).collect();
    }

    /// Takes a picture in the scene's place for the next frames that have its size, in images of this format.
    pub(crate) fn set_cover(&mut self, picture: Option<&Picture>, format: vk::Format) {
        self.cover = picture.and_then(|picture| stored((0, 0), picture, format));
    }

    /// Puts cover and panels of a frame in place, before it is recorded, for an image of this size; nothing where no image can be
    /// copied to. The last frame of this number has been waited for.
    pub(crate) fn write(
        &mut self,
        device: &Device,
        frame: usize,
        size: Option<(u32, u32)>,
    ) -> Result<Option<WrittenPanels<'_>>> {
        let cover = self.cover.as_ref().filter(|cover| Some(cover.size) == size);
        let mut copies = Vec::new();
        let mut shown: Vec<&PanelTexture> = Vec::new();
        let mut offset = cover.map_or(0, PanelTexture::room);
        for panel in &self.stored {
            let Some(extent) = size.and_then(|size| within(panel, size)) else {
                continue;
            };
            // Copies of one command have no order, so that one pixel is written once.
            if shown.iter().any(|other| overlap(panel, other)) {
                continue;
            }
            copies.push(copy(offset, panel, extent));
            offset += panel.room();
            shown.push(panel);
        }
        if offset == 0 {
            return Ok(None);
        }
        let place = &mut self.buffers[frame];
        let buffer = match place.take().filter(|buffer| buffer.size() >= offset as u64) {
            Some(buffer) => buffer,
            None => device.create_buffer(&BufferDesc {
                name: "panels",
                size: (offset as u64).next_power_of_two(),
                location: Location::Upload,
            })?,
        };
        let buffer = place.insert(buffer);
        let mut mapped = buffer.mapped_mut();
        let cover = cover.map(|cover| {
            mapped.write(0, &cover.bytes);
            copy(0, cover, cover.size)
        });
        for (panel, copy) in shown.iter().zip(&copies) {
            mapped.write(copy.buffer_offset as usize, &panel.bytes);
        }
        Ok(Some(WrittenPanels {
            buffer,
            cover,
            copies,
        }))
    }
}

/// Cover and panels of a frame, and the buffer that they are in.
pub(crate) struct WrittenPanels<'a> {
    buffer: &'a Buffer,
    cover: Option<vk::BufferImageCopy>,
    copies: Vec<vk::BufferImageCopy>,
}

impl WrittenPanels<'_> {
    /// The copy of the cover, which is of all of the image.
    pub(crate) fn cover(&self) -> Option<(&Buffer, &vk::BufferImageCopy)> {
        Some((self.buffer, self.cover.as_ref()?))
    }

    /// The copies of the panels, if there are any.
    pub(crate) fn panels(&self) -> Option<(&Buffer, &[vk::BufferImageCopy])> {
        (!self.copies.is_empty()).then_some((self.buffer, &self.copies[..]))
    }
}

impl PanelTexture {
    /// The bytes from its beginning to that of the next one.
    fn room(&self) -> usize {
        self.bytes.len().next_multiple_of(ALIGNMENT)
    }
}

/// A picture as images of a format store it; `None` for another format than those of windows, and for a picture that has not as many
/// pixels as its size says, since a copy reads so many.
fn stored(at: (u32, u32), picture: &Picture, format: vk::Format) -> Option<PanelTexture> {
    let Picture { width, height, .. } = *picture;
    if picture.pixels.len() as u64 != u64::from(width) * u64::from(height) {
        return None;
    }
    let bytes = picture.pixels.iter().map(|pixel| packed(*pixel, format));
    Some(PanelTexture {
        at,
        size: (width, height),
        bytes: bytes.collect::<Option<Vec<_>>>()?.concat(),
    })
}

/// True where a window of this format can show panels.
pub(crate) fn are_possible(format: vk::Format) -> bool {
    packed([0.0; 4], format).is_some()
}

/// A pixel as images of the formats that windows have store it; `None` of another format.
fn packed([r, g, b, _]: [f32; 4], format: vk::Format) -> Option<[u8; 4]> {
    let unorm = |v: f32, most: f32| (v.clamp(0.0, 1.0) * most).round() as u32;
    let [r8, g8, b8] = [r, g, b].map(|v| unorm(v, 255.0) as u8);
    let [r10, g10, b10] = [r, g, b].map(|v| unorm(v, 1023.0));
    match format {
        vk::Format::B8G8R8A8_UNORM => Some([b8, g8, r8, 255]),
        vk::Format::R8G8B8A8_UNORM | vk::Format::A8B8G8R8_UNORM_PACK32 => Some([r8, g8, b8, 255]),
        vk::Format::A2B10G10R10_UNORM_PACK32 => {
            Some((3 << 30 | b10 << 20 | g10 << 10 | r10).to_ne_bytes())
        }
        vk::Format::A2R10G10B10_UNORM_PACK32 => {
            Some((3 << 30 | r10 << 20 | g10 << 10 | b10).to_ne_bytes())
        }
        _ => None,
    }
}

/// How much of a panel is within a window of this size, from the panel's corner; `None` for nothing.
fn within(panel: &PanelTexture, (width, height): (u32, u32)) -> Option<(u32, u32)> {
    let across = panel.size.0.min(width.saturating_sub(panel.at.0));
    let down = panel.size.1.min(height.saturating_sub(panel.at.1));
    (across > 0 && down > 0).then_some((across, down))
}

fn overlap(a: &PanelTexture, b: &PanelTexture) -> bool {
    let meet = |from: u32, size: u32, other: u32, others: u32| {
        u64::from(from) < u64::from(other) + u64::from(others)
            && u64::from(other) < u64::from(from) + u64::from(size)
    };
    meet(a.at.0, a.size.0, b.at.0, b.size.0) && meet(a.at.1, a.size.1, b.at.1, b.size.1)
}

fn copy(offset: usize, panel: &PanelTexture, (width, height): (u32, u32)) -> vk::BufferImageCopy {
    // Within the window, whose size is far below this type's limit.
    let at = |v: u32| i32::try_from(v).expect("it is within the window");
    vk::BufferImageCopy::default()
        .buffer_offset(offset as u64)
        .buffer_row_length(panel.size.0)
        .image_subresource(
            vk::ImageSubresourceLayers::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .layer_count(1),
        )
        .image_offset(vk::Offset3D {
            x: at(panel.at.0),
            y: at(panel.at.1),
            z: 0,
        })
        .image_extent(vk::Extent3D {
            width,
            height,
            depth: 1,
        })
}

#[cfg(test)]
mod tests;
