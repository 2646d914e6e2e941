//! A picture in memory: 32-bit float RGBA, premultiplied, row by row from the top left.

#[cfg(feature = "picture")]
mod channels;
mod cues;
#[cfg(feature = "picture")]
mod file;
#[cfg(feature = "ink")]
#[doc(hidden)]
pub mod ink;
mod light;
#[cfg(feature = "picture")]
mod npy;

pub use cues::{Cue, Cues};
#[cfg(feature = "picture")]
pub use file::PngCompression;
#[doc(hidden)]
pub use light::linear_light;

use rara_base::named;

/// RGBA pixels, 32-bit float, premultiplied, blended values as they are (no transfer function).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Picture {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels, row by row from the top left.
    pub pixels: Vec<[f32; 4]>,
}

named! {
    /// A quantity that a pixel can have beside its colour.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Aov {
        /// Channel Z: the mean depth of what the clip keeps, along the view axis, in world units; 0 in an empty pixel
        Depth = "depth",
        /// Channels N.X, N.Y, N.Z: the mean of the splats' thinnest axes, turned towards the eye, as a unit vector in world
        /// coordinates; 0 in an empty pixel
        Normal = "normal",
        /// Channel layer: the number, from 0, of the layer whose splats add most to alpha; -1 in an empty pixel
        Layer = "layer",
        /// Channel weight: the share of each splat that the clip keeps, as a mean over the pixel's splats; 0 in an empty pixel
        Weight = "weight",
        /// Channel count: the number of splats in the pixel, front to back, until the pixel is opaque
        Count = "count",
    }
}

/// A number for each pixel of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// The name of the channel in a file. It is not `R`, `G`, `B` or `A`.
    pub name: String,
    /// Row by row from the top left.
    pub values: Vec<f32>,
}

/// The size of a picture, `WxH`, which may be beyond what devices can draw.
#[doc(hidden)]
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(['x', 'X']);
    let sides = parts.and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    sides.ok_or_else(|| "expected a width and a height like 1024x768".into())
}

impl Picture {
    /// A picture of one colour.
    pub fn filled(width: u32, height: u32, pixel: [f32; 4]) -> Self {
        Self {
            width,
            height,
            pixels: vec![pixel; width as usize * height as usize],
        }
    }

    /// The pixel in column `x` of row `y`.
    pub fn at(&self, x: u32, y: u32) -> [f32; 4] {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The picture as a PNG keeps it: each pixel un-premultiplied, rounded to 8 bits, and premultiplied again.
    pub fn quantised(&self) -> Self {
        Self {
            pixels: self
                .pixels
                .iter()
                .map(|&pixel| premultiplied(to_bytes(pixel).map(from_byte)))
                .collect(),
            ..*self
        }
    }
}

/// A premultiplied pixel as PNG has it: colours divided by alpha, `round(255 c)`, clamped. Without alpha there is no
/// colour.
fn to_bytes([r, g, b, a]: [f32; 4]) -> [u8; 4] {
    let colour = |c: f32| if a > 0.0 { c / a } else { 0.0 };
    // `as` clamps, and makes 0 of what is not a number.
    [colour(r), colour(g), colour(b), a].map(|v| (255.0 * v).round() as u8)
}

/// An 8-bit value as a number from 0 to 1.
fn from_byte(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}

/// A pixel whose colours are multiplied by its alpha.
fn premultiplied([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    [r * a, g * a, b * a, a]
}

#[cfg(test)]
mod tests;
