//! The plan of a cut, what a clip keeps of a scene: its constants and surfaces, whatever eye sees it.

use crate::passes::layers::CutLayers;
use crate::passes::region::{region_data, shortlist_from};
use crate::passes::scene_layer::SceneLayer;
use crate::passes::work::same;
use crate::types::{self, CutData, SceneData};
use rara_base::error::Result;
use rara_gpu::DeviceShape;
use rara_scene::camera::Camera;
use rara_scene::clip::{Clip, ClipOp};
use rara_scene::precision::ShFormat;
use rara_scene::settings::Settings;

/// A cut, decided but not recorded.
#[derive(Debug, Clone)]
pub(crate) struct CutPlan {
    /// For what kind of device pipelines are chosen.
    pub(crate) shape: DeviceShape,
    /// True when the scene has several layers.
    pub(crate) layered: bool,
    /// True when the clip's sides have to be found, of blocks and Gaussians whether in view or not.
    pub(crate) finds_sides: bool,
    /// The constants.
    pub(crate) data: CutData,
    /// Those of the scene's layers, and the surfaces of their regions.
    pub(crate) layers: CutLayers,
}

/// The facts of a scene that plans follow from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SceneFacts<'a> {
    /// At least one.
    pub(crate) layers: &'a [SceneLayer],
    pub(crate) gaussians: u32,
    pub(crate) blocks: u32,
    /// True when the Gaussians lie in another order than that of their numbers.
    pub(crate) reordered: bool,
    pub(crate) sh_degree: u32,
    pub(crate) sh_format: ShFormat,
    /// For what kind of device pipelines are chosen.
    pub(crate) shape: DeviceShape,
}

impl SceneFacts<'_> {
    /// The layers of which something shows.
    pub(crate) fn visible(&self) -> impl Iterator<Item = &SceneLayer> {
        self.layers.iter().filter(|layer| layer.is_visible())
    }
}

impl CutPlan {
    /// Decides what a cut needs. The clip is in the scene's space, and so is the camera whose own planes cut too, if there is
    /// one.
    pub(crate) fn new(
        scene: SceneFacts<'_>,
        camera: Option<&Camera>,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Self> {
        let own = scene.visible().filter_map(SceneLayer::clip);
        let planes = camera.map_or(Ok(Vec::new()), Camera::clip_planes)?;
        let of_camera = Clip::of(planes, ClipOp::And);
        let region = region_data(own.chain([clip, &of_camera]), settings)?;
        Ok(Self {
            shape: scene.shape,
            layered: scene.layers.len() > 1,
            finds_sides: region.mode != types::MODE_NONE,
            data: CutData {
                scene: SceneData {
                    gaussian_count: scene.gaussians,
                    block_count: scene.blocks,
                    sh_coefficients: (scene.sh_degree + 1) * (scene.sh_degree + 1),
                    layer_count: scene.layers.len() as u32,
                },
                region,
            },
            layers: CutLayers::new(scene.layers, camera, clip, &region)?,
        })
    }

    pub(crate) fn gaussians(&self) -> u64 {
        self.data.scene.gaussian_count.into()
    }

    pub(super) fn blocks(&self) -> u64 {
        self.data.scene.block_count.into()
    }

    /// `MODE_*`: `MODE_NONE` where there is nothing to clip with.
    pub(crate) fn mode(&self) -> u32 {
        self.data.region.mode
    }

    /// True when there is anything to clip with.
    pub(crate) fn clips(&self) -> bool {
        self.mode() != types::MODE_NONE
    }

    /// True when cutoff Gaussians can exist.
    pub(crate) fn cuts(&self) -> bool {
        matches!(self.mode(), types::MODE_RARA | types::MODE_EXACT)
    }

    /// True when the blocks have shortlists of the surfaces that may cut them.
    pub(crate) fn is_shortlisted(&self) -> bool {
        self.clips() && self.layers.most_surfaces() >= shortlist_from(self.shape)
    }

    /// True when the same is kept of another scene of the same sizes.
    pub(super) fn keeps_like(&self, other: &Self) -> bool {
        same(&self.data.region, &other.data.region) && self.layers.keep_like(&other.layers)
    }

    /// True when the scene holds and shows the same.
    pub(super) fn contains_like(&self, other: &Self) -> bool {
        same(&self.data.scene, &other.data.scene) && self.layers.contain_like(&other.layers)
    }

    /// True when another one has the same sides.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.keeps_like(other) && self.contains_like(other)
    }
}
