//! What a viewer leaves to the program that opens it.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::time::Duration;

use glam::DVec3;
use rara::{Camera, FrameStats, Picture, Settings};

use super::failure::Failure;
use super::layers::Clips;
use super::loading::Load;
use super::scenery::{FaceView, SceneView};

/// What a viewer shows.
#[derive(Debug)]
pub struct Shown<'a> {
    /// The camera, of the window's size.
    pub camera: Camera,
    /// What clips the scene, and which of its layers are shown.
    pub clips: &'a Clips,
    /// How it is drawn.
    pub settings: &'a Settings,
    /// The parts of cut faces that are in the picture.
    pub faces: FaceView,
    /// What the program has noted of the scene.
    pub notes: &'a [String],
}

/// The program that opens a viewer: it prints, reads and writes what the viewer does not know of.
pub trait Host {
    /// Prints a line for people: here to standard error.
    fn say(&mut self, line: &dyn Display) {
        eprintln!("{line}");
    }

    /// Prints why something failed that the window outlives. Returns what to show over the picture.
    fn warn(&mut self, failure: Failure) -> String {
        let text = failure.to_string();
        self.say(&text);
        text
    }

    /// Returns how to read the files that were dropped on a window of this size at once. The layers of all are one scene; what is
    /// up in its pictures is `None` where the files say it.
    fn read(&mut self, files: Vec<PathBuf>, up: Option<DVec3>, size: (u32, u32)) -> Load {
        Box::new(move |_| SceneView::of_files(&files, up, size))
    }

    /// Writes a screenshot to a file, or to one of the program's choice. Returns which it is.
    ///
    /// # Errors
    /// An [`Io`](rara::Error::Io) or [`Format`](rara::Error::Format) error is shown in the window, and others close it.
    fn screenshot(
        &mut self,
        picture: &Picture,
        file: Option<&Path>,
        shown: &Shown<'_>,
    ) -> Result<PathBuf, Failure>;

    /// Prints what draws this again, as the key F asks.
    fn describe(&mut self, _: &Shown<'_>) {}

    /// Prints the times of the last frame in a window of this size, and those from one frame to the next since the last time, as the
    /// key T asks.
    fn time(&mut self, _: (u32, u32), _: Option<&FrameStats>, _: &[Duration]) {}

    /// The window closes, and this was shown last; a window without a scene does not say so.
    ///
    /// # Errors
    /// They become the failure of the viewer.
    fn close(&mut self, _: &Shown<'_>) -> Result<(), Failure> {
        Ok(())
    }
}
