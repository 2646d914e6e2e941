//! Files that are dropped on the window: scenes, clips and cameras.

use std::path::Path;

use rara::camera_files::load_cameras;
use rara::clip::{NamedClip, load_clips};
use rara::{Camera, Error};

use crate::failure::Failure;
use crate::json_kind::{self, JsonKind};
use crate::{scene_file, training};

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
                            crate::output::counted(count as u64, "surface")
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
        let is_trained = matches!(training::scene_in(path), Ok(Some(_)));
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
    if !scene_file::is_list(path) {
        return JsonKind::Scene;
    }
    if !json_kind::is_short(path) {
        // No list is so long, but the cameras of many pictures may be.
        return JsonKind::Cameras;
    }
    json_kind::document(path).map_or(JsonKind::Scene, |document| {
        JsonKind::from_document(&document)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_apart_by_their_names_and_what_is_in_them() {
        let folder = std::env::temp_dir().join(format!("rara-dropped-{}", std::process::id()));
        let sog = folder.join("sog");
        std::fs::create_dir_all(folder.join("colmap/sparse")).unwrap();
        std::fs::create_dir_all(&sog).unwrap();
        let put = |name: &str, text: &str| {
            let path = folder.join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let clip = put("clip.json", "\u{feff}[{\"normal\":[0,0,1],\"d\":2}]");
        assert!(matches!(DroppedFile::open(&clip), Ok(DroppedFile::Clip(all)) if all.len() == 1));
        let scene = |path: &Path| matches!(DroppedFile::open(path), Ok(DroppedFile::Scene));
        assert!(scene(&put("a.splat", "")) && scene(&put("broken.json", "{")));
        assert!(scene(&put("meta.json", "{}")) && scene(&sog));
        assert_eq!(kind(&folder.join("colmap")), JsonKind::Cameras);
        assert_eq!(kind(&folder.join("colmap/cameras.txt")), JsonKind::Cameras);
        let error = DroppedFile::open(&folder.join("none.ply"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("none.ply"), "{error}");
        let empty = put("empty.json", "[]");
        let error = DroppedFile::open(&empty).unwrap_err().to_string();
        assert!(error.contains("no clip in it"), "{error}");
        let planes = vec![r#"{"normal":[0,0,1],"d":2}"#; MOST_SURFACES + 1].join(",");
        let many = put("many.json", &format!("[{planes}]"));
        let error = DroppedFile::open(&many).unwrap_err().to_string();
        assert!(
            error.contains("many.json") && error.contains("65 537 surfaces"),
            "{error}"
        );
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn nobody_waits_for_a_device() {
        let error = DroppedFile::open(Path::new("/dev/null"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("neither a file nor a folder"), "{error}");
    }
}
