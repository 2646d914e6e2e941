//! `cameras.bin`, `images.bin` and `points3D.bin`: little endian, each count checked against the file's size before it is believed.

use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use glam::{DQuat, DVec3};

use super::colmap_model::{ColmapImage, Lens, Lenses, MODELS};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// Longest picture name we read; paths are shorter on every system.
const MAX_NAME: u64 = 4096;
/// A 2D point of a picture: x, y and the 3D point's number. We skip them.
const POINT_SIZE: u64 = 24;

struct Records<'a, R> {
    path: &'a Path,
    reader: BufReader<R>,
    size: u64,
    left: u64,
}

/// The cameras up to the first whose model we do not know: how long that is, no one says.
pub(super) fn lenses<R: Read + Seek>(source: R, path: &Path) -> Result<Lenses> {
    let mut records = Records::new(source, path)?;
    let count = records.count("cameras", 24 + 3 * 8)?;
    let mut lenses = Vec::with_capacity(count);
    for _ in 0..count {
        let id = u32::from_le_bytes(records.bytes()?);
        let number = i32::from_le_bytes(records.bytes()?);
        let width = u64::from_le_bytes(records.bytes()?) as f64;
        let height = u64::from_le_bytes(records.bytes()?) as f64;
        let model = usize::try_from(number)
            .ok()
            .and_then(|number| MODELS.get(number));
        let parameters = model.map_or(0, |model| model.parameters);
        let parameters = (0..parameters).map(|_| records.number());
        lenses.push(Lens {
            id,
            model: model.ok_or_else(|| number.to_string()),
            width,
            height,
            parameters: parameters.collect::<Result<_>>()?,
        });
        if model.is_none() {
            let rest = format!(
                "it stands behind camera {id} of the unknown model {number}, whose length is not known either; write the model as \
                 text (colmap model_converter)"
            );
            return Ok(Lenses {
                lenses,
                rest: Some(rest),
            });
        }
    }
    Ok(Lenses { lenses, rest: None })
}

pub(super) fn images<R: Read + Seek>(source: R, path: &Path) -> Result<Vec<ColmapImage>> {
    let mut records = Records::new(source, path)?;
    let count = records.count("pictures", 4 + 7 * 8 + 4 + 1 + 8)?;
    let mut images = Vec::with_capacity(count);
    for _ in 0..count {
        let _id: [u8; 4] = records.bytes()?;
        let [w, x, y, z] = records.numbers()?;
        let translation: DVec3 = records.numbers()?.into();
        let lens = u32::from_le_bytes(records.bytes()?);
        let name = records.name()?;
        let points = u64::from_le_bytes(records.bytes()?);
        records.skip(points.saturating_mul(POINT_SIZE))?;
        images.push(ColmapImage {
            name,
            lens,
            rotation: DQuat::from_xyzw(x, y, z, w),
            translation,
        });
    }
    Ok(images)
}

/// The positions of the model's points.
pub(super) fn points<R: Read + Seek>(source: R, path: &Path) -> Result<Vec<DVec3>> {
    /// Its colour, its error and, for each picture that shows it, two numbers.
    const COLOUR_AND_ERROR: u64 = 3 + 8;
    const VIEW_SIZE: u64 = 8;
    let mut records = Records::new(source, path)?;
    let count = records.count("points", 8 + 3 * 8 + COLOUR_AND_ERROR + 8)?;
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        let _id: [u8; 8] = records.bytes()?;
        points.push(records.numbers()?.into());
        records.skip(COLOUR_AND_ERROR)?;
        let views = u64::from_le_bytes(records.bytes()?);
        records.skip(views.saturating_mul(VIEW_SIZE))?;
    }
    Ok(points)
}

impl<'a, R: Read + Seek> Records<'a, R> {
    fn new(mut source: R, path: &'a Path) -> Result<Self> {
        let size = source.seek(SeekFrom::End(0)).map_err(Error::io(path))?;
        source.rewind().map_err(Error::io(path))?;
        Ok(Self {
            path,
            reader: BufReader::new(source),
            size,
            left: size,
        })
    }

    fn error(&self, message: &str) -> Error {
        Error::format(
            self.path,
            format!("byte {}: {message}", self.size - self.left),
        )
    }

    /// The number of records that follow, each of which takes at least `least` bytes.
    fn count(&mut self, what: &str, least: u64) -> Result<usize> {
        let count = u64::from_le_bytes(self.bytes()?);
        match usize::try_from(count) {
            Ok(fits) if count <= self.left / least => Ok(fits),
            _ => Err(self.error(&format!(
                "the file promises {count} {what}, but has only {}; it is cut off or no COLMAP model",
                counted(self.size, "byte")
            ))),
        }
    }

    fn take(&mut self, bytes: u64) -> Result<()> {
        let left = self.left.checked_sub(bytes).ok_or_else(|| {
            self.error("the file ends inside a record; it is cut off, export the model again")
        })?;
        self.left = left;
        Ok(())
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N]> {
        self.take(N as u64)?;
        let mut bytes = [0; N];
        self.reader
            .read_exact(&mut bytes)
            .map_err(Error::io(self.path))?;
        Ok(bytes)
    }

    fn number(&mut self) -> Result<f64> {
        Ok(f64::from_le_bytes(self.bytes()?))
    }

    fn numbers<const N: usize>(&mut self) -> Result<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number()?;
        }
        Ok(numbers)
    }

    /// Text up to a zero byte.
    fn name(&mut self) -> Result<String> {
        let mut name = Vec::new();
        let limit = MAX_NAME.min(self.left);
        (&mut self.reader)
            .take(limit)
            .read_until(0, &mut name)
            .map_err(Error::io(self.path))?;
        if name.pop() != Some(0) {
            return Err(self.error(
                "a picture's name does not end; this is not a COLMAP model, or it is cut off",
            ));
        }
        self.take(name.len() as u64 + 1)?;
        Ok(String::from_utf8_lossy(&name).into_owned())
    }

    fn skip(&mut self, bytes: u64) -> Result<()> {
        self.take(bytes)?;
        // `take` has checked it against the file's size, which fits.
        self.reader
            .seek_relative(bytes as i64)
            .map_err(Error::io(self.path))
    }
}
