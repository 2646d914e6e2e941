//! COLMAP sparse models: intrinsics by camera, poses by picture, in `.bin` or `.txt`.

use std::collections::HashMap;
use std::fs::File;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::{DMat4, DQuat, DVec3};

use super::{
    ColmapFormat, Entry, NamedCamera, Outcome, Parts, Pose, colmap_binary, colmap_text, named,
};
use rara_base::error::{Error, Result, shortened};

/// The lines or records of `cameras`.
pub(super) struct Lenses {
    pub(super) lenses: Vec<Lens>,
    /// Why those behind them could not be read, if there are any.
    pub(super) rest: Option<String>,
}

/// A line or record of `cameras`.
pub(super) struct Lens {
    pub(super) id: u32,
    /// Or the name of one that we do not know.
    pub(super) model: std::result::Result<&'static Model, String>,
    pub(super) width: f64,
    pub(super) height: f64,
    /// Those of a model that we know.
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
pub(super) const MODELS: [Model; 17] = [
    model("SIMPLE_PINHOLE", 3, true, true),
    model("PINHOLE", 4, false, true),
    model("SIMPLE_RADIAL", 4, true, true),
    model("RADIAL", 5, true, true),
    model("OPENCV", 8, false, true),
    model("OPENCV_FISHEYE", 8, false, false),
    model("FULL_OPENCV", 12, false, true),
    model("FOV", 5, false, true),
    model("SIMPLE_RADIAL_FISHEYE", 4, true, false),
    model("RADIAL_FISHEYE", 5, true, false),
    model("THIN_PRISM_FISHEYE", 12, false, false),
    model("RAD_TAN_THIN_PRISM_FISHEYE", 16, false, false),
    model("SIMPLE_DIVISION", 4, true, true),
    model("DIVISION", 5, false, true),
    model("SIMPLE_FISHEYE", 3, true, false),
    model("FISHEYE", 4, false, false),
    model("EUCM", 6, false, false),
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
    lenses: Lenses,
    lenses_at: &Path,
    mut images: Vec<ColmapImage>,
    images_at: &Path,
) -> Result<Vec<NamedCamera>> {
    let Lenses { lenses, rest } = lenses;
    let lenses: HashMap<u32, Lens> = lenses.into_iter().map(|lens| (lens.id, lens)).collect();
    let file = lenses_at.file_name().unwrap_or_default();
    images.sort_by(|a, b| a.name.cmp(&b.name));
    let entry = |image: ColmapImage| {
        let picture = format!("the picture `{}`", shortened(&image.name));
        let what = format!("{picture} (camera {} of {})", image.lens, file.display());
        let lens = lenses.get(&image.lens);
        let pinhole = match (lens, &rest) {
            (Some(lens), _) => lens.camera(&image, &picture),
            (None, Some(rest)) => Err(format!("{what}: {rest}")),
            (None, None) => Err(format!(
                "{picture} was taken with camera {}, which {} does not list; export the model again",
                image.lens,
                lenses_at.display()
            )),
        };
        Entry {
            name: image.name,
            lens: lens.and_then(Lens::distortion).map(str::to_owned),
            what,
            pinhole,
        }
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

type Read<T> = fn(File, &Path) -> Result<T>;

fn read<T>(path: &Path, binary: Read<T>, text: Read<T>) -> Result<T> {
    let file = File::open(path).map_err(Error::io(path))?;
    if path.extension().is_some_and(|e| e == "bin") {
        binary(file, path)
    } else {
        text(file, path)
    }
}

impl Lens {
    /// The name of the model, if it bends straight lines.
    fn distortion(&self) -> Option<&'static str> {
        let model = self.model.as_ref().ok()?;
        let focal_and_centre = if model.shared_focal { 3 } else { 4 };
        let mut distortion = self.parameters[focal_and_centre..].iter();
        let is_straight = model.straight && distortion.all(|&k| k == 0.0);
        (!is_straight).then_some(model.name)
    }

    /// The camera of a picture, whatever its lens does to straight lines.
    fn camera(&self, image: &ColmapImage, picture: &str) -> Outcome {
        let model = self.model.as_ref().map_err(|name| {
            format!(
                "{picture} was taken with camera {} of the model {}, which is not known; undistort the pictures where the model is \
                 from, and give their cameras",
                self.id,
                shortened(name)
            )
        })?;
        let p = &self.parameters;
        let (focal, centre) = match model.shared_focal {
            true => ((p[0], p[0]), &p[1..]),
            false => ((p[0], p[1]), &p[2..]),
        };
        let length = image.rotation.length();
        if !(length.is_finite() && length > 1e-6) {
            return Err(format!(
                "{picture} has no valid rotation; export the model again"
            ));
        }
        let parts = Parts {
            width: self.width,
            height: self.height,
            focal,
            centre: (Some(centre[0]), Some(centre[1])),
            pose: Pose::WorldToCamera(DMat4::from_rotation_translation(
                image.rotation / length,
                image.translation,
            )),
        };
        let mut camera = parts.camera(picture)?;
        if (length - 1.0).abs() > 1e-3 {
            let repair = format!("its quaternion is {length:.6} long and is made a rotation");
            camera.repairs.push(repair);
        }
        Ok(camera)
    }
}
