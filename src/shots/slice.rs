//! Slices: what lies on a plane.

use rara::scene::cross_section;
use rara::{Gaussians, Layer, Plane, Scene};

/// The cross-sections of a scene's Gaussians by a plane, which are flat Gaussians on the plane. Draw them by tiles with
/// [`Show::Mean`](rara::Show::Mean): a pixel then has the mean of their colours, each weighted by its opacity there.
#[derive(Debug)]
pub struct Slice<'s> {
    scene: Scene<'s>,
    flat: Vec<Gaussians>,
}

impl<'s> Slice<'s> {
    /// Makes the cross-sections of all layers of a scene, including hidden ones.
    pub fn new(scene: &Scene<'s>, plane: &Plane) -> Self {
        let layers = scene.layers().iter();
        let section = |layer: &Layer<'_>| {
            cross_section(layer.gaussians(), &plane.in_scene(&layer.placement()))
        };
        Self {
            flat: layers.map(section).collect(),
            scene: scene.clone(),
        }
    }

    /// Returns the scene of the cross-sections. Its layers have the names, states and clips of the original layers.
    pub fn scene(&self) -> Scene<'_> {
        let layers = self.scene.layers().iter().zip(&self.flat);
        let layers = layers.map(|(layer, flat)| {
            let made = Layer::new(layer.name(), flat).with(layer.state());
            match layer.clip() {
                Some(clip) => made.clipped(clip.clone()),
                None => made,
            }
        });
        layers.collect()
    }
}
