//! Stage `project`: a Gaussian's footprint, colour and place in depth.

use super::cutoff::SplatCut;
use super::footprint::Footprint;
use super::harmonics;
use super::real::Real;
use super::view::ViewTransform;
use rara_scene::Gaussians;
use rara_scene::settings::Settings;

/// A splat, ready to be drawn.
#[derive(Debug, Clone)]
pub struct Splat<T> {
    /// Its number in the scene, where the layers' Gaussians stand one after the other.
    pub index: u32,
    pub layer: u32,
    pub footprint: Footprint<T>,
    /// Red, green and blue, not negative.
    pub colour: [T; 3],
    /// The most that it covers of a pixel.
    pub alpha_max: T,
    /// How it is cut, if it is.
    pub cut: Option<SplatCut<T>>,
}

/// Projects one Gaussian; nothing if it is culled. The splat is whole: stage `cutoff` says how it is cut.
pub fn project<T: Real>(
    scene: &Gaussians,
    index: usize,
    view: &ViewTransform<T>,
    settings: &Settings,
) -> Option<Splat<T>> {
    let footprint = Footprint::new(scene, index, view)?;
    let degree = settings
        .sh_degree
        .unwrap_or(scene.sh_degree())
        .min(scene.sh_degree());
    Some(Splat {
        index: u32::try_from(index).expect("scenes have fewer than 2^32 Gaussians"),
        layer: 0,
        colour: harmonics::colour(
            scene.sh_of(index),
            degree,
            view.direction(footprint.relative),
        ),
        footprint,
        alpha_max: T::of(f64::from(scene.training().alpha_max)),
        cut: None,
    })
}
