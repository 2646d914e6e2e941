//! How far what the pixels of a layer show has moved since an earlier frame.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use glam::DVec3;

use crate::passes::bin::lists;
use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders::motion;
use crate::passes::{compact, composite, project, shared, tiles};
use crate::types::{self, LayerMotion};
use rara_base::error::Result;
use rara_gpu::{Attachments, Buffer, BufferDesc, DepthUse, Device, Drawer, Location};
use rara_scene::camera::{Camera, Projection};

/// What a scene keeps of Gaussians that edits have moved: what they were in the last frame.
#[derive(Debug, Clone)]
pub(crate) struct EarlierShapes {
    buffer: Buffer,
    /// The number of the last edit that has moved any, from 1 on.
    edit: u32,
    /// The number of the last one that a frame has shown.
    shown: Arc<AtomicU32>,
}

impl EarlierShapes {
    /// Makes room for as many bytes as a scene's Gaussians take. Nothing is in it yet.
    pub(super) fn new(device: &Device, size: u64) -> Result<Self> {
        device.check_budget("what edited Gaussians were", size, 0)?;
        let desc = BufferDesc {
            name: "earlier",
            size,
            location: Location::GpuOnly,
        };
        Ok(Self {
            buffer: device.create_buffer(&desc)?,
            edit: 0,
            shown: Arc::default(),
        })
    }

    pub(super) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// The numbers of the last edit and of the last one that a frame has shown.
    pub(super) fn numbers(&self) -> [u32; 2] {
        [self.edit, self.shown.load(Ordering::Relaxed)]
    }

    /// The same after one more edit.
    pub(super) fn edited(&self) -> Self {
        Self {
            edit: self.edit + 1,
            ..self.clone()
        }
    }

    /// Notes that a frame shows the edits.
    pub(crate) fn show(&self) {
        self.shown.store(self.edit, Ordering::Relaxed);
    }
}

/// The buffers that tell how far edits have moved Gaussians: of what they are and of what they were.
#[derive(Debug, Clone)]
pub(crate) struct EditedShapes([Buffer; 2]);

impl EditedShapes {
    /// Those of a scene, if edits have moved any of its Gaussians.
    pub(crate) fn new(scene: &SceneBuffers) -> Option<Self> {
        let earlier = scene.earlier.as_ref()?;
        Some(Self([&scene.gaussians, &earlier.buffer].map(Clone::clone)))
    }

    pub(super) fn buffers(&self) -> [&Buffer; 2] {
        self.0.each_ref()
    }
}

/// Where a layer of a frame is seen.
#[derive(Debug, Clone)]
struct LayerSight {
    /// The camera in the layer's space.
    camera: Camera,
    /// The scene's units in one of the layer's.
    unit: f64,
    replaced_after: u32,
}

/// Where the layers of a frame are seen, and which edits have moved their Gaussians.
#[derive(Debug, Clone)]
pub(crate) struct Sight {
    layers: Arc<[LayerSight]>,
    /// What clones of the scene alone share.
    memory: Arc<AtomicU64>,
    /// The number of the last edit that has moved any of its Gaussians; 0 before.
    edit: u32,
}

impl Sight {
    /// Finds where the layers of a scene have a camera that is in its space.
    pub(crate) fn new(scene: &SceneBuffers, camera: &Camera) -> Self {
        let seen = scene.layers().iter().map(|layer| {
            // Whatever its Gaussians are relative to: others may have taken their place.
            let placement = layer.state().placement;
            LayerSight {
                camera: camera.in_scene(&placement),
                unit: placement.scale(),
                replaced_after: layer.replaced_after,
            }
        });
        Self {
            layers: seen.collect(),
            memory: scene.held.clone(),
            edit: scene.last_edit(),
        }
    }

    /// The number of the last edit that an earlier frame has shown; `NO_EDITS` where there was none since.
    fn shown_by(&self, before: &Self) -> u32 {
        match Arc::ptr_eq(&self.memory, &before.memory) && before.edit != self.edit {
            true => before.edit,
            false => types::NO_EDITS,
        }
    }

    /// How the layers have moved since an earlier frame. Without one nothing has, nor since one of a scene of other layers or
    /// of another projection.
    pub(crate) fn motions<'a>(
        &'a self,
        before: Option<&'a Self>,
    ) -> impl Iterator<Item = LayerMotion> + 'a {
        let before = before.filter(|before| before.layers.len() == self.layers.len());
        let before = before.unwrap_or(self);
        let since = self.shown_by(before);
        let pairs = self.layers.iter().zip(before.layers.iter());
        pairs.map(move |(now, before)| LayerMotion {
            since: since.max(now.replaced_after),
            ..way_of(&now.camera, now.unit, &before.camera)
        })
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
    };
    Draw::new(
        [front, &motion::FRAG],
        constants,
        attachments,
        DepthUse::Ignored,
    )
}

/// Draws inside the host's rendering scope. `origin` is where its viewport begins, px; pixels whose alpha is below `least_alpha`
/// keep what the host has drawn.
pub(crate) fn record(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (plan, b, edited): (&EyePlan, &Buffers<EyePlan>, Option<&EditedShapes>),
    attachments: Attachments,
    (origin, least_alpha): ([f32; 2], f32),
) {
    let empty = b.get(&shared::MEMORY.empty);
    let [gaussians, earlier] = edited.map_or([empty; 2], EditedShapes::buffers);
    let buffers = motion::Buffers {
        frame: b.get(&shared::MEMORY.frame),
        tile_begins: b.get(&lists::MEMORY.tile_begins),
        picture: b.get(&tiles::MEMORY.tile_picture),
        splats: b.get(&project::MEMORY.splats),
        splat_gaussians: b.get(&compact::MEMORY.splat_gaussians),
        motions: b.get(&tiles::MEMORY.motions),
        gaussians,
        earlier,
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
    if now.projection != before.projection {
        return bytemuck::Zeroable::zeroed();
    }
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
