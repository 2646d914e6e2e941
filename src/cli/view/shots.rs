//! Screenshots: their names, the cameras beside them, and what draws them again.

use std::path::{Path, PathBuf};

use rara::camera_files::SavedCamera;
use rara::{Camera, Error, Picture, Result};

use crate::output;
use crate::save_camera;

/// The screenshots' files: `{}` becomes their number.
#[derive(Debug)]
pub(super) struct Shots {
    pattern: String,
    /// The last number that was taken.
    last: u32,
}

impl Shots {
    pub(super) fn new(pattern: String) -> Self {
        Self { pattern, last: 0 }
    }

    /// The next name that is free.
    pub(super) fn next(&mut self) -> PathBuf {
        loop {
            self.last += 1;
            let path = PathBuf::from(self.pattern.replace("{}", &format!("{:03}", self.last)));
            if !taken(&path) {
                return path;
            }
        }
    }
}

fn beside(picture: &Path) -> PathBuf {
    picture.with_extension("json")
}

fn taken(picture: &Path) -> bool {
    picture.exists() || beside(picture).exists()
}

/// Writes a picture and its camera. Neither replaces a file.
pub(super) fn save(picture: &Picture, camera: &Camera, path: &Path) -> Result<()> {
    if taken(path) {
        return Err(Error::format(
            path,
            "this file, or the .json of its camera beside it, is there already; a screenshot replaces nothing, choose \
             another name",
        ));
    }
    let matrix = camera.world_to_camera();
    let lens = (camera.fx, camera.fy, camera.cx, camera.cy);
    // JSON has no number for what is not finite, and a camera that cannot be read again is not worth a file.
    Camera::from_world_to_camera(matrix, lens, (camera.width, camera.height))?;
    output::check_file(path)?;
    picture.save(path)?;
    output::text(
        &beside(path),
        &save_camera::text(&SavedCamera::from(camera)),
    )
}

/// The line that names the file, and the flags with which `rara render` draws it again.
pub(super) fn wrote(path: &Path, flags: &str) -> String {
    format!(
        "wrote {}; as in rara render --camera {} {flags}",
        path.display(),
        quoted(&beside(path).to_string_lossy())
    )
}

/// A word, quoted so that a shell takes it for one.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_-+=.,:/@%".contains(c);
    if !word.is_empty() && word.chars().all(|c| plain(c) || cfg!(windows) && c == '\\') {
        return word.to_owned();
    }
    if cfg!(windows) {
        // On this system no file's name contains such a quote.
        return format!("\"{word}\"");
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use rara::camera_files;

    #[test]
    fn names_are_numbered_and_no_file_is_replaced() {
        let folder = std::env::temp_dir().join(format!("rara-shots-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut shots = Shots::new(folder.join("shot_{}.png").display().to_string());
        std::fs::write(folder.join("shot_001.json"), "").unwrap();
        let path = shots.next();
        assert_eq!(path, folder.join("shot_002.png"));

        let eye = DVec3::new(1.0, -2.0, -3.5);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 40.0, (8, 6)).unwrap();
        let picture = Picture::filled(8, 6, [0.5; 4]);
        save(&picture, &camera, &path).unwrap();
        let again = save(&picture, &camera, &path).unwrap_err().to_string();
        assert!(again.contains("replaces nothing"), "{again}");
        assert_eq!(shots.next(), folder.join("shot_003.png"));

        let read = camera_files::load_camera(&folder.join("shot_002.json")).unwrap();
        assert_eq!(read, camera);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_camera_that_cannot_be_read_again_is_not_written() {
        let folder = std::env::temp_dir().join(format!("rara-far-shot-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let eye = DVec3::new(1.0, -2.0, -3.5);
        let given = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 40.0, (8, 6)).unwrap();
        let picture = Picture::filled(8, 6, [0.5; 4]);
        for x in [f64::INFINITY, f64::NAN] {
            let mut camera = given;
            camera.eye.x = x;
            assert!(save(&picture, &camera, &folder.join("far.png")).is_err());
        }
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_camera_is_named_as_a_shell_takes_it() {
        let text = wrote(Path::new("out/a.png"), "--mode hard");
        assert_eq!(
            text,
            "wrote out/a.png; as in rara render --camera out/a.json --mode hard"
        );
        if cfg!(not(windows)) {
            let text = wrote(Path::new("it's a $1.png"), "--mode hard");
            assert!(
                text.ends_with(r"--camera 'it'\''s a $1.json' --mode hard"),
                "{text}"
            );
        }
    }
}
