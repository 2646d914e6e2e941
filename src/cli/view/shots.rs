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
            "this file, or the .json of its camera next to it, exists already; a screenshot replaces nothing: choose \
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
mod tests;
