//! Loads scenes from files of any format that is known.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use super::Property;
use super::formats::{self, Files};
use super::input::{Input, LoadOptions};
use super::scene_file::SceneFile;
use rara_base::error::{Error, Result};

/// Loads a scene from a file of any [format](super::Format). The format is recognised by the contents of the file, not by its
/// name.
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
/// it doesn't fit. Single bad elements are no error: see [`LoadReport`](super::LoadReport).
pub fn load(path: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<SceneFile> {
    load_with(path, LoadOptions::default(), progress).map(|(loaded, _)| loaded)
}

/// Loads a scene as [`load`] does, and with it the values of some of the properties that its `vertex` element, or the primitives
/// of glTF, have beside those of a Gaussian, such as a label; they have to be numbers, of any type. `*` asks for all that are, if
/// there are any. Each takes 8 bytes a Gaussian; what is not asked for takes nothing. In a glTF the values of primitives that do not
/// have a property are no numbers (NaN).
///
/// # Errors
/// The errors of [`load`], and [`Error::Format`] for a property that the file has not, that is a list or that a Gaussian is made of.
pub fn load_with<'a>(
    path: &Path,
    options: impl Into<LoadOptions<'a>>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(SceneFile, Vec<Property>)> {
    // Before opening it, which would wait for a pipe's writer.
    let metadata = std::fs::metadata(path).map_err(Error::io(path))?;
    if let Some(file) = formats::SOG_DOCUMENTS
        .map(|name| path.join(name))
        .iter()
        .find(|f| f.is_file())
    {
        return load_with(file, options, progress);
    }
    if !metadata.is_file() {
        return Err(Error::format(
            path,
            "this is a folder without the meta.json of a SOG scene, or a device; give a scene's file, such as a .ply",
        ));
    }
    let input = Input {
        source: &mut File::open(path).map_err(Error::io(path))?,
        name: path,
        options: options.into(),
    };
    formats::read(input, Files::of_folder(path.parent()), progress)
}

/// Loads a scene from anything that can be read and sought in, such as an archive's entry in a
/// [`Cursor`](std::io::Cursor). `name` stands for it in messages. Otherwise like [`load`].
///
/// # Errors
/// The errors of [`load`].
pub fn load_from<R: Read + Seek>(
    source: R,
    name: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<SceneFile> {
    load_from_with(source, name, LoadOptions::default(), progress).map(|(loaded, _)| loaded)
}

/// Loads a scene as [`load_from`] does, with properties as [`load_with`] does.
///
/// # Errors
/// The errors of [`load_with`].
pub fn load_from_with<'a, R: Read + Seek>(
    source: R,
    name: &Path,
    options: impl Into<LoadOptions<'a>>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(SceneFile, Vec<Property>)> {
    let mut source = source;
    let input = Input {
        source: &mut source,
        name,
        options: options.into(),
    };
    formats::read(input, Files::default(), progress)
}
