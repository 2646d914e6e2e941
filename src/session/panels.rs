//! Opaque pictures that a window shows over its own: their bytes, and where they are copied to.

use ash::vk;

use rara_base::error::Result;
use rara_gpu::{Buffer, BufferDesc, Device, FRAMES, Location};
use rara_scene::picture::Picture;

/// A picture that [`Windowed`](super::Windowed) shows over its own, as for text. It is opaque: its alpha does not count.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Where its top left corner is, px from the window's. What lies beyond the window's edges is left out.
    pub at: (u32, u32),
    /// Its pixels, as the window's colours are stored.
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
pub(super) struct Panels {
    stored: Vec<PanelTexture>,
    /// A buffer a frame in flight, as large as the most bytes so far.
    buffers: [Option<Buffer>; FRAMES],
}

impl Panels {
    /// Takes these panels for the next frames, in images of this format.
    pub(super) fn set(&mut self, panels: &[Panel], format: vk::Format) {
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
    pub(super) fn write(
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
pub(super) fn are_possible(format: vk::Format) -> bool {
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
mod tests {
    use super::*;

    fn stored(at: (u32, u32), size: (u32, u32)) -> PanelTexture {
        let panel = Panel {
            at,
            picture: Picture::filled(size.0, size.1, [0.0, 0.5, 1.0, 0.0]),
        };
        let mut panels = Panels::default();
        panels.set(&[panel], vk::Format::B8G8R8A8_UNORM);
        panels.stored.remove(0)
    }

    #[test]
    fn pixels_are_stored_as_each_format_of_a_window_has_them() {
        let orange = [1.0, 0.5, 0.0, 0.0];
        let bytes = |format| packed(orange, format);
        assert_eq!(bytes(vk::Format::B8G8R8A8_UNORM), Some([0, 128, 255, 255]));
        assert_eq!(bytes(vk::Format::R8G8B8A8_UNORM), Some([255, 128, 0, 255]));
        let word = |format| bytes(format).map(u32::from_ne_bytes);
        assert_eq!(
            word(vk::Format::A2B10G10R10_UNORM_PACK32),
            Some(3 << 30 | 512 << 10 | 1023)
        );
        assert_eq!(
            word(vk::Format::A2R10G10B10_UNORM_PACK32),
            Some(3 << 30 | 1023 << 20 | 512 << 10)
        );
        assert!(!are_possible(vk::Format::R16G16B16A16_SFLOAT));
    }

    #[test]
    fn a_picture_without_its_pixels_is_left_out() {
        let mut picture = Picture::filled(4, 4, [0.0; 4]);
        picture.pixels.pop();
        let mut panels = Panels::default();
        panels.set(
            &[Panel {
                at: (0, 0),
                picture,
            }],
            vk::Format::B8G8R8A8_UNORM,
        );
        assert!(panels.stored.is_empty());
    }

    #[test]
    fn what_lies_beyond_the_window_is_left_out() {
        let window = (100, 50);
        assert_eq!(within(&stored((8, 8), (20, 10)), window), Some((20, 10)));
        assert_eq!(within(&stored((90, 45), (20, 10)), window), Some((10, 5)));
        assert_eq!(within(&stored((100, 0), (20, 10)), window), None);
        assert_eq!(within(&stored((0, u32::MAX), (20, 10)), window), None);
        assert_eq!(within(&stored((0, 0), (0, 10)), window), None);
        let region = copy(16, &stored((90, 45), (20, 10)), (10, 5));
        assert_eq!(
            (region.buffer_row_length, region.image_extent.width),
            (20, 10)
        );
    }

    #[test]
    fn panels_that_share_an_edge_do_not_overlap() {
        let first = stored((10, 10), (20, 10));
        for (at, meets) in [
            ((30, 10), false),
            ((29, 19), true),
            ((10, 20), false),
            ((0, 0), false),
            ((0, 1), true),
        ] {
            let other = stored(at, (11, 10));
            assert_eq!(overlap(&first, &other), meets, "{at:?}");
            assert_eq!(overlap(&other, &first), meets, "{at:?}");
        }
    }
}
