//! A scene from a file of any format that is known.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use glam::DVec3;

use super::{Annotations, Format, Gaussians, LoadReport, Property, Training, ply};
use rara_base::error::{Error, Result};

/// What a format reads: a file of which nothing has been read yet.
pub(super) struct Input<'a> {
    pub(super) source: &'a mut dyn Source,
    /// Stands for the file in messages.
    pub(super) name: &'a Path,
    /// The folder of the files that this one may name; none for a file in memory.
    pub(super) folder: Option<&'a Path>,
    /// The properties that are asked for.
    pub(super) properties: &'a [&'a str],
}

/// Bytes that a format is recognised by, at most.
const START: u64 = 4096;

/// A source that a scene is read from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// A scene as loaded, and what the loader did to it.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    /// The scene.
    pub gaussians: Gaussians,
    /// Elements that were dropped or repaired.
    pub report: LoadReport,
    /// The file's format.
    pub format: Format,
    /// What the file says of whether its Gaussians were trained [antialiased](Gaussians::is_antialiased); `None` where it
    /// says nothing.
    pub antialiased: Option<bool>,
    /// What a glTF file says around its Gaussians, such as names and `extras`; other formats say nothing.
    pub annotations: Option<Annotations>,
}

impl SceneFile {
    /// Notes what the file says of how its Gaussians were trained; they are drawn so.
    pub(super) fn says(&mut self, antialiased: Option<bool>, training: Training) {
        self.antialiased = antialiased;
        let antialiased = antialiased == Some(true);
        self.gaussians.train(training.antialiased(antialiased));
    }
}

/// Loads a scene from a file of any [format](Format), which is found by what is in the file, whatever its name.
///
/// Of 3DGS `.ply` files this reads ascii and binary of either byte order, spherical harmonics of degree 0 to 3, and
/// properties of any type in any order; properties and elements that are no part of a Gaussian are ignored. Scenes of several
/// files, as SOG that is not packed and `.gltf`, are loaded by the file that names the others; for SOG the folder does, too.
/// Where a format has other axes, as `.spz` and glTF have, they become those of a 3DGS `.ply`: right, down and forward.
///
/// Peak memory is the scene itself plus a few MiB, and for formats beside `.ply` the file and what it decompresses to.
/// `progress` is called now and then with the bytes read so far and the file's size, last with both equal. A file of zero
/// Gaussians is an empty scene, not an error.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it is not a scene or is cut off, [`Error::Memory`] if
/// it doesn't fit. Single bad elements are no error: see [`LoadReport`].
pub fn load(path: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<SceneFile> {
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
) -> Result<(SceneFile, Vec<Property>)> {
    // Before opening it, which would wait for a pipe's writer.
    let metadata = std::fs::metadata(path).map_err(Error::io(path))?;
    if let Some(file) = ["meta.json", "lod-meta.json"]
        .map(|name| path.join(name))
        .iter()
        .find(|f| f.is_file())
    {
        return load_with(file, properties, progress);
    }
    if !metadata.is_file() {
        return Err(Error::format(
            path,
            "this is a folder without the meta.json of a SOG scene, or a device; give a scene's file, such as a .ply",
        ));
    }
    let file = File::open(path).map_err(Error::io(path))?;
    read(file, path, path.parent(), properties, progress)
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
) -> Result<SceneFile> {
    load_from_with(source, name, &[], progress).map(|(loaded, _)| loaded)
}

/// Loads a scene as [`load_from`] does, with properties as [`load_with`] does.
///
/// # Errors
/// As [`load_with`].
pub fn load_from_with<R: Read + Seek>(
    source: R,
    name: &Path,
    properties: &[&str],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(SceneFile, Vec<Property>)> {
    read(source, name, None, properties, progress)
}

fn read<R: Read + Seek>(
    mut source: R,
    name: &Path,
    folder: Option<&Path>,
    properties: &[&str],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(SceneFile, Vec<Property>)> {
    let total = source.seek(SeekFrom::End(0)).map_err(Error::io(name))?;
    source.rewind().map_err(Error::io(name))?;
    let mut start = Vec::new();
    let mut beginning = (&mut source).take(START);
    beginning.read_to_end(&mut start).map_err(Error::io(name))?;
    source.rewind().map_err(Error::io(name))?;
    let mut progress = Progress::new(total, progress);
    let input = Input {
        source: &mut source,
        name,
        folder,
        properties,
    };
    // What is of no known format is read as a PLY, which says what is wrong with it, where no other format can be.
    let (mut loaded, properties) = match start.starts_with(b"ply") {
        true => ply::read(input, &mut progress)?,
        false => super::formats::read(&start, input, &mut progress)?,
    };
    let origin = loaded.gaussians.origin();
    if origin != DVec3::ZERO {
        loaded.report.note(format!(
            "counted the centres from ({}, {}, {}), which keeps their digits",
            origin.x, origin.y, origin.z
        ));
    }
    progress.left(0);
    Ok((loaded, properties))
}

/// The caller's progress callback; formats call it with the bytes that remain.
pub(super) struct Progress<'a> {
    total: u64,
    call: &'a mut dyn FnMut(u64, u64),
}

impl<'a> Progress<'a> {
    /// That of a file of so many bytes.
    pub(super) fn new(total: u64, call: &'a mut dyn FnMut(u64, u64)) -> Self {
        Self { total, call }
    }

    /// Bytes of the whole file.
    pub(super) fn total(&self) -> u64 {
        self.total
    }

    pub(super) fn left(&mut self, left: u64) {
        (self.call)(self.total.saturating_sub(left), self.total);
    }
}
