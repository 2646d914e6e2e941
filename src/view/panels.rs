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
    /// A buffer a frame in flight, as large as the most bytes so far.
    buffers: [Option<Buffer>; FRAMES],
}

impl Panels {
    /// Takes these panels for the next frames, in images of this format.
    pub(crate) fn set(&mut self, panels: &[Panel], format: vk::Format) {
        let stored = |panel: &Panel| {
            let Picture { width, height, .. } = panel.picture;
            let pixels = panel.picture.pixels.iter();
            // A copy reads as many pixels as the size says.
            if pixels.len() as u64 != u64::from(width) * u64::from(height) {
                return None;
            }
            Some(PanelTexture {
                at: panel.at,
                size: (width, height),
                bytes: pixels
                    .map(|pixel| packed(*pixel, format))
                    .collect::<Option<Vec<_>>>()?
                    .concat(),
            })
        };
        self.stored = panels.iter().filter_map(stored).collect();
    }

    /// Puts the panels of a frame in place, before it is recorded: the buffer they are in, and the copies to an image of this
    /// size; nothing where no image can be copied to. The last frame of this number has been waited for.
    pub(crate) fn write(
        &mut self,
        device: &Device,
        frame: usize,
        size: Option<(u32, u32)>,
    ) -> Result<Option<(&Buffer, Vec<vk::BufferImageCopy>)>> {
        let mut copies = Vec::new();
        let mut shown: Vec<&PanelTexture> = Vec::new();
        let mut offset = 0;
        for panel in &self.stored {
            let Some(extent) = size.and_then(|size| within(panel, size)) else {
                continue;
            };
            // Copies of one command have no order, so that one pixel is written once.
            if shown.iter().any(|other| overlap(panel, other)) {
                continue;
            }
            copies.push(copy(offset, panel, extent));
            offset += panel.bytes.len().next_multiple_of(ALIGNMENT);
            shown.push(panel);
        }
        if copies.is_empty() {
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
        for (panel, copy) in shown.iter().zip(&copies) {
            mapped.write(copy.buffer_offset as usize, &panel.bytes);
        }
        Ok(Some((buffer, copies)))
    }
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
