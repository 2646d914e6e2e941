//! Pictures with channels beside the colours.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
    WritableImage,
};

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::file::PictureFormat;
use super::{Channel, Picture, npy};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::files::write_atomically;

/// Steps of a world unit in a 16-bit depth.
const DEPTH: f32 = 1000.0;

impl Picture {
    /// Writes the picture as [`save`](Self::save) does, with more channels beside its own.
    ///
    /// An `.exr` file holds them itself, as 32-bit floats; programs that know only colours read those. Beside a `.png` and a `.npy`
    /// each has a file of its own, called `NAME.depth.png` for the channel Z, `NAME.normal.png` for the three of N, and else as the
    /// channel is. A `.npy` has the numbers as they are, of rows and columns, and of three for N. A `.png` has 16 bits: depths in
    /// thousandths of a world unit, N from -1 to 1 as red, green and blue, `weight` from 0 to 1, `count` as it is, and `layer` from
    /// 1, with 0 where nothing is. What is beyond 16 bits is the most they hold.
    ///
    /// # Errors
    /// [`Error::Format`] for another ending, [`Error::Io`] if a file can't be written, and [`Error::Invalid`] for a channel that has
    /// not a number for each pixel, or the name of another one, and for one that has no 16 bits.
    pub fn save_with(&self, path: impl AsRef<Path>, channels: &[Channel]) -> Result<()> {
        let path = path.as_ref();
        for (at, Channel { name, values }) in channels.iter().enumerate() {
            if values.len() != self.pixels.len() {
                return Err(Error::Invalid(format!(
                    "channel '{name}' has {} for {}",
                    counted(values.len(), "number"),
                    counted(self.pixels.len(), "pixel")
                )));
            }
            let mut others = ["R", "G", "B", "A"].into_iter();
            let mut before = channels[..at].iter();
            if others.any(|other| other == name) || before.any(|other| other.name == *name) {
                return Err(Error::Invalid(format!("two channels are called '{name}'")));
            }
        }
        let format = PictureFormat::from_path(path)?;
        if format == PictureFormat::Exr {
            return self.save_exr(path, channels);
        }
        // The colours come last: where they are, all is.
        for group in channels.chunk_by(|a, b| group(a) == group(b)) {
            let bytes = match format {
                PictureFormat::Npy => self.npy(group),
                PictureFormat::Png | PictureFormat::Exr => self.png16(group, path)?,
            };
            let ending = path.extension().unwrap_or_default().to_string_lossy();
            let name = match self::group(&group[0]) {
                "Z" => "depth",
                "N" => "normal",
                other => other,
            };
            let file = path.with_extension(format!("{name}.{ending}"));
            write_atomically(&file, |out| out.write_all(&bytes))?;
        }
        self.save(path)
    }

    /// Channels of one file as an array.
    fn npy(&self, group: &[Channel]) -> Vec<u8> {
        let mut shape = vec![self.height as usize, self.width as usize];
        if group.len() > 1 {
            shape.push(group.len());
        }
        npy::encoded(&shape, &interleaved(group, |value| value))
    }

    /// Channels of one file in 16 bits each.
    fn png16(&self, group: &[Channel], path: &Path) -> Result<Vec<u8>> {
        let colour = match group.len() {
            3 => ExtendedColorType::Rgb16,
            _ => ExtendedColorType::L16,
        };
        let most = f32::from(u16::MAX);
        let bits: fn(f32) -> f32 = match self::group(&group[0]) {
            "Z" => |depth| depth * DEPTH,
            "N" if group.len() == 3 => |part| (0.5 * part + 0.5) * f32::from(u16::MAX),
            "weight" => |share| share * f32::from(u16::MAX),
            "count" => |count| count,
            "layer" => |layer| layer + 1.0,
            other => {
                return Err(Error::Invalid(format!(
                    "channel '{other}' has no form of 16 bits; name an .exr or a .npy"
                )));
            }
        };
        // `as` clamps, and makes 0 of what is not a number.
        let values = interleaved(group, |value| bits(value).round().min(most) as u16);
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new(&mut bytes);
        let encoded = encoder.write_image(
            bytemuck::cast_slice(&values),
            self.width,
            self.height,
            colour,
        );
        encoded.map_err(|error| {
            Error::format(path, format!("the picture could not be encoded: {error}"))
        })?;
        Ok(bytes)
    }

    fn save_exr(&self, path: &Path, channels: &[Channel]) -> Result<()> {
        let colours = ["R", "G", "B", "A"].into_iter().enumerate();
        let mut all: Vec<(&str, Vec<f32>)> = colours
            .map(|(at, name)| (name, self.pixels.iter().map(|pixel| pixel[at]).collect()))
            .collect();
        let more = channels.iter();
        all.extend(more.map(|channel| (&*channel.name, channel.values.clone())));
        let channel =
            |(name, values): (&str, Vec<f32>)| AnyChannel::new(name, FlatSamples::F32(values));
        let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = all.into_iter().map(channel).collect();
        let size = (self.width as usize, self.height as usize);
        let attributes = LayerAttributes::default();
        let layer = Layer::new(
            size,
            attributes,
            Encoding::FAST_LOSSLESS,
            AnyChannels::sort(list),
        );
        let mut bytes = Vec::new();
        let encoded = Image::from_layer(layer)
            .write()
            .to_buffered(Cursor::new(&mut bytes));
        encoded.map_err(|error| {
            Error::format(path, format!("the picture could not be encoded: {error}"))
        })?;
        write_atomically(path, |file| file.write_all(&bytes))
    }
}

/// What stands before the point in a name: channels with the same stand in one file.
fn group(channel: &Channel) -> &str {
    let name = &channel.name;
    name.split_once('.').map_or(name, |(before, _)| before)
}

/// The numbers pixel by pixel.
fn interleaved<T>(group: &[Channel], form: impl Fn(f32) -> T) -> Vec<T> {
    let pixels = 0..group[0].values.len();
    let numbers = pixels.flat_map(|at| group.iter().map(move |channel| channel.values[at]));
    numbers.map(form).collect()
}

#[cfg(test)]
mod tests;
