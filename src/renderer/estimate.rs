//! The estimate of a frame's pairs of tile and splat, which is made anew only where what it follows from has changed.

use crate::camera::Camera;
use crate::passes::SceneBuffers;

/// The estimate that was made last.
#[derive(Debug, Default)]
pub(super) struct PairEstimate {
    /// The scene's number, how often its layers had been changed, and the camera in its space.
    made_of: Option<(u64, u64, Camera)>,
    pairs: u32,
}

impl PairEstimate {
    /// The pairs of a scene in the picture of a camera in its space.
    pub(super) fn of(&mut self, scene: &SceneBuffers, camera: &Camera) -> u32 {
        let from = (scene.id, scene.changes, *camera);
        if self.made_of != Some(from) {
            self.pairs = scene.estimated_pairs(camera);
            self.made_of = Some(from);
        }
        self.pairs
    }

    /// The last one; 0 before there is any.
    pub(super) fn last(&self) -> u32 {
        self.pairs
    }
}
