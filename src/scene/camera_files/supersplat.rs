//! `settings.json` of SuperSplat and of its viewer: the first camera, those of annotations, and the keys of its paths. Their
//! world is that of the viewer, in which y is up: it draws scenes turned by half a turn about z.

use glam::DVec3;
use serde::Deserialize;

use super::{Entry, Outcome, RepairedCamera};
use crate::camera::Camera;
use rara_base::error::shortened;
use rara_base::json;

/// Such a file says no size of pictures.
const SIDE: u32 = 1024;
/// Degrees, where a file says none.
const FOV: f64 = 60.0;

#[derive(Deserialize)]
struct ViewerSettings {
    camera: Option<ViewerCamera>,
    #[serde(default)]
    cameras: Vec<Initial>,
    #[serde(default)]
    annotations: Vec<Annotation>,
    #[serde(default, rename = "animTracks")]
    tracks: Vec<Track>,
}

#[derive(Deserialize)]
struct Initial {
    initial: ViewerCamera,
}

#[derive(Deserialize)]
struct Annotation {
    title: Option<String>,
    camera: Option<Initial>,
}

#[derive(Deserialize)]
struct ViewerCamera {
    fov: Option<f64>,
    position: Option<[f64; 3]>,
    target: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Track {
    name: Option<String>,
    keyframes: Keys,
}

#[derive(Deserialize)]
struct Keys {
    values: KeyValues,
}

/// The numbers of all keys, one after the other.
#[derive(Deserialize)]
struct KeyValues {
    #[serde(default)]
    position: Vec<f64>,
    #[serde(default)]
    target: Vec<f64>,
    #[serde(default)]
    fov: Vec<f64>,
}

pub(super) fn parse(json: &[u8]) -> Result<Vec<Entry>, String> {
    let file: ViewerSettings = json::parse(json)?;
    let mut entries = Vec::new();
    let fov = file.camera.as_ref().and_then(|camera| camera.fov);
    let initial = file.cameras.into_iter().map(|one| one.initial);
    for camera in file.camera.into_iter().chain(initial) {
        add(&mut entries, "camera", &camera);
    }
    for (number, annotation) in file.annotations.into_iter().enumerate() {
        let name = annotation
            .title
            .unwrap_or_else(|| format!("annotation {number}"));
        if let Some(Initial { initial }) = annotation.camera {
            add(&mut entries, &name, &initial);
        }
    }
    for (number, track) in file.tracks.into_iter().enumerate() {
        let name = track.name.unwrap_or_else(|| format!("track {number}"));
        let KeyValues {
            position,
            target,
            fov: fovs,
        } = track.keyframes.values;
        let (positions, targets) = (position.as_chunks().0, target.as_chunks().0);
        for (key, (position, target)) in positions.iter().zip(targets).enumerate() {
            let camera = ViewerCamera {
                fov: fovs.get(key).copied().or(fov),
                position: Some(*position),
                target: Some(*target),
            };
            add(&mut entries, &format!("{name} {key}"), &camera);
        }
    }
    match entries.is_empty() {
        true => Err("these are settings of SuperSplat's viewer in which no camera stands; set its pose there, and export again".into()),
        false => Ok(entries),
    }
}

/// Adds the camera under this name, if it stands somewhere: the viewer frames the scene otherwise.
fn add(entries: &mut Vec<Entry>, name: &str, camera: &ViewerCamera) {
    let Some(position) = camera.position else {
        return;
    };
    let what = format!("camera {} (`{}`)", entries.len(), shortened(name));
    let (target, fov) = (camera.target.unwrap_or_default(), camera.fov.unwrap_or(FOV));
    let pinhole = |what: &str| pinhole(position, target, fov, what);
    entries.push(Entry::new(name.into(), what, pinhole));
}

fn pinhole(position: [f64; 3], target: [f64; 3], fov: f64, what: &str) -> Outcome {
    let turned = |[x, y, z]: [f64; 3]| DVec3::new(-x, -y, z);
    let (eye, target) = (turned(position), turned(target));
    let forward = (target - eye).normalize_or_zero();
    let up = match forward.y.abs() > 1.0 - 1e-9 {
        true => DVec3::Z,
        false => DVec3::NEG_Y,
    };
    let camera = Camera::look_at(eye, target, up, fov, (SIDE, SIDE));
    let camera = camera.map_err(|error| format!("{what}: {error}"))?;
    let repairs = Vec::new();
    Ok(RepairedCamera { camera, repairs })
}
