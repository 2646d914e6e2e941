//! Files of cameras: 3DGS `cameras.json`, nerfstudio `transforms.json`, COLMAP sparse folders and our single camera.

mod colmap;
mod colmap_binary;
mod colmap_text;
mod inria;
mod nerfstudio;
mod single;

pub use single::SavedCamera;

use std::path::Path;

use glam::{DMat3, DMat4, DVec3};

use crate::camera::Camera;
use rara_base::error::{Error, Result};
use rara_base::json;

/// A camera and what its file calls it.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCamera {
    /// The picture's name in the file, or the camera's number there.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

/// How the files of a COLMAP model are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColmapFormat {
    /// `cameras.bin` and `images.bin`.
    Binary,
    /// `cameras.txt` and `images.txt`.
    Text,
}

/// Loads every camera of a 3DGS `cameras.json`, a nerfstudio `transforms.json` or `camera_path.json`, or a COLMAP sparse folder (with
/// `cameras` and `images`, each `.bin` or `.txt`; a folder that has `sparse/0` does too). JSON files keep their order,
/// COLMAP's cameras are sorted by picture name. A file with a single camera (see [`load_camera`]) gives that one, and a list
/// of such cameras, each perhaps with a `"name"`, all of them.
///
/// World coordinates are taken as the file has them. Cameras with lens distortion are an error.
///
/// # Errors
/// [`Error::Io`] if something can't be read, [`Error::Format`] if it is none of these or has unusable cameras in it.
pub fn load_cameras(path: &Path) -> Result<Vec<NamedCamera>> {
    let cameras = if path.is_dir() {
        colmap::load(path)?
    } else if let (Some("bin" | "txt"), Some(folder)) =
        (path.extension().and_then(|e| e.to_str()), path.parent())
    {
        // One of the files in the folder was named instead.
        colmap::load(if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        })?
    } else {
        return cameras_from_json(&json::read(path, "cameras")?, path);
    };
    not_empty(cameras, path)
}

/// Like [`load_cameras`] for the text of a `cameras.json`, a `transforms.json` or a single camera in memory; `name`
/// stands for it in messages.
///
/// # Errors
/// [`Error::Format`] if it is none of these or has unusable cameras in it.
pub fn cameras_from_json(json: &[u8], name: &Path) -> Result<Vec<NamedCamera>> {
    let json = json::bare(json);
    let cameras = match json.first() {
        Some(b'[') if single::is_list(json) => single::parse_list(json),
        Some(b'[') => inria::parse(json),
        Some(b'{') if nerfstudio::is_path(json) => nerfstudio::parse_path(json),
        Some(b'{') => nerfstudio::parse(json).or_else(|error| match single::parse(json) {
            Ok(camera) => Ok(vec![NamedCamera { name: "0".into(), camera }]),
            Err(_) => Err(error),
        }),
        _ => Err("this is neither a cameras.json, a transforms.json nor a COLMAP folder; give one of these".into()),
    };
    not_empty(
        cameras.map_err(|message| Error::format(name, message))?,
        name,
    )
}

/// Like [`load_cameras`] for the two files of a COLMAP model in memory; `name` stands for its folder in messages.
///
/// # Errors
/// [`Error::Format`] if they are no model or have unusable cameras in them.
pub fn cameras_from_colmap(
    format: ColmapFormat,
    cameras: &[u8],
    images: &[u8],
    name: &Path,
) -> Result<Vec<NamedCamera>> {
    not_empty(colmap::parse(format, cameras, images, name)?, name)
}

fn not_empty(cameras: Vec<NamedCamera>, path: &Path) -> Result<Vec<NamedCamera>> {
    if cameras.is_empty() {
        return Err(Error::format(
            path,
            "there is no camera in it; export the cameras again",
        ));
    }
    Ok(cameras)
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
    single::parse(json::bare(json)).map_err(|message| Error::format(name, message))
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
    fn camera(self, what: &str) -> std::result::Result<Camera, String> {
        let side = |side: f64, name: &str| {
            let whole = side.fract() == 0.0 && side >= 1.0 && side <= f64::from(Camera::MAX_SIZE);
            let error = || {
                format!(
                    "{what} has the {name} {side}; it must be a whole number from 1 to {}",
                    Camera::MAX_SIZE
                )
            };
            whole.then_some(side as u32).ok_or_else(error)
        };
        let size = (side(self.width, "width")?, side(self.height, "height")?);
        let world_to_camera = match self.pose {
            Pose::WorldToCamera(matrix) => matrix,
            Pose::CameraToWorld { axes, eye } => {
                let rotation = axes.transpose();
                DMat4::from_mat3_translation(rotation, -(rotation * eye))
            }
        };
        let centre = (
            self.centre.0.unwrap_or(self.width / 2.0),
            self.centre.1.unwrap_or(self.height / 2.0),
        );
        let intrinsics = (self.focal.0, self.focal.1, centre.0, centre.1);
        Camera::from_world_to_camera(world_to_camera, intrinsics, size)
            .map_err(|error| format!("{what}: {error}"))
    }
}
