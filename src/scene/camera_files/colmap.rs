//! COLMAP sparse models: intrinsics by camera, poses by picture, in `.bin` or `.txt`.

use std::collections::HashMap;
use std::fs::File;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::{DMat4, DQuat, DVec3};

use super::{ColmapFormat, NamedCamera, Parts, Pose, colmap_binary, colmap_text};
use rara_base::error::{Error, Result, shortened};

/// A line or record of `cameras`.
pub(super) struct Lens {
    pub(super) id: u32,
    pub(super) model: &'static Model,
    pub(super) width: u64,
    pub(super) height: u64,
    pub(super) parameters: Vec<f64>,
}

/// A line or record of `images`.
pub(super) struct ColmapImage {
    pub(super) name: String,
    pub(super) lens: u32,
    /// World to camera.
    pub(super) rotation: DQuat,
    pub(super) translation: DVec3,
}

/// One of COLMAP's camera models.
pub(super) struct Model {
    pub(super) name: &'static str,
    pub(super) parameters: usize,
    /// One focal length for both axes.
    shared_focal: bool,
    /// Straight lines stay straight when the parameters after the principal point are zero.
    straight: bool,
}

const fn model(name: &'static str, parameters: usize, shared_focal: bool, straight: bool) -> Model {
    Model {
        name,
        parameters,
        shared_focal,
        straight,
    }
}

/// By COLMAP's number of the model.
pub(super) const MODELS: [Model; 12] = [
    model("SIMPLE_PINHOLE", 3, true, true),
    model("PINHOLE", 4, false, true),
    model("SIMPLE_RADIAL", 4, true, true),
    model("RADIAL", 5, true, true),
    model("OPENCV", 8, false, true),
    model("OPENCV_FISHEYE", 8, false, false),
    model("FULL_OPENCV", 12, false, true),
    model("FOV", 5, false, false),
    model("SIMPLE_RADIAL_FISHEYE", 4, true, false),
    model("RADIAL_FISHEYE", 5, true, false),
    model("THIN_PRISM_FISHEYE", 12, false, false),
    model("RAD_TAN_THIN_PRISM_FISHEYE", 16, false, false),
];

pub(super) fn load(folder: &Path) -> Result<Vec<NamedCamera>> {
    let folder = model_folder(folder)?;
    let (lenses_at, images_at) = (file(&folder, "cameras"), file(&folder, "images"));
    let lenses = read(&lenses_at, colmap_binary::lenses, colmap_text::lenses)?;
    let images = read(&images_at, colmap_binary::images, colmap_text::images)?;
    joined(lenses, &lenses_at, images, &images_at)
}

/// The cameras of a model in memory; `name` stands for its folder in messages.
pub(super) fn parse(
    format: ColmapFormat,
    lenses: &[u8],
    images: &[u8],
    name: &Path,
) -> Result<Vec<NamedCamera>> {
    let (lenses, images) = (Cursor::new(lenses), Cursor::new(images));
    let extension = match format {
        ColmapFormat::Binary => "bin",
        ColmapFormat::Text => "txt",
    };
    let at = |file: &str| name.join(file).with_extension(extension);
    let (lenses_at, images_at) = (at("cameras"), at("images"));
    let (lenses, images) = match format {
        ColmapFormat::Binary => (
            colmap_binary::lenses(lenses, &lenses_at)?,
            colmap_binary::images(images, &images_at)?,
        ),
        ColmapFormat::Text => (
            colmap_text::lenses(lenses, &lenses_at)?,
            colmap_text::images(images, &images_at)?,
        ),
    };
    joined(lenses, &lenses_at, images, &images_at)
}

/// Each picture with its camera, by name.
fn joined(
    lenses: Vec<Lens>,
    lenses_at: &Path,
    mut images: Vec<ColmapImage>,
    images_at: &Path,
) -> Result<Vec<NamedCamera>> {
    let lenses: HashMap<u32, Lens> = lenses.into_iter().map(|lens| (lens.id, lens)).collect();
    images.sort_by(|a, b| a.name.cmp(&b.name));
    let named = |image: ColmapImage| {
        let lens = lenses.get(&image.lens).ok_or_else(|| {
            let message = format!(
                "the picture `{}` was taken with camera {}, which {} does not list; export the model again",
                shortened(&image.name),
                image.lens,
                lenses_at.display()
            );
            Error::format(images_at, message)
        })?;
        let camera = parts(lens, &image)
            .and_then(|parts| parts.camera(&format!("the picture `{}`", shortened(&image.name))));
        let camera = camera.map_err(|message| Error::format(images_at, message))?;
        Ok(NamedCamera {
            name: image.name,
            camera,
        })
    };
    images.into_iter().map(named).collect()
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

type Read<T> = fn(File, &Path) -> Result<Vec<T>>;

fn read<T>(path: &Path, binary: Read<T>, text: Read<T>) -> Result<Vec<T>> {
    let file = File::open(path).map_err(Error::io(path))?;
    if path.extension().is_some_and(|e| e == "bin") {
        binary(file, path)
    } else {
        text(file, path)
    }
}

fn parts(lens: &Lens, image: &ColmapImage) -> std::result::Result<Parts, String> {
    let Model {
        name,
        shared_focal,
        straight,
        ..
    } = *lens.model;
    let p = &lens.parameters;
    let (focal, rest) = if shared_focal {
        ((p[0], p[0]), &p[1..])
    } else {
        ((p[0], p[1]), &p[2..])
    };
    let (centre, distortion) = ((rest[0], rest[1]), &rest[2..]);
    if !straight || distortion.iter().any(|&k| k != 0.0) {
        return Err(format!(
            "camera {} is a {name} with lens distortion, which a splat renderer has not; run colmap \
             image_undistorter and give its sparse folder",
            lens.id
        ));
    }
    let length = image.rotation.length();
    if !(length.is_finite() && length > 1e-6) {
        return Err(format!(
            "the picture `{}` has no valid rotation; export the model again",
            shortened(&image.name)
        ));
    }
    Ok(Parts {
        width: lens.width as f64,
        height: lens.height as f64,
        focal,
        centre: (Some(centre.0), Some(centre.1)),
        pose: Pose::WorldToCamera(DMat4::from_rotation_translation(
            image.rotation / length,
            image.translation,
        )),
    })
}
