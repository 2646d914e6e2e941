//! Pictures to files and back.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{
    DynamicImage, ExtendedColorType, ImageEncoder, ImageFormat, ImageReader, ImageResult, Limits,
};

use super::{Picture, npy, premultiplied, to_bytes};
use crate::camera::Camera;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::files::write_atomically;
use rara_base::named;

/// The kinds of picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PictureFormat {
    /// 8-bit RGBA, un-premultiplied.
    Png,
    /// 32-bit float RGBA, premultiplied.
    Exr,
    /// 32-bit float RGBA, premultiplied, as a NumPy array of rows, columns and four channels.
    Npy,
}

impl PictureFormat {
    pub(super) fn from_path(path: &Path) -> Result<Self> {
        let extension = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            "npy" => Ok(Self::Npy),
            _ => Err(Error::format(
                path,
                "the name of a picture must end in .png (8 bits), .exr or .npy (32-bit float)",
            )),
        }
    }
}

named! {
    /// The compression of a `.png` file. No choice loses anything.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum PngCompression {
        /// The file is not compressed.
        None = "none",
        /// The file is compressed quickly.
        #[default]
        Fast = "fast",
        /// The file is compressed to the fewest bytes.
        Small = "small",
    }
}

impl Picture {
    /// Writes the picture to a file; its extension chooses the format. `.png` is 8-bit RGBA, un-premultiplied, `round(255 c)`
    /// clamped. `.exr` is 32-bit float RGBA, premultiplied, with the values as they are. `.npy` has the same numbers as a NumPy
    /// array of rows, columns and four channels. The file is written completely or not at all.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let kind = PictureFormat::from_path(path)?;
        let encoded = self.encoded(kind, PngCompression::default());
        let bytes = encoded.map_err(|error| {
            Error::format(path, format!("the picture could not be encoded: {error}"))
        })?;
        write_atomically(path, |file| file.write_all(&bytes))
    }

    /// The bytes of a `.png` file, as [`save`](Self::save) writes it.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a picture with another number of pixels than its size says.
    pub fn to_png(&self) -> Result<Vec<u8>> {
        self.to_png_with(PngCompression::default())
    }

    /// Returns the bytes of a `.png` with this compression.
    ///
    /// # Errors
    /// The errors of [`to_png`](Self::to_png).
    pub fn to_png_with(&self, compression: PngCompression) -> Result<Vec<u8>> {
        let count = u64::from(self.width) * u64::from(self.height);
        if self.pixels.len() as u64 != count {
            return Err(Error::Invalid(format!(
                "a picture of {}x{} has {}; give it one for each place",
                self.width,
                self.height,
                counted(self.pixels.len(), "pixel")
            )));
        }
        let encoded = self.encoded(PictureFormat::Png, compression);
        encoded
            .map_err(|error| Error::Invalid(format!("the picture could not be encoded: {error}")))
    }

    /// The bytes of the pixels as a `.png` file has them, row by row from the top left: red, green, blue and alpha, 8 bits each,
    /// un-premultiplied, `round(255 c)` clamped.
    pub fn to_rgba8(&self) -> Vec<u8> {
        self.pixels
            .iter()
            .flat_map(|&pixel| to_bytes(pixel))
            .collect()
    }

    fn encoded(&self, kind: PictureFormat, compression: PngCompression) -> ImageResult<Vec<u8>> {
        let mut bytes = Vec::new();
        let (width, height) = (self.width, self.height);
        match kind {
            PictureFormat::Png => {
                let compression = match compression {
                    PngCompression::None => CompressionType::Uncompressed,
                    PngCompression::Fast => CompressionType::Fast,
                    PngCompression::Small => CompressionType::Best,
                };
                PngEncoder::new_with_quality(&mut bytes, compression, FilterType::Adaptive)
                    .write_image(&self.to_rgba8(), width, height, ExtendedColorType::Rgba8)
            }
            PictureFormat::Exr => {
                let pixels = bytemuck::cast_slice(&self.pixels);
                let encoder = OpenExrEncoder::new(Cursor::new(&mut bytes));
                encoder.write_image(pixels, width, height, ExtendedColorType::Rgba32F)
            }
            PictureFormat::Npy => {
                let shape = [height as usize, width as usize, 4];
                bytes = npy::encoded(&shape, bytemuck::cast_slice(&self.pixels));
                Ok(())
            }
        }?;
        Ok(bytes)
    }

    /// Reads a picture that [`save`](Self::save) (or anyone else) wrote. PNG pixels are premultiplied; a file without
    /// alpha is opaque. The file's content decides its kind, not its name.
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let file = BufReader::new(File::open(path).map_err(Error::io(path))?);
        let mut reader = ImageReader::new(file)
            .with_guessed_format()
            .map_err(Error::io(path))?;
        let straight = match reader.format() {
            Some(ImageFormat::Png) => true,
            Some(ImageFormat::OpenExr) => false,
            _ => {
                return Err(Error::format(
                    path,
                    "this is neither a PNG nor an OpenEXR picture",
                ));
            }
        };
        let mut limits = Limits::no_limits();
        limits.max_image_width = Some(Camera::MAX_SIZE);
        limits.max_image_height = Some(Camera::MAX_SIZE);
        reader.limits(limits);
        let image = reader.decode();
        let image = image.map_err(|error| {
            Error::format(path, format!("the picture cannot be decoded: {error}"))
        })?;
        Ok(Self::from_image(image, straight))
    }

    fn from_image(image: DynamicImage, straight: bool) -> Self {
        let image = image.into_rgba32f();
        let pixels = image.pixels().map(|pixel| {
            if straight {
                premultiplied(pixel.0)
            } else {
                pixel.0
            }
        });
        Self {
            width: image.width(),
            height: image.height(),
            pixels: pixels.collect(),
        }
    }
}

#[cfg(test)]
mod tests;
