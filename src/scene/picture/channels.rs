//! OpenEXR files with channels beside the colours.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
    WritableImage,
};

use super::{Channel, Picture};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::files::write_atomically;

impl Picture {
    /// Writes the picture to an `.exr` file as [`save`](Self::save) does, with more channels beside its own. All are of
    /// 32-bit floats, and programs that know only colours read those.
    ///
    /// # Errors
    /// [`Error::Format`] for a name that does not end in `.exr`, [`Error::Io`] if the file can't be written, and
    /// [`Error::Invalid`] for a channel that has not a number for each pixel, or the name of another one.
    pub fn save_with(&self, path: impl AsRef<Path>, channels: &[Channel]) -> Result<()> {
        let path = path.as_ref();
        let is_exr = path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("exr"));
        if !is_exr {
            let message = "the name of a picture with more channels must end in .exr";
            return Err(Error::format(path, message));
        }
        let colours = ["R", "G", "B", "A"].into_iter().enumerate();
        let mut all: Vec<(&str, Vec<f32>)> = colours
            .map(|(at, name)| (name, self.pixels.iter().map(|pixel| pixel[at]).collect()))
            .collect();
        for Channel { name, values } in channels {
            if values.len() != self.pixels.len() {
                return Err(Error::Invalid(format!(
                    "channel '{name}' has {} for {}",
                    counted(values.len(), "number"),
                    counted(self.pixels.len(), "pixel")
                )));
            }
            if all.iter().any(|(other, _)| other == name) {
                return Err(Error::Invalid(format!("two channels are called '{name}'")));
            }
            all.push((name, values.clone()));
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{ReadChannels, ReadLayers, read};

    #[test]
    fn channels_stand_beside_the_colours() {
        let folder = std::env::temp_dir().join(format!("rara-channels-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let pixel = |i: u16| [f32::from(i), 0.25, -1.0, 0.5];
        let picture = Picture {
            width: 3,
            height: 2,
            pixels: (0..6).map(pixel).collect(),
        };
        let channel = |name: &str, values: Vec<f32>| Channel {
            name: name.into(),
            values,
        };
        let depth = channel("Z", vec![0.0, 1.5, 2.5, 1e30, -1.0, 0.1]);
        let path = folder.join("a.exr");
        picture
            .save_with(&path, std::slice::from_ref(&depth))
            .expect("writes");
        assert_eq!(Picture::load(&path).expect("reads"), picture);
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels();
        let image = image.first_valid_layer().all_attributes().from_file(&path);
        let list = image.expect("an OpenEXR file").layer_data.channel_data.list;
        let names: Vec<String> = list.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["A", "B", "G", "R", "Z"]);
        let values: Vec<f32> = list[4].sample_data.values_as_f32().collect();
        assert_eq!(values, depth.values);

        for (name, channels, says) in [
            ("a.png", vec![], ".exr"),
            (
                "b.exr",
                vec![channel("Z", vec![0.0; 5])],
                "5 numbers for 6 pixels",
            ),
            ("b.exr", vec![channel("R", vec![0.0; 6])], "called 'R'"),
        ] {
            let error = picture.save_with(folder.join(name), &channels);
            let error = error.expect_err(says).to_string();
            assert!(error.contains(says), "{error}");
        }
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1);
        std::fs::remove_dir_all(&folder).expect("ours");
    }
}
