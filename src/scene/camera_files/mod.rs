//! Files of cameras: 3DGS, nerfstudio, SuperSplat, Pix4D and glTF, COLMAP sparse folders and our own; those of others are named.

mod colmap;
mod colmap_binary;
mod colmap_model;
mod colmap_text;
mod gltf;
mod inria;
mod nerfstudio;
mod opf;
mod others;
mod rigid;
mod single;
mod supersplat;

pub use single::SavedCamera;

use std::path::Path;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};

use crate::camera::Camera;
use crate::clip::Shape;
use others::Members;
use rara_base::counted::counted;
use rara_base::error::{Error, Result, shortened};
use rara_base::json;
use rigid::Rigid;

/// A camera of a file and its name there.
///
/// A file is read whatever its cameras are: what cannot be drawn is an error of [`camera`](Self::camera), where it is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCamera {
    file: Arc<Path>,
    entry: Entry,
}

/// What a format reads of a camera.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    name: String,
    /// What messages call it.
    what: String,
    /// The model of a lens that bends straight lines.
    lens: Option<String>,
    /// The camera but for such a lens, or what is wrong with it.
    pinhole: Outcome,
}

type Outcome = std::result::Result<RepairedCamera, String>;

impl Entry {
    /// A camera of a lens that keeps lines straight. `pinhole` makes it, given what messages call it.
    fn new(name: String, what: String, pinhole: impl FnOnce(&str) -> Outcome) -> Self {
        Self {
            pinhole: pinhole(&what),
            name,
            what,
            lens: None,
        }
    }

    /// The same with a lens of this model, if that bends straight lines.
    fn bent(self, lens: Option<String>) -> Self {
        Self { lens, ..self }
    }
}

/// A camera, and what had to be made of numbers that are none of a camera.
#[derive(Debug, Clone, PartialEq)]
struct RepairedCamera {
    camera: Camera,
    repairs: Vec<String>,
}

impl NamedCamera {
    /// The picture's name in the file, or the camera's number there.
    pub fn name(&self) -> &str {
        &self.entry.name
    }

    /// Returns the camera.
    ///
    /// # Errors
    /// [`Error::Format`], which names it, if the file has no camera's numbers for it, or if it has a lens that bends straight lines:
    /// splats are drawn through pinholes. [`undistorted`](Self::undistorted) gives the pinhole of such a camera.
    pub fn camera(&self) -> Result<Camera> {
        let pinhole = self.undistorted()?;
        let Some(lens) = &self.entry.lens else {
            return Ok(pinhole);
        };
        let message = format!(
            "{} has the lens {}, which bends straight lines, and splats are drawn through a pinhole: --undistort draws that of the same \
             focal lengths, or give the cameras of undistorted pictures (colmap image_undistorter makes them)",
            self.entry.what,
            shortened(lens)
        );
        Err(Error::format(&*self.file, message))
    }

    /// Returns the camera as a pinhole camera: the same focal lengths and principal point, without the distortion of the lens.
    ///
    /// # Errors
    /// [`Error::Format`], which names it, if the file has no camera's numbers for it, or those of a model that is not known.
    pub fn undistorted(&self) -> Result<Camera> {
        match &self.entry.pinhole {
            Ok(repaired) => Ok(repaired.camera),
            Err(message) => Err(Error::format(&*self.file, message)),
        }
    }

    /// Returns the model of the camera's lens, if it bends straight lines.
    pub fn distortion(&self) -> Option<&str> {
        self.entry.lens.as_deref()
    }

    /// Returns what was repaired: rotations that are rounded, matrices that scale, and picture sizes that are not whole pixels.
    /// Each is a clause that says what was done.
    pub fn repairs(&self) -> &[String] {
        let repaired = self.entry.pinhole.as_ref();
        repaired.map_or(&[], |repaired| &repaired.repairs)
    }

    /// Returns the same entry with the camera that `place` returns for its camera.
    pub fn placed(mut self, place: impl FnOnce(Camera) -> Camera) -> Self {
        if let Ok(repaired) = &mut self.entry.pinhole {
            repaired.camera = place(repaired.camera);
        }
        self
    }
}

/// How the files of a COLMAP model are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColmapFormat {
    /// `cameras.bin` and `images.bin`.
    Binary,
    /// `cameras.txt` and `images.txt`.
    Text,
}

/// Loads every camera of a 3DGS `cameras.json`, a nerfstudio `transforms.json` or `camera_path.json`, a `settings.json` of
/// SuperSplat, a `project.opf` of Pix4D, a glTF with cameras, or a COLMAP sparse folder (with `cameras` and `images`, each `.bin` or `.txt`; a folder
/// that has `sparse/0` does too). JSON files keep their order,
/// COLMAP's cameras are sorted by picture name. A file with a single camera (see [`load_camera`]) gives that one, and a list
/// of such cameras, each perhaps with a `"name"`, all of them.
///
/// World coordinates are taken as the file has them, but for those of SuperSplat and glTF, which are turned as scenes are. Only the cameras that are asked for have to be usable, see
/// [`NamedCamera::camera`].
///
/// # Errors
/// [`Error::Io`] if something can't be read, [`Error::Format`] if it is none of these.
pub fn load_cameras(path: &Path) -> Result<Vec<NamedCamera>> {
    match colmap::folder_of(path) {
        Some(folder) => colmap::load(folder),
        None => cameras_from_json(&text_of(path)?, path),
    }
}

/// The settings of pictures in a file of cameras. Only a `camera_path.json` of nerfstudio has any.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct PathSettings {
    /// The part of the scene that is drawn, in the coordinates of the scene.
    pub crop: Option<Shape>,
    /// The background colour, from 0 to 1.
    pub background: Option<[f32; 3]>,
    /// Pictures per second of the film.
    pub fps: Option<f64>,
}

/// Loads what the file of cameras at `path` says beside these.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] for a path that is damaged, or whose crop is no box.
pub fn load_path_settings(path: &Path) -> Result<PathSettings> {
    if colmap::folder_of(path).is_some() {
        return Ok(PathSettings::default());
    }
    let text = text_of(path)?;
    let text = json::bare(&text);
    match text.starts_with(b"{") && Members::of(text).has("camera_path") {
        true => nerfstudio::path_settings(text).map_err(|message| Error::format(path, message)),
        false => Ok(PathSettings::default()),
    }
}

/// The text of a file of cameras: of a `.glb` its JSON.
fn text_of(path: &Path) -> Result<Vec<u8>> {
    match gltf::json_of(path)? {
        Some(text) => Ok(text),
        None => json::read(path, "cameras"),
    }
}

/// Loads the positions of the points of a COLMAP sparse folder, from its `points3D`, `.bin` or `.txt`; `None` for files of
/// cameras of other kinds.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it has no points of COLMAP.
pub fn load_colmap_points(path: &Path) -> Result<Option<Vec<DVec3>>> {
    colmap::folder_of(path).map(colmap::points).transpose()
}

/// Like [`load_cameras`] for the text of a `cameras.json`, a `transforms.json` or a single camera in memory; `name`
/// stands for it in messages.
///
/// # Errors
/// [`Error::Format`] if it is none of these.
pub fn cameras_from_json(json: &[u8], name: &Path) -> Result<Vec<NamedCamera>> {
    let json = json::bare(json);
    let members = Members::of(json);
    let has = |member: &str| members.has(member);
    let cameras = match json.first() {
        Some(b'[') if single::is_list(json) => single::parse_list(json),
        Some(b'[')
            if ["img_name", "position", "rotation", "width"]
                .into_iter()
                .any(has) =>
        {
            inria::parse(json)
        }
        Some(b'{') if has("camera_path") => nerfstudio::parse_path(json),
        Some(b'{') if has("world_to_camera") || has("fx") && !has("t_00") => {
            single::parse(json).map(|one| vec![one])
        }
        Some(b'{') if has("frames") => nerfstudio::parse(json),
        Some(b'{') if has("items") && has("format") => return named(opf::load(json, name)?, name),
        Some(b'{') if has("sensors") && has("cameras") => opf::parse(json),
        Some(b'{') if has("asset") && !has("root") => gltf::parse(json),
        Some(b'g') if json.starts_with(gltf::MAGIC) => gltf::parse_binary(json),
        Some(b'{') if has("animTracks") || has("startMode") => supersplat::parse(json),
        // A file of none is empty, and a document that is damaged says where.
        Some(b'[' | b'{') => {
            json::parse::<serde_json::Value>(json).and_then(|document| match document {
                serde_json::Value::Array(none) if none.is_empty() => Ok(Vec::new()),
                _ => Err(others::named(json, &members)),
            })
        }
        _ => Err(others::named(json, &members)),
    };
    named(
        cameras.map_err(|message| Error::format(name, message))?,
        name,
    )
}

/// Like [`load_cameras`] for the two files of a COLMAP model in memory; `name` stands for its folder in messages.
///
/// # Errors
/// [`Error::Format`] if they are no model.
pub fn cameras_from_colmap(
    format: ColmapFormat,
    cameras: &[u8],
    images: &[u8],
    name: &Path,
) -> Result<Vec<NamedCamera>> {
    colmap::parse(format, cameras, images, name)
}

/// The cameras of a file, of which there has to be one.
fn named(entries: Vec<Entry>, file: &Path) -> Result<Vec<NamedCamera>> {
    if entries.is_empty() {
        return Err(Error::format(
            file,
            "there is no camera in it; export the cameras again",
        ));
    }
    let file: Arc<Path> = file.into();
    let named = |entry: Entry| NamedCamera {
        file: file.clone(),
        entry,
    };
    Ok(entries.into_iter().map(named).collect())
}

/// Loads a single camera: JSON `{"width", "height", "fx", "fy", "cx", "cy", "world_to_camera": [16 numbers,
/// row-major]}`; without `cx` or `cy` the principal point is the middle. With `"projection": "orthographic"` `fx` and `fy`
/// are the pixels of a world unit. `clip_near`, `clip_far` and `near_cut` are those of [`Camera`]. With `eye`, three numbers
/// that have to agree with the matrix, a camera is read as it was written, to the last bit.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it has no usable camera.
pub fn load_camera(path: &Path) -> Result<Camera> {
    camera_from_json(&json::read(path, "cameras")?, path)
}

/// Like [`load_camera`] for text in memory; `name` stands for it in messages.
///
/// # Errors
/// [`Error::Format`] if it has no usable camera.
pub fn camera_from_json(json: &[u8], name: &Path) -> Result<Camera> {
    let one = single::parse(json::bare(json)).and_then(|one| one.pinhole);
    one.map(|one| one.camera)
        .map_err(|message| Error::format(name, message))
}

/// The parts that each format is reduced to. `pose` takes camera coordinates (right, down, forward) to the world.
struct Parts {
    width: f64,
    height: f64,
    focal: (f64, f64),
    /// `None` where the file is silent: the middle.
    centre: (Option<f64>, Option<f64>),
    pose: Pose,
}

enum Pose {
    CameraToWorld { axes: DMat3, eye: DVec3 },
    WorldToCamera(DMat4),
}

impl Parts {
    /// The camera, or what is wrong with it; `what` names it.
    fn camera(self, what: &str) -> Outcome {
        let mut repairs = Vec::new();
        let mut side = |side: f64, name: &str| {
            let whole = side.round();
            if !(side >= 1.0 && whole <= f64::from(Camera::MAX_SIZE)) {
                return Err(format!(
                    "{what} has the {name} {side}; it must be from 1 to {} pixels",
                    Camera::MAX_SIZE
                ));
            }
            if whole != side {
                let side = counted(side, "pixel");
                repairs.push(format!("its {name} of {side} is taken for {whole}"));
            }
            Ok(whole as u32)
        };
        let size = (side(self.width, "width")?, side(self.height, "height")?);
        let world_to_camera = match self.pose {
            Pose::WorldToCamera(matrix) => {
                let rigid = Rigid::new(DMat3::from_mat4(matrix));
                repairs.extend(rigid.repair);
                DMat4::from_mat3_translation(rigid.axes, matrix.w_axis.truncate() / rigid.scale)
            }
            Pose::CameraToWorld { axes, eye } => {
                let rigid = Rigid::new(axes);
                repairs.extend(rigid.repair);
                let rotation = rigid.axes.transpose();
                DMat4::from_mat3_translation(rotation, -(rotation * eye))
            }
        };
        let centre = (
            self.centre.0.unwrap_or(f64::from(size.0) / 2.0),
            self.centre.1.unwrap_or(f64::from(size.1) / 2.0),
        );
        let intrinsics = (self.focal.0, self.focal.1, centre.0, centre.1);
        let camera = Camera::from_world_to_camera(world_to_camera, intrinsics, size)
            .map_err(|error| format!("{what}: {error}"))?;
        Ok(RepairedCamera { camera, repairs })
    }
}
