//! The buffers that all stages share: the frame's constants and counts, and those of the scene.

use crate::passes::storage::{Storage, memory};
use crate::types::{FrameCounts, FrameData, LayerData, SurfaceData};

memory! {
    /// The frame's constants, and those of its layers.
    frame: |plan| {
        let layers = u64::from(plan.data.scene.layer_count);
        size_of::<FrameData>() as u64 + layers * size_of::<LayerData>() as u64
    };
    /// The surfaces of the layers' regions; for all layers wherever they are placed, so that one that moves needs no other
    /// buffer.
    surfaces: |plan| {
        let most = u64::from(plan.data.scene.layer_count) * u64::from(plan.layers.most_surfaces());
        most * size_of::<SurfaceData>() as u64
    };
    /// What is counted, and the indirect commands that follow from it.
    counts: |_| size_of::<FrameCounts>() as u64;
    /// What is bound in place of buffers of which a frame needs no byte.
    empty: |_| 16;
}

/// The buffers of a scene.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) gaussians: Storage,
    pub(super) sh: Storage,
    pub(super) blocks: Storage,
}

/// The buffers of the frame's scene.
pub(super) static SCENE: Scene = Scene {
    gaussians: Storage::of_scene("gaussians", |scene| &scene.gaussians),
    sh: Storage::of_scene("sh", |scene| &scene.sh),
    blocks: Storage::of_scene("blocks", |scene| &scene.blocks),
};
