//! Several views of a scene and several scenes in one picture: two eyes in one scope, views one after the other, scenes
//! that stand turned, scaled and moved in a world, views by a host's matrices.

mod eyes;
mod matrices;
mod placed;

use std::cell::RefCell;

use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::common;
use rara::ash::vk;
use rara::glam::DVec3;
use rara::gpu::Bindings;
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Cut, Gaussians, LayerState, Picture, Raster, Renderer, RendererDesc,
    SceneBuffers, Settings, ShFormat,
};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const SIZE: (u32, u32) = (121, 97);

fn desc() -> RendererDesc {
    RendererDesc::new(FLOATS).bindings(Bindings::Mixed)
}

fn raster(raster: Raster) -> Settings {
    Settings::default().raster(raster)
}

fn headless(scene: &Gaussians, camera: &Camera, clip: &Clip) -> Picture {
    let mut headless = common::headless();
    headless.load(scene).expect("uploads");
    let rendered = headless.render(camera, clip, &Settings::default());
    rendered.expect("renders");
    headless.picture().expect("reads back")
}

/// Largest difference of two pictures, of 255, leaving out a share of the pixels.
fn apart(a: &[[f32; 4]], b: &[[f32; 4]], share: f64) -> f32 {
    assert_eq!(a.len(), b.len());
    let worst = |(a, b): (&[f32; 4], &[f32; 4])| {
        let differences = a.iter().zip(b).map(|(a, b)| 255.0 * (a - b).abs());
        differences.fold(0.0, f32::max)
    };
    let mut all: Vec<_> = a.iter().zip(b).map(worst).collect();
    all.sort_by(f32::total_cmp);
    all[((1.0 - share) * (all.len() - 1) as f64) as usize]
}
