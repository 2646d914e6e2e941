//! Files that are dropped on the window: scenes, clips and cameras.

use std::path::Path;

use rara::camera_files::load_cameras;
use rara::clip::{NamedClip, load_clips};
use rara::{Camera, Error};

use super::failure::Failure;
use rara::scene::layers::is_list;
use rara::scene::trained_folder;
use rara_base::counted::{counted, grouped};
use rara_base::json::{SHORT, short_document};
use rara_scene::json_kind::JsonKind;

#[derive(Debug)]
pub(super) enum DroppedFile {
    /// A scene, which is yet to be read.
    Scene,
    Clip(Vec<NamedClip>),
    /// One camera at least, and why others of the file are none.
    Cameras(Vec<Camera>, Option<Error>),
}

impl DroppedFile {
    /// Finds out what a file is, and reads it unless it is a scene.
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let facts = std::fs::metadata(path).map_err(Error::io(path))?;
        if !facts.is_file() && !facts.is_dir() {
            let message = "this is neither a file nor a folder; drop one of these";
            return Err(Error::format(path, message).into());
        }
        Ok(match kind(path) {
            JsonKind::Scene => Self::Scene,
            JsonKind::Clips => {
                let clips = load_clips(path)?;
                let surfaces = clips.iter().map(|one| one.clip.clip().all_surfaces().len());
                let count: usize = surfaces.sum();
                if count > MOST_SURFACES {
                    return Err(Error::format(
                        path,
                        format!(
                            "{} are beyond the {MOST_SURFACES} that a clip may have; use fewer",
                            counted(grouped(count as u64), "surface")
                        ),
                    )
                    .into());
                }
                Self::Clip(clips)
            }
            JsonKind::Cameras => {
                let (mut cameras, mut error) = (Vec::new(), None);
                for named in load_cameras(path)? {
                    match named.camera() {
                        Ok(camera) => cameras.push(camera),
                        Err(first) => error = error.or(Some(first)),
                    }
                }
                match error {
                    Some(error) if cameras.is_empty() => return Err(error.into()),
                    error => Self::Cameras(cameras, error),
                }
            }
        })
    }
}

/// The surfaces of a clip that a frame takes.
const MOST_SURFACES: usize = 1 << 16;

/// What a file seems to be; the messages of what is none of all this are those of a scene.
fn kind(path: &Path) -> JsonKind {
    let is_of_colmap = |ending: &str| path.join("cameras").with_extension(ending).is_file();
    if path.is_dir() {
        let is_trained = matches!(trained_folder::scene_in(path), Ok(Some(_)));
        let has_cameras =
            is_of_colmap("bin") || is_of_colmap("txt") || path.join("sparse").is_dir();
        return match has_cameras && !is_trained {
            true => JsonKind::Cameras,
            false => JsonKind::Scene,
        };
    }
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending {
        Some("bin" | "txt") => return JsonKind::Cameras,
        Some("json") => {}
        _ => return JsonKind::Scene,
    }
    if !is_list(path) {
        return JsonKind::Scene;
    }
    if !std::fs::metadata(path).is_ok_and(|facts| facts.len() <= SHORT) {
        // No list is so long, but the cameras of many pictures may be.
        return JsonKind::Cameras;
    }
    short_document(path).map_or(JsonKind::Scene, |document| {
        JsonKind::from_document(&document)
    })
}

#[cfg(test)]
mod tests;
