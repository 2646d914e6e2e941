//! Cameras as JSON, as `--camera` and `--cameras` read them: in the statistics, beside screenshots, and by `--save-camera`.

use std::path::PathBuf;

use clap::Args;
use rara::camera_files::SavedCamera;
use serde::Serialize;

use super::camera::HEADING;
use super::output;
use super::values;
use super::views::NamedView;

/// The text of a file of a [`SavedCamera`], or of several.
pub(super) fn text(document: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(document);
    text.expect("the documents have string keys only") + "\n"
}

/// Where the cameras go.
#[derive(Debug, Args)]
pub(super) struct SaveCameraArgs {
    /// Write the camera of the picture to a JSON file
    ///
    /// --camera reads the file and draws the same picture. If there are several pictures, the file has a list of cameras with
    /// names, which --cameras and --view can use.
    #[arg(long, value_name = "FILE", value_parser = values::json_file(), help_heading = HEADING)]
    save_camera: Option<PathBuf>,
}

impl SaveCameraArgs {
    /// Writes the cameras of all pictures, if they are wanted.
    pub(super) fn save<'a>(
        &self,
        views: impl ExactSizeIterator<Item = &'a NamedView>,
    ) -> rara::Result<()> {
        let Some(file) = &self.save_camera else {
            return Ok(());
        };
        output::check_file(file)?;
        let is_one = views.len() == 1;
        let saved = views.map(|view| match SavedCamera::from(&view.camera) {
            camera if is_one => camera,
            camera => camera.named(view.name.clone()),
        });
        let saved: Vec<_> = saved.collect();
        let text = match &saved[..] {
            [one] => text(one),
            several => text(&several),
        };
        output::text(file, &text)
    }
}

#[cfg(test)]
mod tests;
