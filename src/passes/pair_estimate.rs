//! How many pairs of tile and splat a camera's picture will have, about, before a frame has shown it: the sum over a sample
//! of the scene's Gaussians, which the host keeps.

use std::f64::consts::PI;

use glam::{DMat3, DVec3, Mat3, Vec3};

use crate::passes::scene_layer::SceneLayer;
use rara_base::limits;
use rara_scene::camera::{Camera, Projection};
use rara_scene::{Gaussians, Scene};

/// Gaussians in the sample, about. Half of them are the largest of their layers, which stand for themselves alone: a few large
/// ones may make most of the pairs. The rest are every n-th of the others.
const SAMPLES: usize = 2048;

/// A sample of a scene's Gaussians, by layers.
#[derive(Debug, Clone)]
pub(super) struct PairSample {
    layers: Vec<LayerSample>,
}

#[derive(Debug, Clone)]
struct LayerSample {
    largest: Vec<SampleGaussian>,
    /// How many Gaussians each of the rest stands for.
    weight: f64,
    rest: Vec<SampleGaussian>,
}

/// A Gaussian of the sample, in its layer's space.
#[derive(Debug, Clone, Copy)]
struct SampleGaussian {
    centre: Vec3,
    /// Half axes one standard deviation long.
    axes: [Vec3; 3],
    opacity: f32,
}

impl PairSample {
    /// The sample of a scene.
    pub(super) fn new(scene: &Scene<'_>) -> Self {
        let step = step(scene.gaussians());
        let layers = scene.layers().iter();
        Self {
            layers: layers
                .map(|layer| LayerSample::new(layer.gaussians(), step))
                .collect(),
        }
    }

    /// The sample of a scene of so many Gaussians with others in a layer.
    pub(super) fn with(&self, index: usize, gaussians: &Gaussians, count: usize) -> Self {
        let mut sample = self.clone();
        sample.layers[index] = LayerSample::new(gaussians, step(count));
        sample
    }

    /// The pairs of a picture of these layers, which are the sample's, without what a clip leaves out. The picture is a part of
    /// that of `whole`.
    pub(super) fn pairs(&self, layers: &[SceneLayer], camera: &Camera, whole: &Camera) -> u32 {
        let seen = self.layers.iter().zip(layers);
        let pairs = seen
            .filter(|(_, layer)| layer.is_visible())
            .map(|(own, layer)| {
                let eye = Eye::new(camera, whole, layer);
                let tiles =
                    |of: &[SampleGaussian]| of.iter().map(|one| eye.tiles(one)).sum::<f64>();
                tiles(&own.largest) + own.weight * tiles(&own.rest)
            });
        pairs.sum::<f64>().ceil() as u32 // what is too much for 32 bits becomes the most that they hold
    }
}

/// Of how many Gaussians of a scene one is taken.
fn step(count: usize) -> usize {
    count.div_ceil(SAMPLES / 2).max(1)
}

impl LayerSample {
    /// At most as many of the largest as of the rest, of which each `step`th is taken.
    fn new(gaussians: &Gaussians, step: usize) -> Self {
        let scales = gaussians.scales().iter();
        let sizes: Vec<f32> = scales.map(|scale| scale.max_element()).collect();
        let mut by_size = sizes.clone();
        let few = sizes.len().div_ceil(step);
        // Those of equal size are all among the rest, so that which of them are taken does not depend on a sort.
        let most_of_rest = match few < sizes.len() {
            true => *by_size.select_nth_unstable_by(few, |a, b| b.total_cmp(a)).1,
            false => f32::NEG_INFINITY,
        };
        let is_large = |index: &usize| sizes[*index] > most_of_rest;
        let sampled = |index: usize| SampleGaussian::new(gaussians, index);
        let others = (0..sizes.len()).filter(|index| !is_large(index));
        let rest: Vec<_> = others.clone().step_by(step).map(sampled).collect();
        Self {
            largest: (0..sizes.len()).filter(is_large).map(sampled).collect(),
            weight: others.count() as f64 / rest.len().max(1) as f64,
            rest,
        }
    }
}

impl SampleGaussian {
    fn new(gaussians: &Gaussians, index: usize) -> Self {
        let turn = Mat3::from_quat(gaussians.rotations()[index]);
        let scale = gaussians.scales()[index];
        Self {
            centre: gaussians.positions()[index],
            axes: [
                turn.x_axis * scale.x,
                turn.y_axis * scale.y,
                turn.z_axis * scale.z,
            ],
            opacity: gaussians.opacities()[index],
        }
    }
}

/// A camera as a layer sees it.
struct Eye<'a> {
    camera: &'a Camera,
    /// The camera of whose picture it shows a part.
    whole: &'a Camera,
    position: DVec3,
    /// From the layer's axes and units to the camera's axes and the scene's units.
    turn: DMat3,
    opacity: f64,
    /// Square pixels.
    low_pass: f64,
}

impl<'a> Eye<'a> {
    fn new(camera: &'a Camera, whole: &'a Camera, layer: &SceneLayer) -> Self {
        let placement = &layer.placement();
        let own = camera.in_scene(placement);
        Self {
            camera,
            whole,
            position: own.eye,
            turn: own.rotation * placement.scale(),
            opacity: layer.state.opacity.into(),
            low_pass: layer.training.low_pass.into(),
        }
    }

    /// The tiles that a Gaussian touches, on average over where the tiles' edges lie: the footprint of stage `project`.
    fn tiles(&self, gaussian: &SampleGaussian) -> f64 {
        let camera = self.camera;
        let centre = self.turn * (gaussian.centre.as_dvec3() - self.position);
        let opacity = f64::from(gaussian.opacity) * self.opacity;
        let brightness = opacity * f64::from(limits::ALPHA_MIN_INVERSE);
        // A depth that is none is not in view either.
        if !(centre.z >= camera.nearest(1.0) && brightness > 1.0) {
            return 0.0;
        }
        let axes = gaussian.axes.map(|axis| self.turn * axis.as_dvec3());
        let size = [f64::from(camera.width), f64::from(camera.height)];
        let focal = [camera.fx, camera.fy];
        let principal = [camera.cx, camera.cy];
        let whole_size = [self.whole.width, self.whole.height].map(f64::from);
        let whole_principal = [self.whole.cx, self.whole.cy];
        let (w, leans) = match camera.projection {
            Projection::Perspective => (centre.z, 1.0),
            Projection::Orthographic => (1.0, 0.0),
        };
        let slope = [centre.x / w, centre.y / w];
        let margin = f64::from(limits::CLAMP_MARGIN);
        // By how many pixels each half axis moves the image along x and along y.
        let moved = [0, 1].map(|at| {
            let low = (-margin * whole_size[at] - whole_principal[at]) / focal[at];
            let high = ((1.0 + margin) * whole_size[at] - whole_principal[at]) / focal[at];
            let clamped = slope[at].max(low).min(high);
            let by = |axis: DVec3| focal[at] / w * (axis[at] - leans * clamped * axis.z);
            DVec3::from(axes.map(by))
        });
        let [xx, yy] = moved.map(|moved| moved.length_squared() + self.low_pass);
        let xy = moved[0].dot(moved[1]);
        // Out to so many deviations, squared, the splat counts.
        let extent = 2.0 * brightness.ln();
        let half = [(extent * xx).sqrt(), (extent * yy).sqrt()];
        let area = PI * extent * (xx * yy - xy * xy).max(0.0).sqrt();
        let at = [0, 1].map(|at| focal[at] * slope[at] + principal[at]);
        touched(at, half, area, size)
    }
}

/// The tiles that an ellipse touches in a picture. A convex shape touches as many cells of a grid, on average, as the shape
/// widened by a cell has room for: its area, its sides and one. What is outside the picture is left out by its share of the
/// ellipse's box.
fn touched(at: [f64; 2], half: [f64; 2], area: f64, size: [f64; 2]) -> f64 {
    let tile = [limits::TILE_WIDTH, limits::TILE_HEIGHT].map(f64::from);
    // Numbers that are none stand for what covers the picture.
    let spans = [0, 1].map(|i| [(at[i] - half[i]).max(0.0), (at[i] + half[i]).min(size[i])]);
    let sides = spans.map(|[low, high]| high - low);
    if sides.iter().any(|side| *side <= 0.0) {
        return 0.0;
    }
    let cells = |i: usize| (spans[i][1] / tile[i]).ceil() - (spans[i][0] / tile[i]).floor();
    let most = cells(0) * cells(1);
    let share = sides[0] / (2.0 * half[0]) * (sides[1] / (2.0 * half[1]));
    let widened = 1.0 + sides[0] / tile[0] + sides[1] / tile[1];
    (widened + share * area / (tile[0] * tile[1])).min(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_touched_is_bounded_by_the_picture() {
        let size = [80.0, 40.0];
        let one = touched([20.0, 20.0], [0.5, 0.5], 0.7, size);
        assert!((1.0..1.5).contains(&one), "{one}");
        assert_eq!(touched([-5.0, 20.0], [4.0, 4.0], 50.0, size), 0.0);
        // A disc of ten tiles across has as many tiles as its area, and some for its edge.
        let disc = touched([200.0, 200.0], [40.0, 40.0], PI * 1600.0, [400.0, 400.0]);
        assert!((95.0..105.0).contains(&disc), "{disc}");
        for huge in [1e30, f64::INFINITY, f64::NAN] {
            let area = PI * huge * huge;
            assert_eq!(touched([20.0, 20.0], [huge; 2], area, size), 50.0);
            assert_eq!(touched([huge; 2], [huge; 2], area, size), 50.0, "{huge}");
        }
    }
}
