//! Scenes of several layers: they are sorted and blended as one scene, each in its place, with its opacity, or hidden.

mod changes;
mod parts;
mod placed;
mod selections;

use glam::{DQuat, DVec3, Quat};
use rara::{
    Clip, ClipOp, Gaussians, Headless, Layer, LayerState, Mode, Picture, Placement, Scene, Settings,
};

use crate::common;

const SIZE: (u32, u32) = (253, 190);

/// A generated scene, and the same one as layers of uneven sizes, some of them smaller than a block and one empty.
fn in_parts(count: usize) -> (Gaussians, Vec<Gaussians>) {
    let (_, scene) = common::generated_scenes(count).remove(0);
    let ends = [0, 1, 1, 200, 457, scene.len() / 3, scene.len()];
    let parts = ends
        .windows(2)
        .map(|ends| common::picked(&scene, ends[0]..ends[1]));
    let parts = parts.collect();
    (scene, parts)
}

fn named<'a>(parts: impl IntoIterator<Item = (&'a Gaussians, LayerState)>) -> Scene<'a> {
    let layers = parts.into_iter().enumerate();
    layers
        .map(|(index, (part, state))| Layer::new(format!("layer {index}"), part).with(state))
        .collect()
}

/// A placement that turns, moves and scales.
fn elsewhere(scale: f64) -> Placement {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.9, -0.2).normalize(), 0.8);
    Placement::new(DVec3::new(0.4, -0.2, 0.3), turn, scale).expect("a placement")
}

fn picture(headless: &mut Headless) -> Picture {
    headless.picture().expect("reads back")
}

/// The layer's Gaussians where its state puts them, and as faint as it makes them.
fn placed(part: &Gaussians, state: &LayerState) -> Gaussians {
    let mut moved = part.clone();
    let (turn, scale) = (state.placement.rotation(), state.placement.scale() as f32);
    for position in moved.positions_mut() {
        *position = state.placement.to_world(position.as_dvec3()).as_vec3();
    }
    for one in moved.scales_mut() {
        *one *= scale;
    }
    for rotation in moved.rotations_mut() {
        let turned = (turn * rotation.as_dquat()).normalize();
        *rotation = Quat::from_array(turned.to_array().map(|x| x as f32));
    }
    for opacity in moved.opacities_mut() {
        *opacity *= state.opacity;
    }
    moved
}
