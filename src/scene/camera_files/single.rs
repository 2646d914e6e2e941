//! Our own files of one camera, or of a list: the matrix as a renderer has it.

use glam::{DMat3, DMat4, DVec3};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize, Serializer};

use super::rigid::{self, Rigid};
use super::{Entry, Outcome, Parts, Pose};
use crate::camera::{Camera, Projection, oblique};
use rara_base::error::shortened;
use rara_base::json;

/// How far `eye` may be from where the matrix puts it, as a share of its distance from the origin: files round both.
const EYE_TOLERANCE: f64 = 1e-5;
/// How far axes may be from unit length and from being square to each other where they are rotations but for rounding, as
/// products of several rotations have them.
const ROUNDING: f64 = 1e-13;

/// A camera as serde writes it to a file that [`load_camera`](super::load_camera) reads to the last bit. Files of several are
/// lists of these.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
pub struct SavedCamera {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(serialize_with = "whole")]
    width: f64,
    #[serde(serialize_with = "whole")]
    height: f64,
    fx: f64,
    fy: f64,
    cx: Option<f64>,
    cy: Option<f64>,
    /// The matrix says it as well, but for rounding.
    eye: Option<[f64; 3]>,
    /// Row by row.
    world_to_camera: [f64; 16],
    #[serde(default)]
    projection: Projection,
    #[serde(skip_serializing_if = "Option::is_none")]
    clip_near: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    clip_far: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    near_cut: Option<f64>,
}

fn whole<S: Serializer>(pixels: &f64, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_u32(*pixels as u32)
}

impl From<&Camera> for SavedCamera {
    fn from(camera: &Camera) -> Self {
        Self {
            name: None,
            width: camera.width.into(),
            height: camera.height.into(),
            fx: camera.fx,
            fy: camera.fy,
            cx: Some(camera.cx),
            cy: Some(camera.cy),
            eye: Some(camera.eye.to_array()),
            world_to_camera: camera.world_to_camera().transpose().to_cols_array(),
            projection: camera.projection,
            clip_near: camera.clip_near,
            clip_far: camera.clip_far,
            near_cut: camera.near_cut,
        }
    }
}

/// What tells our own cameras from those of others.
#[derive(Deserialize)]
struct CameraRecord {
    world_to_camera: Option<IgnoredAny>,
}

/// True for a list of our own cameras.
pub(super) fn is_list(json: &[u8]) -> bool {
    let entries = serde_json::from_slice::<Vec<CameraRecord>>(json);
    entries.is_ok_and(|entries| entries.iter().any(|entry| entry.world_to_camera.is_some()))
}

pub(super) fn parse(json: &[u8]) -> Result<Entry, String> {
    let camera: SavedCamera = json::parse(json)?;
    let what = "the camera".into();
    Ok(Entry::new("0".into(), what, |what| camera.camera(what)))
}

pub(super) fn parse_list(json: &[u8]) -> Result<Vec<Entry>, String> {
    let entries: Vec<SavedCamera> = json::parse(json)?;
    let named = |(number, mut entry): (usize, SavedCamera)| {
        let name = entry.name.take().unwrap_or_else(|| number.to_string());
        let what = format!("camera {number} (`{}`)", shortened(&name));
        Entry::new(name, what, |what| entry.camera(what))
    };
    Ok(entries.into_iter().enumerate().map(named).collect())
}

impl SavedCamera {
    /// Returns the same camera with this name, for a list of cameras.
    pub fn named(self, name: String) -> Self {
        Self {
            name: Some(name),
            ..self
        }
    }

    /// The camera, or what is wrong with it; `what` names it.
    fn camera(self, what: &str) -> Outcome {
        let matrix = DMat4::from_cols_array(&self.world_to_camera).transpose();
        let matrix = rigid::affine(matrix).ok_or_else(|| {
            format!("the last row of world_to_camera of {what} is not 0, 0, 0, 1; write the matrix row by row")
        })?;
        let file = Rigid::new(DMat3::from_mat4(matrix));
        let unit = match self.projection {
            Projection::Perspective => 1.0,
            Projection::Orthographic => file.scale,
        };
        let parts = Parts {
            width: self.width,
            height: self.height,
            focal: (unit * self.fx, unit * self.fy),
            centre: (self.cx, self.cy),
            pose: Pose::WorldToCamera(matrix),
        };
        let mut repaired = parts.camera(what)?;
        let mut camera = repaired
            .camera
            .projection(self.projection)
            .clip_near(self.clip_near)
            .clip_far(self.clip_far)
            .near_cut(self.near_cut);
        let checked = camera.check_near_cut().and(camera.clip_planes());
        checked.map_err(|error| format!("{what}: {error}"))?;
        if let Some(eye) = self.eye.map(DVec3::from) {
            let apart = eye.distance(camera.eye);
            let tolerance = EYE_TOLERANCE + 2.0 * file.oblique;
            if apart.is_nan() || apart > tolerance * camera.eye.length().max(1.0) {
                return Err(format!(
                    "the eye of {what} is {eye}, and its world_to_camera puts it at {}; leave out eye, or write the matrix of \
                     that eye",
                    camera.eye
                ));
            }
            // An eye and axes with all their digits draw the same picture again.
            camera.eye = eye;
            let rotation = DMat3::from_mat4(matrix);
            if oblique(rotation.transpose()) <= ROUNDING {
                camera.rotation = rotation;
            }
        }
        repaired.camera = camera;
        Ok(repaired)
    }
}
