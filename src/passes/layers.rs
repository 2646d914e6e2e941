//! The layers of a scene as the shaders read them: how much of each shows, what is kept of it, and where it has the camera.

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;

use crate::passes::meshes::Meshes;
use crate::passes::scene_layer::SceneLayer;
use crate::passes::view::layer_view;
use crate::passes::{region, work};
use crate::types::{self, CutLayer, LayerContent, LayerRegion, LayerView, RegionData, SurfaceData};
use rara_base::error::Result;
use rara_base::limits;
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;

/// The most entries of a record that a mesh needs: it is four planes, or a walk of three entries.
const MESH_ENTRIES: u32 = 4;

/// The layers of a cut and their surfaces. A copy has the same ones.
#[derive(Debug, Clone)]
pub(crate) struct CutLayers {
    lists: Arc<(Vec<CutLayer>, Vec<SurfaceData>, Meshes)>,
}

impl CutLayers {
    /// The layers of a scene. The clip and the camera whose own planes cut too, if there is one, are in its space; `region`
    /// follows from them and the settings. An error is that of the camera's planes.
    pub(super) fn new(
        scene: &[SceneLayer],
        camera: Option<&Camera>,
        clip: &Clip,
        region: &RegionData,
    ) -> Result<Self> {
        let has_region = region.mode != types::MODE_NONE;
        let (mut layers, mut surfaces) = (Vec::<CutLayer>::with_capacity(scene.len()), Vec::new());
        let mut meshes = Meshes::default();
        for (index, layer) in scene.iter().enumerate() {
            let mut data = CutLayer {
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
            // Nobody asks for a hidden layer's region: no cut is found anew where only that changes.
            if layer.is_visible() {
                let clip = layer.clip().unwrap_or(clip);
                let clip = camera.map_or(Ok(Cow::Borrowed(clip)), |camera| camera.sees_of(clip))?;
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
                    let of_layer = clip.in_scene(&layer.placement());
                    surfaces.extend(region::surfaces(&of_layer, corners, &mut meshes));
                    data.region.surface_count = surfaces.len() as u32 - data.region.first_surface;
                    data.region.combined = clip.is_general().into();
                }
            }
            layers.push(data);
        }
        Ok(Self {
            lists: Arc::new((layers, surfaces, meshes)),
        })
    }

    /// The layers, in the scene's order.
    pub(crate) fn layers(&self) -> &[CutLayer] {
        &self.lists.0
    }

    /// The surfaces of their regions.
    pub(crate) fn surfaces(&self) -> &[SurfaceData] {
        &self.lists.1
    }

    /// The meshes that some of these are.
    pub(crate) fn meshes(&self) -> &Meshes {
        &self.lists.2
    }

    /// True when there is one.
    pub(crate) fn have_meshes(&self) -> bool {
        !self.meshes().is_empty()
    }

    /// The most surfaces that a layer's region has.
    pub(crate) fn most_surfaces(&self) -> u32 {
        let counts = self.layers().iter().map(|layer| layer.region.surface_count);
        counts.max().unwrap_or(0)
    }

    /// The most vectors that the surfaces of a cutoff record and of a long record take.
    pub(crate) fn most_record_vectors(&self) -> [u32; 2] {
        let vectors = self.layers().iter().map(|layer| {
            let LayerRegion {
                combined,
                surface_count,
                ..
            } = layer.region;
            let (each, room) = match combined {
                0 => (1, limits::RECORD_PLANES),
                _ => (types::ENTRY_VECTORS, limits::RECORD_SURFACES),
            };
            let entries = self.entries(&layer.region);
            // A mesh's faces take the room that there is.
            let short = if entries > surface_count {
                room
            } else {
                entries.min(room)
            };
            [each * short, each * entries]
        });
        vectors.fold([0; 2], |[a, b], [c, d]| [a.max(c), b.max(d)])
    }

    /// How many entries of a record the surfaces of a region need at most.
    fn entries(&self, region: &LayerRegion) -> u32 {
        let first = region.first_surface as usize;
        let own = &self.surfaces()[first..first + region.surface_count as usize];
        let of_surface = |surface: &SurfaceData| match surface.kind {
            types::SURFACE_MESH => MESH_ENTRIES,
            _ => 1,
        };
        own.iter().map(of_surface).sum()
    }

    /// The most entries that a record needs.
    fn most_entries(&self) -> u32 {
        let entries = self
            .layers()
            .iter()
            .map(|layer| self.entries(&layer.region));
        entries.max().unwrap_or(0)
    }

    /// True when more than one surface may cut a splat.
    pub(crate) fn are_several(&self) -> bool {
        self.most_entries() > 1
    }

    /// True when more than `RECORD_SURFACES` may cut a splat.
    pub(crate) fn are_many(&self) -> bool {
        self.most_entries() > limits::RECORD_SURFACES
    }

    /// True when splats of a layer are weighed as combinations of surfaces that may bend.
    pub(crate) fn are_combined(&self) -> bool {
        self.layers().iter().any(|layer| layer.region.combined != 0)
    }

    /// True when other layers hold and show the same.
    pub(super) fn contain_like(&self, other: &Self) -> bool {
        self.are_like(other, |layer| layer.content)
    }

    /// True when the same is kept of other layers.
    pub(super) fn keep_like(&self, other: &Self) -> bool {
        self.are_like(other, |layer| layer.region)
            && bytemuck::cast_slice::<_, u8>(self.surfaces())
                == bytemuck::cast_slice::<_, u8>(other.surfaces())
    }

    /// True when the same is kept of one layer, by its number.
    pub(super) fn keeps_like(&self, other: &Self, layer: usize) -> bool {
        let [ours, theirs] = [self, other].map(|layers| {
            let LayerRegion {
                op,
                first_surface,
                surface_count,
                ..
            } = layers.layers()[layer].region;
            let surfaces = &layers.surfaces()[first_surface as usize..][..surface_count as usize];
            (op, bytemuck::cast_slice::<_, u8>(surfaces))
        });
        ours == theirs
    }

    fn are_like<T: bytemuck::NoUninit>(&self, other: &Self, part: fn(&CutLayer) -> T) -> bool {
        let (ours, theirs) = (self.layers(), other.layers());
        let mut pairs = ours.iter().zip(theirs);
        ours.len() == theirs.len() && pairs.all(|(a, b)| work::same(&part(a), &part(b)))
    }
}

/// Where each layer has the camera, which is in the scene's space. Nobody asks for a hidden layer's view: no frame is computed
/// anew where only that changes.
pub(super) fn views(scene: &[SceneLayer], camera: &Camera) -> Vec<LayerView> {
    let view = |layer: &SceneLayer| {
        let placement = &layer.placement();
        match layer.is_visible() {
            true => layer_view(&camera.in_scene(placement), placement.scale()),
            false => bytemuck::Zeroable::zeroed(),
        }
    };
    scene.iter().map(view).collect()
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
