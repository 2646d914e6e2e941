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

/// The kinds of picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PictureFormat {
    /// 8-bit RGBA, un-premultiplied.
    Png,
    /// 32-bit float RGBA, premultiplied.
    Exr,
    /// The same as an array of NumPy, of rows, columns and four.
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

/// How a `.png` file is compressed, without loss in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum PngCompression {
    /// Not at all.
    None,
    /// Quickly.
    #[default]
    Fast,
    /// To the fewest bytes.
    Small,
}

impl Picture {
    /// Writes the picture to a file whose extension says how: `.png` is 8-bit RGBA, un-premultiplied, `round(255 c)`
    /// clamped; `.exr` is 32-bit float RGBA, premultiplied, the values as they are, and `.npy` the same as an array of NumPy, of
    /// rows, columns and four. The file appears whole or not at all.
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

    /// The same with another compression.
    ///
    /// # Errors
    /// As [`to_png`](Self::to_png) has them.
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
mod tests {
    use super::*;

    /// A directory of its own for one test, removed at the end.
    struct Scratch(std::path::PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path =
                std::env::temp_dir().join(format!("rara-picture-{name}-{}", std::process::id()));
            std::fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    fn ramp() -> Picture {
        let pixel = |i: u32| {
            let alpha = (i % 7) as f32 / 6.0;
            [
                i as f32 / 34.0 * alpha,
                1.7 * alpha,
                0.1234567 * alpha,
                alpha,
            ]
        };
        Picture {
            width: 7,
            height: 5,
            pixels: (0..35).map(pixel).collect(),
        }
    }

    #[test]
    fn exr_keeps_every_bit_and_png_what_quantised_says() {
        let scratch = Scratch::new("round-trip");
        for (name, expected) in [("a.exr", ramp()), ("a.PNG", ramp().quantised())] {
            let path = scratch.0.join(name);
            ramp().save(&path).unwrap();
            assert_eq!(Picture::load(&path).unwrap(), expected, "{name}");
        }
        assert_eq!(
            std::fs::read_dir(&scratch.0).unwrap().count(),
            2,
            "nothing else is left in the folder"
        );
    }

    #[test]
    fn arrays_of_numpy_have_rows_of_columns_of_four() {
        let scratch = Scratch::new("npy");
        let path = scratch.0.join("a.npy");
        ramp().save(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let (header, values) = bytes.split_at(128);
        assert!(header.starts_with(b"\x93NUMPY\x01\0\x76\0{'descr': '<f4', 'fortran_order': False, 'shape': (5, 7, 4, ), }"));
        assert_eq!(header.last(), Some(&b'\n'));
        assert_eq!(values, bytemuck::cast_slice::<_, u8>(&ramp().pixels));
    }

    #[test]
    fn errors_name_the_file_and_leave_nothing_behind() {
        let scratch = Scratch::new("errors");
        let saved = ramp()
            .save(scratch.0.join("a.jpg"))
            .unwrap_err()
            .to_string();
        assert!(saved.contains("a.jpg") && saved.contains(".png"), "{saved}");
        assert!(ramp().save(scratch.0.join("no/such/folder.png")).is_err());
        let refused = |path: &Path, part: &str| {
            let error = Picture::load(path).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        };
        refused(&scratch.0.join("missing.png"), "missing.png");
        let broken = scratch.0.join("broken.png");
        std::fs::write(&broken, b"\x89PNG\r\n\x1a\n and no more").unwrap();
        refused(&broken, "cannot be decoded");
        std::fs::write(&broken, b"plain text").unwrap();
        refused(&broken, "neither");
        assert_eq!(std::fs::read_dir(&scratch.0).unwrap().count(), 1);
    }
}
