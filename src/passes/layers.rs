//! The layers of a frame as the shaders read them: where each has the camera, how much of it shows, and what is kept of it.

use std::sync::Arc;

use glam::Vec3;

use crate::passes::scene_layer::SceneLayer;
use crate::passes::view::layer_view;
use crate::passes::{region, work};
use crate::types::{self, LayerContent, LayerData, RegionData, SurfaceData};
use rara_base::error::Result;
use rara_base::limits;
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;

/// The layers and their surfaces. A copy has the same ones.
#[derive(Debug, Clone)]
pub(crate) struct Layers {
    lists: Arc<(Vec<LayerData>, Vec<SurfaceData>)>,
}

impl Layers {
    /// The layers of a scene. Camera and clip are in its space; `region` follows from clip, camera and settings. An error is
    /// that of the camera's own planes.
    pub(super) fn new(
        scene: &[SceneLayer],
        camera: &Camera,
        clip: &Clip,
        region: &RegionData,
    ) -> Result<Self> {
        let has_region = region.mode != types::MODE_NONE;
        let (mut layers, mut surfaces) = (Vec::<LayerData>::with_capacity(scene.len()), Vec::new());
        for (index, layer) in scene.iter().enumerate() {
            // Nobody asks for a hidden layer's view and region: no frame is computed anew where only they change.
            let mut data = LayerData {
                content: LayerContent {
                    first_block: layer.first_block,
                    gaussian_end: layer.gaussian_end(),
                    opacity: layer.state.opacity,
                    visible: layer.is_visible().into(),
                    antialiased: layer.training.antialiased.into(),
                    low_pass: layer.training.low_pass,
                    ..bytemuck::Zeroable::zeroed()
                },
                ..bytemuck::Zeroable::zeroed()
            };
            if layer.is_visible() {
                let placement = &layer.placement();
                data.views = [layer_view(&camera.in_scene(placement), placement.scale())];
                let clip = camera.sees_of(layer.clip().unwrap_or(clip))?;
                // Quadrics are packed relative to a point among the layer's own centres.
                let is_anchored_alike =
                    |other: &SceneLayer| !clip.is_general() || other.corners == layer.corners;
                let before = index.checked_sub(1).map(|before| &scene[before]);
                if before.is_some_and(|b| b.is_clipped_like(layer) && is_anchored_alike(b)) {
                    data.region = layers[index - 1].region;
                } else if has_region {
                    data.region.op = region::op(&clip);
                    data.region.first_surface = surfaces.len() as u32;
                    let corners = layer.corners.map(|corner| corner.as_dvec3());
                    surfaces.extend(region::surfaces(&clip.in_scene(placement), corners));
                    data.region.surface_count = surfaces.len() as u32 - data.region.first_surface;
                    data.region.combined = clip.is_general().into();
                }
            }
            layers.push(data);
        }
        Ok(Self {
            lists: Arc::new((layers, surfaces)),
        })
    }

    /// The layers, in the scene's order.
    pub(crate) fn layers(&self) -> &[LayerData] {
        &self.lists.0
    }

    /// The surfaces of their regions.
    pub(crate) fn surfaces(&self) -> &[SurfaceData] {
        &self.lists.1
    }

    /// The most surfaces that a layer's region has.
    pub(crate) fn most_surfaces(&self) -> u32 {
        let counts = self.layers().iter().map(|layer| layer.region.surface_count);
        counts.max().unwrap_or(0)
    }

    /// The most vectors that the surfaces of a cutoff record take.
    pub(crate) fn most_record_vectors(&self) -> u32 {
        let vectors = self
            .layers()
            .iter()
            .map(|layer| match layer.region.combined {
                0 => layer.region.surface_count,
                _ => types::ENTRY_VECTORS * layer.region.surface_count.min(limits::MAX_CUTTING),
            });
        vectors.max().unwrap_or(0)
    }

    /// True when splats of a layer are weighed as combinations of surfaces that may bend.
    pub(crate) fn are_combined(&self) -> bool {
        self.layers().iter().any(|layer| layer.region.combined != 0)
    }

    /// True when other layers hold and show the same.
    pub(super) fn contain_like(&self, other: &Self) -> bool {
        self.are_like(other, |layer| layer.content)
    }

    /// True when other layers have the camera where these have it.
    pub(super) fn see_like(&self, other: &Self) -> bool {
        self.are_like(other, |layer| layer.views)
    }

    /// True when the same is kept of other layers.
    pub(super) fn keep_like(&self, other: &Self) -> bool {
        self.are_like(other, |layer| layer.region)
            && bytemuck::cast_slice::<_, u8>(self.surfaces())
                == bytemuck::cast_slice::<_, u8>(other.surfaces())
    }

    fn are_like<T: bytemuck::NoUninit>(&self, other: &Self, part: fn(&LayerData) -> T) -> bool {
        let (ours, theirs) = (self.layers(), other.layers());
        let mut pairs = ours.iter().zip(theirs);
        ours.len() == theirs.len() && pairs.all(|(a, b)| work::same(&part(a), &part(b)))
    }
}

/// The numbers that the depth keys take from each layer: the camera in its space, the box around its centres, and the
/// scene's units in one of its own.
pub(super) fn boxes<'a>(
    scene: &'a [SceneLayer],
    camera: &'a Camera,
) -> impl Iterator<Item = (Camera, [Vec3; 2], f64)> {
    let visible = scene.iter().filter(|layer| layer.is_visible());
    visible.map(move |layer| {
        let placement = &layer.placement();
        (camera.in_scene(placement), layer.corners, placement.scale())
    })
}
