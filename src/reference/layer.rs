//! The layers of a scene as the stages see them: each by itself, with the camera and the clip in its own space.

use std::borrow::Cow;

use super::real::Real;
use super::view::ViewTransform;
use rara_scene::Numbers;
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::{Gaussians, Layer, Scene};

/// A layer with what a frame asks of it.
#[derive(Debug, Clone)]
pub struct LayerView<'a, T> {
    /// Its Gaussians, as opaque as the layer leaves them.
    pub gaussians: Cow<'a, Gaussians>,
    /// Its view, from the camera in its own space.
    pub view: ViewTransform<T>,
    /// Its clip, in its own space.
    pub clip: Clip,
    /// The numbers of its Gaussians in the scene.
    pub numbers: Numbers<'a>,
    pub visible: bool,
}

pub fn layers<'a, T: Real>(
    scene: &'a Scene<'a>,
    camera: &Camera,
    clip: &Clip,
) -> Vec<LayerView<'a, T>> {
    // The renderer refuses a camera with planes that mean nothing.
    let seen_of = |clip| camera.sees_of(clip).unwrap_or(Cow::Borrowed(clip));
    let seen = scene.layers().iter().zip(scene.numbers());
    let seen = seen.map(|(layer, numbers)| {
        let state = layer.state();
        LayerView {
            gaussians: faded(layer),
            view: ViewTransform::in_layer(camera, &layer.placement()),
            clip: seen_of(layer.clip().unwrap_or(clip)).in_scene(&layer.placement()),
            numbers,
            visible: state.visible,
        }
    });
    seen.collect()
}

fn faded<'a>(layer: &'a Layer<'a>) -> Cow<'a, Gaussians> {
    let mut gaussians = Cow::Borrowed(layer.gaussians());
    let opacity = layer.state().opacity;
    if opacity != 1.0 {
        for value in gaussians.to_mut().opacities_mut() {
            *value *= opacity;
        }
    }
    gaussians
}
