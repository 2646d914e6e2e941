//! The estimate of a frame's pairs of tile and splat, which is made anew only where what it follows from has changed.

use crate::passes::SceneBuffers;
use rara_scene::camera::Camera;

/// The estimate that was made last.
#[derive(Debug, Default)]
pub(super) struct PairEstimate {
    /// The scene's number, how often its layers had been changed, the camera in its space, and that of whose picture it shows
    /// a part.
    made_of: Option<(u64, u64, Camera, Camera)>,
    pairs: u32,
}

impl PairEstimate {
    /// The pairs of a scene in the picture of a camera in its space, which is a part of that of `whole`.
    pub(super) fn update(&mut self, scene: &SceneBuffers, camera: &Camera, whole: &Camera) -> u32 {
        let from = (scene.id, scene.changes, *camera, *whole);
        if self.made_of != Some(from) {
            self.pairs = scene.estimated_pairs_of_part(camera, whole);
            self.made_of = Some(from);
        }
        self.pairs
    }

    /// The last one; 0 before there is any.
    pub(super) fn last(&self) -> u32 {
        self.pairs
    }
}
