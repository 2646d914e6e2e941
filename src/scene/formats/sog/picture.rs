//! The pixels of a WebP picture that was compressed without loss.

use std::io::Cursor;

use image_webp::WebPDecoder;

use super::Failure;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// A picture: red, green, blue and alpha of each pixel.
pub(super) struct Picture {
    pub(super) width: usize,
    pixels: Vec<[u8; 4]>,
}

/// Pixels that the picture of so many Gaussians may have: at most four times as many, or a small picture.
pub(super) fn most(gaussians: u64) -> usize {
    usize::try_from(gaussians.saturating_mul(4))
        .unwrap_or(usize::MAX)
        .max(1 << 16)
}

impl Picture {
    /// Decodes a picture of at most `most` pixels; `name` stands for it in messages.
    pub(super) fn decode(bytes: &[u8], name: &str, most: usize) -> Result<Self, Failure> {
        let name = shortened(name);
        let damaged = |error: image_webp::DecodingError| {
            let error = shortened(&error.to_string());
            Failure::Format(format!(
                "the picture {name} is damaged or no WebP ({error}); get the scene again"
            ))
        };
        let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        let count = u64::from(width) * u64::from(height);
        if count > most as u64 || count == 0 {
            return Err(Failure::Format(format!(
                "the picture {name} has {width}x{height} pixels, which do not fit what meta.json says; get the scene again"
            )));
        }
        if decoder.is_lossy() || decoder.is_animated() {
            return Err(Failure::Format(format!(
                "the picture {name} was compressed with loss, which destroys what it stands for; export the scene again, \
                 without loss"
            )));
        }
        let memory = || {
            Failure::Memory(format!(
                "the {} of the picture {name}",
                counted(count, "pixel")
            ))
        };
        let channels = if decoder.has_alpha() { 4 } else { 3 };
        let mut plain = Vec::new();
        let size = count as usize * channels;
        plain.try_reserve_exact(size).map_err(|_| memory())?;
        plain.resize(size, 0);
        decoder.read_image(&mut plain).map_err(damaged)?;
        let mut pixels = Vec::new();
        pixels
            .try_reserve_exact(count as usize)
            .map_err(|_| memory())?;
        let pixel = |p: &[u8]| [p[0], p[1], p[2], p.get(3).copied().unwrap_or(255)];
        pixels.extend(plain.chunks_exact(channels).map(pixel));
        Ok(Self {
            width: width as usize,
            pixels,
        })
    }

    /// Row by row.
    pub(super) fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// The pixel of a number below their count.
    pub(super) fn at(&self, index: usize) -> [u8; 4] {
        self.pixels[index]
    }
}
