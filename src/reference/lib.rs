//! The renderer on the CPU, written for reading: one file per stage, under the stages' names on the GPU.
//!
//! In f64 it is the truth that errors are measured against. In f32 it is the twin of the shaders: integers agree exactly and
//! floats to a few units in the last place. Nothing in here knows about Vulkan.

#![forbid(unsafe_code)]
#![allow(missing_docs)] // it is no API

pub mod bin;
pub mod chord;
pub mod classify;
pub mod clip;
mod combined;
pub mod compact;
pub mod comparison;
pub mod cutoff;
pub mod depth;
pub mod differences;
pub mod exact;
pub mod footprint;
pub mod harmonics;
pub mod layer;
pub mod maps;
pub mod orthant;
mod polytope;
pub mod project;
pub mod quadrature;
mod real;
pub mod region;
pub mod sort;
pub mod splat;
mod threshold;
mod view;

pub use cutoff::SplatCut;
pub use footprint::{Footprint, Gradients};
pub use layer::LayerView;
pub use project::Splat;
pub use real::{Real, Vec3, vec3};
pub use region::{HalfSpace, Side};
pub use view::ViewTransform;

use rara_base::stats::Counts;
use rara_scene::Scene;
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::picture::{Picture, linear_light};
use rara_scene::settings::{Settings, Show};

#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceFrame {
    /// The picture, rounded to f32 at the very end.
    pub picture: Picture,
    pub counts: Counts,
}

/// Renders a frame: the stages in order.
pub fn render<'a, T: Real>(
    scene: impl Into<Scene<'a>>,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> ReferenceFrame {
    let scene = scene.into();
    let layers = layer::layers(&scene, camera, clip);
    // Find each Gaussian's side.
    let sides: Vec<_> = layers.iter().map(|layer| sides(layer, settings)).collect();
    let mut splats = in_order::<T>(&layers, &sides, camera, settings);
    let alpha_max = T::of(f64::from(scene.alpha_max()));
    splats
        .iter_mut()
        .for_each(|splat| splat.alpha_max = alpha_max);
    // Blend them, in linear light where their colours are that.
    let is_linear = scene.is_linear() && settings.show == Show::Colour;
    let mut settings = *settings;
    if is_linear {
        settings.background = settings.background.map(|rgb| rgb.map(linear_light));
    }
    let mut picture = splat::splat(&splats, &ViewTransform::new(camera), &settings);
    if is_linear {
        picture.store_light();
    }
    ReferenceFrame {
        picture,
        counts: counts(&sides.concat()),
    }
}

fn sides<T: Real>(layer: &LayerView<'_, T>, settings: &Settings) -> Vec<Side> {
    match layer.visible {
        true => classify::classify(&layer.gaussians, &layer.view, &layer.clip, settings),
        false => vec![Side::Culled; layer.gaussians.len()],
    }
}

/// The splats that are drawn, front to back.
fn in_order<T: Real>(
    layers: &[LayerView<'_, T>],
    sides: &[Vec<Side>],
    camera: &Camera,
    settings: &Settings,
) -> Vec<project::Splat<T>> {
    let mut splats = Vec::new();
    for ((layer_number, layer), sides) in (0..).zip(layers).zip(sides) {
        let LayerView {
            gaussians: scene,
            view,
            clip,
            numbers,
            ..
        } = layer;
        // Find their footprints and colours, and how the cut ones vary over their pixels.
        splats.extend(compact::compact(sides).into_iter().filter_map(|number| {
            let index = number as usize;
            let mut splat = project::project(scene, index, view, settings)?;
            splat.cut = cutoff::cutoff(scene, index, &splat.footprint, view, clip, settings);
            splat.index = numbers.of(number);
            splat.layer = layer_number;
            Some(splat)
        }));
    }
    let visible = layers
        .iter()
        .filter(|layer| layer.visible && !layer.gaussians.is_empty());
    let order = settings.order_of(camera, visible.map(|layer| layer.gaussians.training()));
    sort::sort(&mut splats, order);
    splats
}

pub fn counts(sides: &[Side]) -> Counts {
    let mut counts = Counts::default();
    for side in sides {
        *match side {
            Side::Culled => &mut counts.culled,
            Side::Visible => &mut counts.visible,
            Side::Cutoff => &mut counts.cutoff,
            Side::Invisible => &mut counts.invisible,
        } += 1;
    }
    counts.drawn = counts.visible + counts.cutoff;
    counts
}

#[cfg(test)]
mod tests;
