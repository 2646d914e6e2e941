//! How far what the pixels of a layer show has moved since an earlier frame.

use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use glam::DVec3;

use crate::passes::bin::lists;
use crate::passes::buffers::Buffers;
use crate::passes::cut_plan::CutPlan;
use crate::passes::eye_plan::EyePlan;
use crate::passes::layers::CutLayers;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders::motion;
use crate::passes::{compact, composite, project, shared, tiles};
use crate::types::{self, LayerMotion, SurfaceData};
use rara_gpu::{Attachments, Buffer, DepthUse, Drawer};
use rara_scene::camera::{Camera, Projection};

/// The buffers of a scene that tell how far edits have moved its Gaussians: of what they are and, if any has moved, of what
/// they were.
#[derive(Debug, Clone)]
pub(crate) struct Shapes(Buffer, Option<Buffer>);

impl Shapes {
    pub(crate) fn new(scene: &SceneBuffers) -> Self {
        let earlier = scene.earlier.as_ref();
        Self(scene.gaussians.clone(), earlier.map(|e| e.buffer().clone()))
    }
}

/// Where a layer of a frame is seen.
#[derive(Debug, Clone)]
struct LayerSight {
    /// The camera in the layer's space.
    camera: Camera,
    /// The scene's units in one of the layer's.
    unit: f64,
    /// What its positions are relative to.
    origin: DVec3,
    replaced_after: u32,
}

/// Where the layers of a frame are seen, which edits have moved their Gaussians, and what the clip keeps of them.
#[derive(Debug, Clone)]
pub(crate) struct Sight {
    layers: Arc<[LayerSight]>,
    /// What clones of the scene alone share.
    memory: Arc<AtomicU64>,
    /// The number of the last edit that has moved any of its Gaussians; 0 before.
    edit: u32,
    kept: CutLayers,
}

impl Sight {
    /// Finds where the layers of a scene have a camera that is in its space.
    pub(crate) fn new(scene: &SceneBuffers, camera: &Camera, cut: &CutPlan) -> Self {
        let seen = scene.layers().iter().map(|layer| {
            // Whatever its Gaussians are relative to: others may have taken their place.
            let placement = layer.state().placement;
            LayerSight {
                camera: camera.in_scene(&placement),
                unit: placement.scale(),
                origin: layer.origin,
                replaced_after: layer.replaced_after,
            }
        });
        Self {
            layers: seen.collect(),
            memory: scene.held.clone(),
            edit: scene.last_edit(),
            kept: cut.layers.clone(),
        }
    }

    /// The number of the last edit that an earlier frame has shown; `NO_EDITS` where there was none since.
    fn shown_by(&self, before: &Self) -> u32 {
        match Arc::ptr_eq(&self.memory, &before.memory) && before.edit != self.edit {
            true => before.edit,
            false => types::NO_EDITS,
        }
    }

    /// An earlier frame, if it tells where what this one shows was: it showed as many layers in the same projection.
    pub(crate) fn after<'a>(&self, before: Option<&'a Self>) -> Option<&'a Self> {
        let projection = |sight: &Self| sight.layers.first().map(|layer| layer.camera.projection);
        before.filter(|before| {
            before.layers.len() == self.layers.len() && projection(before) == projection(self)
        })
    }

    /// How the layers have moved since an earlier frame. Without one nothing has, and nothing was shown.
    pub(crate) fn motions<'a>(
        &'a self,
        before: Option<&'a Self>,
    ) -> impl Iterator<Item = LayerMotion> + 'a {
        let is_known = before.is_some();
        let before = before.unwrap_or(self);
        let since = self.shown_by(before);
        let kept_before = before.kept.surfaces().len();
        let has_room = kept_before + self.kept.surfaces().len() <= tiles::MOTION_SURFACES;
        let have_meshes = self.kept.have_meshes() || before.kept.have_meshes();
        let tells = has_room && !have_meshes;
        let pairs = self.layers.iter().zip(before.layers.iter()).enumerate();
        pairs.map(move |(at, (now, was))| {
            let stays =
                !tells || now.origin != was.origin || self.kept.keeps_like(&before.kept, at);
            let layer = &before.kept.layers()[at];
            LayerMotion {
                region: layer.region,
                clip_has_moved: (!stays).into(),
                first_surface: kept_before as u32,
                was_shown: u32::from(is_known) * layer.content.visible,
                since: since.max(now.replaced_after),
                ..way_of(&now.camera, now.unit, &was.camera)
            }
        })
    }

    /// The surfaces of its clips.
    pub(crate) fn surfaces(&self) -> &[SurfaceData] {
        self.kept.surfaces()
    }
}

/// The draw of the motion of the tiles' picture.
pub(crate) fn draw(plan: &EyePlan, attachments: Attachments) -> Draw<motion::Program> {
    let fronts = [&motion::VERT, &motion::MULTIVIEW_VERT];
    let (front, scope_view) = composite::front(fronts, attachments);
    let constants = motion::Constants {
        scope_view,
        expected_depth: plan.way.expects_depth,
        written_depth: plan.way.writes_depth,
        strongest: false, // nothing lies behind them
        layered: plan.cut.layers.layers().len() > 1,
        meshes: false,  // nobody asks whether they kept something before
        combined: true, // what the frame before had follows later
    };
    Draw::new(
        [front, &motion::FRAG],
        constants,
        attachments,
        DepthUse::Ignored,
    )
    .overwriting()
}

/// Draws inside the host's rendering scope. `origin` is where its viewport begins, px; pixels whose alpha is below `least_alpha`
/// keep what the host has drawn.
pub(crate) fn record(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (plan, b, shapes): (&EyePlan, &Buffers<EyePlan>, &Shapes),
    attachments: Attachments,
    (origin, least_alpha): ([f32; 2], f32),
) {
    let Shapes(gaussians, earlier) = shapes;
    let buffers = motion::Buffers {
        frame: b.get(&shared::MEMORY.frame),
        tile_begins: b.get(&lists::MEMORY.tile_begins),
        picture: b.get(&tiles::MEMORY.tile_picture),
        splats: b.get(&project::MEMORY.splats),
        splat_gaussians: b.get(&compact::MEMORY.splat_gaussians),
        motions: b.get(&tiles::MEMORY.motions),
        gaussians,
        earlier: earlier.as_ref().unwrap_or(gaussians),
        surfaces: b.get(&tiles::MEMORY.motion_surfaces),
        meshes: b.get(&tiles::MEMORY.motion_surfaces), // no shader reads it
    };
    let params = motion::Params {
        origin,
        least_alpha,
    };
    let (buffers, args) = ((buffers, |buffer| buffer), composite::args(b));
    draw(plan, attachments).draw(pipelines, drawer, buffers, params, args);
}

/// The map from a pixel now to the pixel before, less that which changes nothing, so that single precision holds small ways too.
/// Both cameras are in the layer's space.
fn way_of(now: &Camera, unit: f64, before: &Camera) -> LayerMotion {
    // From axes of the camera, in the layer's units, to those of the camera before.
    let turn = before.rotation * now.rotation.transpose();
    let way = before.rotation * (now.eye - before.eye);
    let seen = |at: DVec3| DVec3::new(before.fx * at.x, before.fy * at.y, 0.0);
    let centre = DVec3::new(before.cx, before.cy, 1.0);
    // Columns: what each number of the point adds to the pixel before, times its depth in the scene's units.
    let columns = match now.projection {
        Projection::Perspective => {
            let pixel = |at: DVec3| seen(at) + centre * at.z;
            let x = pixel(turn.x_axis / now.fx);
            let y = pixel(turn.y_axis / now.fy);
            let z = pixel(turn.z_axis) - x * now.cx - y * now.cy;
            [x - DVec3::X, y - DVec3::Y, z - DVec3::Z, pixel(way) * unit]
        }
        Projection::Orthographic => {
            let x = seen(turn.x_axis / now.fx);
            let y = seen(turn.y_axis / now.fy);
            let one = seen(way) + centre - x * now.cx - y * now.cy;
            [
                x - DVec3::X,
                y - DVec3::Y,
                seen(turn.z_axis / unit),
                one - DVec3::Z,
            ]
        }
    };
    let columns = if now == before {
        [DVec3::ZERO; 4]
    } else {
        columns
    };
    let [right, down, depth] = rows(columns);
    let turned = before.rotation;
    let [x, y, z] =
        [turned.x_axis, turned.y_axis, turned.z_axis].map(|axis| match now.projection {
            Projection::Perspective => (seen(axis) + centre * axis.z) * unit,
            Projection::Orthographic => seen(axis),
        });
    let [way_right, way_down, way_depth] = rows([x, y, z, DVec3::ZERO]);
    LayerMotion {
        right,
        down,
        depth,
        way_right,
        way_down,
        way_depth,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// The rows of a matrix of these columns.
fn rows(columns: [DVec3; 4]) -> [[f32; 4]; 3] {
    [0, 1, 2].map(|component| columns.map(|column| column[component] as f32))
}
