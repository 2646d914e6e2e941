//! How far what the pixels of a layer show has moved since an earlier frame.

use std::sync::Arc;

use glam::{DVec3, DVec4};

use crate::passes::bin::lists;
use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::scene_layer::SceneLayer;
use crate::passes::shaders::motion;
use crate::passes::storage::buffers;
use crate::passes::{compact, composite, project, shared, tiles};
use crate::types::LayerMotion;
use rara_gpu::{Attachments, DepthUse, Drawer};
use rara_scene::camera::{Camera, Projection};

/// Where each layer of a frame has the camera: the camera in the layer's space, and the scene's units in one of the layer's.
#[derive(Debug, Clone)]
pub(crate) struct Sight {
    layers: Arc<[(Camera, f64)]>,
}

impl Sight {
    /// Finds where these layers have a camera that is in the space of their scene.
    pub(crate) fn new(layers: &[SceneLayer], camera: &Camera) -> Self {
        let seen = layers.iter().map(|layer| {
            // Whatever its Gaussians are relative to: others may have taken their place.
            let placement = layer.state().placement;
            (camera.in_scene(&placement), placement.scale())
        });
        Self {
            layers: seen.collect(),
        }
    }

    /// How the layers have moved since an earlier frame. Without one nothing has, nor since one of a scene of other layers or
    /// of another projection.
    pub(crate) fn motions<'a>(
        &'a self,
        before: Option<&'a Self>,
    ) -> impl Iterator<Item = LayerMotion> + 'a {
        let before = before.filter(|before| before.layers.len() == self.layers.len());
        let before = before.unwrap_or(self).layers.iter();
        let pairs = self.layers.iter().zip(before);
        pairs.map(|((now, unit), (before, _))| way_of(now, *unit, before))
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
    (plan, b): (&EyePlan, &Buffers<EyePlan>),
    attachments: Attachments,
    (origin, least_alpha): ([f32; 2], f32),
) {
    let buffers = buffers!(motion {
        shared::MEMORY => [frame],
        lists::MEMORY => [tile_begins],
        project::MEMORY => [splats],
        compact::MEMORY => [splat_gaussians],
        tiles::MEMORY => [motions];
        picture: &tiles::MEMORY.tile_picture,
    });
    let params = motion::Params {
        origin,
        least_alpha,
    };
    let (buffers, args) = ((buffers, |storage| b.get(storage)), composite::args(b));
    draw(plan, attachments).draw(pipelines, drawer, buffers, params, args);
}

/// The map from a pixel now to the pixel before, less that which changes nothing, so that single precision holds small ways too.
/// Both cameras are in the layer's space.
fn way_of(now: &Camera, unit: f64, before: &Camera) -> LayerMotion {
    if now == before || now.projection != before.projection {
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
    let row = |component: usize| {
        let [a, b, c, d] = columns.map(|column| column[component]);
        DVec4::new(a, b, c, d).as_vec4().into()
    };
    LayerMotion {
        right: row(0),
        down: row(1),
        depth: row(2),
    }
}
