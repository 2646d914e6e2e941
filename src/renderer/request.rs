//! What is asked of a frame.

use super::cut::Cut;
use super::outcome::Submission;
use crate::passes::{SceneBuffers, SplatColours};
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::precision::TargetFormat;
use rara_scene::settings::Settings;

/// The part of a scene that a frame shows. It is given as a clip, or as a [`Cut`], which other frames may show too. Functions
/// that take it also take a reference to either.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Kept<'a> {
    /// The frame shows what this clip keeps, and finds it for itself.
    Clip(&'a Clip),
    /// The frame shows this cut of its scene, which must be [prepared](Cut::prepare) before the frame.
    Cut(&'a Cut),
}

impl<'a> From<&'a Clip> for Kept<'a> {
    fn from(clip: &'a Clip) -> Self {
        Self::Clip(clip)
    }
}

impl<'a> From<&'a Cut> for Kept<'a> {
    fn from(cut: &'a Cut) -> Self {
        Self::Cut(cut)
    }
}

/// The picture that a frame is to show, and how the frame is submitted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameRequest<'a> {
    pub(crate) scene: &'a SceneBuffers,
    pub(crate) camera: &'a Camera,
    pub(crate) kept: Kept<'a>,
    pub(crate) settings: &'a Settings,
    pub(crate) submission: Submission,
    /// The target's format, where nothing lies below, so that the tiles' picture may be the picture; `None` where it has to
    /// be drawn.
    pub(crate) picture: Option<TargetFormat>,
    /// The camera of whose picture `camera` shows a part; `None` where it shows all of it.
    pub(crate) whole: Option<&'a Camera>,
    pub(crate) colours: SplatColours,
}

impl<'a> FrameRequest<'a> {
    /// True when splats have colours of linear light.
    pub(crate) fn draws_linear(&self) -> bool {
        self.colours == SplatColours::Scene && self.scene.is_linear()
    }

    /// A whole picture that is drawn over what lies below, submitted while earlier frames are unfinished.
    pub(crate) fn in_flight(
        scene: &'a SceneBuffers,
        camera: &'a Camera,
        kept: Kept<'a>,
        settings: &'a Settings,
    ) -> Self {
        Self {
            scene,
            camera,
            kept,
            settings,
            submission: Submission::InFlight,
            picture: None,
            whole: None,
            colours: SplatColours::Scene,
        }
    }
}
