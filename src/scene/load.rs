//! A scene from a file of any format that is known.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::{Gaussians, LoadReport, Property, ply};
use crate::error::{Error, Result};

/// A file format of scenes.
pub(super) struct Format {
    /// True for a file of the format, by its first bytes, or by its name where the format has none of its own.
    pub(super) is: fn(&[u8], &Path) -> bool,
    /// Reads a whole file, of which nothing has been read yet, with the properties that are asked for. The name stands for
    /// it in messages.
    pub(super) read: Reader,
}

/// How a format reads.
type Reader =
    fn(&mut dyn Source, &Path, &[&str], &mut Progress<'_>) -> Result<(Loaded, Vec<Property>)>;

/// All that are known. What is of none is read as the first, which says what is wrong with it.
const FORMATS: [&Format; 1] = [&ply::FORMAT];

/// Bytes that a format is recognised by, at most.
const START: u64 = 64;

/// A source that a scene is read from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// A scene as loaded, and what the loader did to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub gaussians: Gaussians,
    /// Elements that were dropped or repaired.
    pub report: LoadReport,
}

/// Loads a 3DGS `.ply` file: ascii or binary of either byte order, spherical harmonics of degree 0 to 3, properties of
/// any type in any order; properties and elements that are no part of a Gaussian are ignored.
///
/// Peak memory is the scene itself plus a few MiB. `progress` is called now and then with the bytes read so far and
/// the file's size, last with both equal. A `vertex` element of zero Gaussians is an empty scene, not an error.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it is not a scene or is cut off, [`Error::Memory`] if
/// it doesn't fit. Single bad elements are no error: see [`LoadReport`].
pub fn load(path: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<Loaded> {
    load_with(path, &[], progress).map(|(loaded, _)| loaded)
}

/// Loads a scene as [`load`] does, and with it the values of some of the properties that its `vertex` element has beside
/// those of a Gaussian, such as a label; they have to be numbers, of any type. Each takes 8 bytes a Gaussian; what is not
/// asked for takes nothing.
///
/// # Errors
/// As [`load`], and [`Error::Format`] for a property that the file has not, that is a list or that a Gaussian is made of.
pub fn load_with(
    path: &Path,
    properties: &[&str],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(Loaded, Vec<Property>)> {
    // Before opening it, which would wait for a pipe's writer.
    let metadata = std::fs::metadata(path).map_err(Error::io(path))?;
    if !metadata.is_file() {
        return Err(Error::format(
            path,
            "this is a folder or a device, not a file; give a .ply file",
        ));
    }
    let file = File::open(path).map_err(Error::io(path))?;
    load_from_with(file, path, properties, progress)
}

/// Loads a scene from anything that can be read and sought in, such as an archive's entry in a
/// [`Cursor`](std::io::Cursor). `name` stands for it in messages. Otherwise like [`load`].
///
/// # Errors
/// As [`load`].
pub fn load_from<R: Read + Seek>(
    source: R,
    name: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Loaded> {
    load_from_with(source, name, &[], progress).map(|(loaded, _)| loaded)
}

/// Loads a scene as [`load_from`] does, with properties as [`load_with`] does.
///
/// # Errors
/// As [`load_with`].
pub fn load_from_with<R: Read + Seek>(
    mut source: R,
    name: &Path,
    properties: &[&str],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(Loaded, Vec<Property>)> {
    let total = source.seek(SeekFrom::End(0)).map_err(Error::io(name))?;
    source.rewind().map_err(Error::io(name))?;
    let mut start = Vec::new();
    let mut beginning = (&mut source).take(START);
    beginning.read_to_end(&mut start).map_err(Error::io(name))?;
    source.rewind().map_err(Error::io(name))?;
    let mut known = FORMATS.iter();
    let format = known.find(|format| (format.is)(&start, name));
    let format = format.unwrap_or(&FORMATS[0]);
    let mut progress = Progress {
        total,
        call: progress,
    };
    let loaded = (format.read)(&mut source, name, properties, &mut progress)?;
    progress.left(0);
    Ok(loaded)
}

/// The caller's progress callback; formats call it with the bytes that remain.
pub(super) struct Progress<'a> {
    total: u64,
    call: &'a mut dyn FnMut(u64, u64),
}

impl Progress<'_> {
    /// Bytes of the whole file.
    pub(super) fn total(&self) -> u64 {
        self.total
    }

    pub(super) fn left(&mut self, left: u64) {
        (self.call)(self.total.saturating_sub(left), self.total);
    }
}
