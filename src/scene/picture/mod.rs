//! A picture in memory: 32-bit float RGBA, premultiplied, row by row from the top left.

#[cfg(feature = "picture")]
mod channels;
mod cues;
#[cfg(feature = "picture")]
mod file;
mod light;
#[cfg(feature = "picture")]
mod npy;

pub use cues::{Cue, Cues};
#[cfg(feature = "picture")]
pub use file::PngCompression;
#[doc(hidden)]
pub use light::linear_light;

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

/// A quantity that a pixel can have beside its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Aov {
    /// Channel Z: the mean depth of what is left, along the view axis, world units; 0 where nothing is
    Depth,
    /// Channels N.X, N.Y, N.Z: the mean direction of the splats' thinnest axes, turned to the eye, in the world, of length one;
    /// 0 where nothing is
    Normal,
    /// Channel layer: the number of the layer, from 0, whose splats add most to alpha; -1 where nothing is
    Layer,
    /// Channel weight: the mean share that the clip leaves of the splats, 1 where it cuts none; 0 where nothing is
    Weight,
    /// Channel count: how many splats make the pixel, until it is saturated
    Count,
}

/// A number for each pixel of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its name in a file, not one of `R`, `G`, `B` and `A`.
    pub name: String,
    /// Row by row from the top left.
    pub values: Vec<f32>,
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
mod tests {
    use super::*;

    #[test]
    fn bytes_are_unpremultiplied_rounded_and_clamped() {
        assert_eq!(to_bytes([0.25, 0.0, 0.5, 0.5]), [128, 0, 255, 128]);
        assert_eq!(to_bytes([0.9, -1.0, 0.5, 0.5]), [255, 0, 255, 128]);
        assert_eq!(to_bytes([0.3, 0.3, 0.3, 0.0]), [0; 4]);
        assert_eq!(to_bytes([f32::NAN, 1.0, 0.0, 1.0]), [0, 255, 0, 255]);
        // Just below and just above the middle between two levels.
        assert_eq!(
            to_bytes([100.49 / 255.0, 100.51 / 255.0, 0.0, 1.0])[..2],
            [100, 101]
        );
    }

    #[test]
    fn quantising_an_opaque_picture_moves_no_value_by_more_than_half_a_level_and_only_once() {
        let values = (0..1000).map(|i| i as f32 / 999.0);
        let picture = Picture {
            width: 1000,
            height: 1,
            pixels: values.map(|v| [v, 1.0 - v, v * v, 1.0]).collect(),
        };
        let once = picture.quantised();
        for (a, b) in picture
            .pixels
            .iter()
            .flatten()
            .zip(once.pixels.iter().flatten())
        {
            assert!((a - b).abs() <= 0.5 / 255.0 + 1e-6);
        }
        assert_eq!(once.quantised(), once);
    }
}
