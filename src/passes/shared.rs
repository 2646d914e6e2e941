//! The buffers of an eye that no stage writes first, or that all share, and those of the scene.

use crate::passes::eye_plan::EyePlan;
use crate::passes::resources::OfScene;
use crate::passes::storage::memory;
use crate::types::{FrameCounts, FrameData, LayerData};

memory! { EyePlan:
    /// The frame's constants, and those of its layers.
    frame: |plan| {
        let layers = u64::from(plan.cut.data.scene.layer_count);
        size_of::<FrameData>() as u64 + layers * size_of::<LayerData>() as u64
    };
    /// What is counted, and the indirect commands that follow from it.
    counts: |_| size_of::<FrameCounts>() as u64;
    /// It is bound in place of the buffers of which a frame needs no byte.
    empty: |_| 16;
}

/// The buffers of a scene.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) gaussians: OfScene,
    pub(super) sh: OfScene,
    pub(super) blocks: OfScene,
}

/// The buffers of the frame's scene.
pub(super) static SCENE: Scene = Scene {
    gaussians: OfScene(|scene| &scene.gaussians),
    sh: OfScene(|scene| &scene.sh),
    blocks: OfScene(|scene| &scene.blocks),
};
