//! COLMAP sparse models: their files, `.bin` or `.txt`, and each picture with its camera.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Cursor, Read, Seek};
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::colmap_model::{ColmapImage, Lens, Lenses};
use super::{ColmapFormat, Entry, NamedCamera, named};
use super::{colmap_binary as binary, colmap_text as text};
use rara_base::error::{Error, Result, shortened};

pub(super) fn load(folder: &Path) -> Result<Vec<NamedCamera>> {
    let folder = model_folder(folder)?;
    let (lenses, images) = (file(&folder, "cameras"), file(&folder, "images"));
    joined((open(&lenses)?, &lenses), (open(&images)?, &images))
}

/// The positions of a model's points.
pub(super) fn points(folder: &Path) -> Result<Vec<DVec3>> {
    let at = file(&model_folder(folder)?, "points3D");
    read((open(&at)?, &at), binary::points, text::points)
}

/// The folder that a path to a model means: itself, or that of one of the model's files.
pub(super) fn folder_of(path: &Path) -> Option<&Path> {
    if path.is_dir() {
        return Some(path);
    }
    let is_model = ["cameras", "images", "points3D"]
        .iter()
        .any(|name| path.file_stem().is_some_and(|stem| stem == *name));
    let ending = path.extension().and_then(|ending| ending.to_str());
    if !(is_model && matches!(ending, Some("bin" | "txt"))) {
        return None;
    }
    let folder = path.parent()?;
    Some(match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    })
}

/// The cameras of a model in memory; `name` stands for its folder in messages.
pub(super) fn parse(
    format: ColmapFormat,
    lenses: &[u8],
    images: &[u8],
    name: &Path,
) -> Result<Vec<NamedCamera>> {
    let extension = match format {
        ColmapFormat::Binary => "bin",
        ColmapFormat::Text => "txt",
    };
    let at = |file: &str| name.join(file).with_extension(extension);
    let (lenses_at, images_at) = (at("cameras"), at("images"));
    joined(
        (Cursor::new(lenses), &lenses_at),
        (Cursor::new(images), &images_at),
    )
}

/// A file of a model, and its path.
type ModelFile<'a, R> = (R, &'a Path);

/// Each picture with its camera, by name.
fn joined<R: Read + Seek>(
    lenses: ModelFile<'_, R>,
    images: ModelFile<'_, R>,
) -> Result<Vec<NamedCamera>> {
    let (lenses_at, images_at) = (lenses.1, images.1);
    let Lenses { lenses, rest } = read(lenses, binary::lenses, text::lenses)?;
    let mut images = read(images, binary::images, text::images)?;
    let lenses: HashMap<u32, Lens> = lenses.into_iter().map(|lens| (lens.id, lens)).collect();
    let file = lenses_at.file_name().unwrap_or_default();
    images.sort_by(|a, b| a.name.cmp(&b.name));
    let entry = |image: ColmapImage| {
        let picture = format!("the picture `{}`", shortened(&image.name));
        let what = format!("{picture} (camera {} of {})", image.lens, file.display());
        let lens = lenses.get(&image.lens);
        let pinhole = |what: &str| match (lens, &rest) {
            (Some(lens), _) => lens.camera(&image, &picture),
            (None, Some(rest)) => Err(format!("{what}: {rest}")),
            (None, None) => Err(format!(
                "{picture} was taken with camera {}, which {} does not list; export the model again",
                image.lens,
                lenses_at.display()
            )),
        };
        let lens = lens.and_then(Lens::distortion).map(str::to_owned);
        Entry::new(image.name.clone(), what, pinhole).bent(lens)
    };
    named(images.into_iter().map(entry).collect(), images_at)
}

/// The folder itself or the usual place below a data set's root.
fn model_folder(folder: &Path) -> Result<PathBuf> {
    let has = |folder: &Path| {
        ["bin", "txt"]
            .iter()
            .any(|e| folder.join("cameras").with_extension(e).is_file())
    };
    let places = [
        folder.into(),
        folder.join("sparse/0"),
        folder.join("sparse"),
        folder.join("0"),
    ];
    places.into_iter().find(|place| has(place)).ok_or_else(|| {
        Error::format(
            folder,
            "there is no cameras.bin or cameras.txt in this folder; give a COLMAP sparse model",
        )
    })
}

/// The binary file if there is one, else the text.
fn file(folder: &Path, name: &str) -> PathBuf {
    let binary = folder.join(name).with_extension("bin");
    if binary.is_file() {
        binary
    } else {
        binary.with_extension("txt")
    }
}

fn open(path: &Path) -> Result<File> {
    File::open(path).map_err(Error::io(path))
}

type Reader<R, T> = fn(R, &Path) -> Result<T>;

fn read<R, T>(
    (source, path): ModelFile<'_, R>,
    binary: Reader<R, T>,
    text: Reader<R, T>,
) -> Result<T> {
    match path.extension().is_some_and(|ending| ending == "bin") {
        true => binary(source, path),
        false => text(source, path),
    }
}
