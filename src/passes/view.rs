//! A view in a frame's constants: the picture of an eye, and where each layer has the eye.

use glam::DVec3;

use crate::types::{self, LayerView, ViewData};
use rara_base::limits;
use rara_scene::camera::{Camera, Projection};

/// The picture of a camera, which is a part of that of `whole`, and the degree up to which colours are evaluated. No centre is
/// deeper than `farthest`, the scene's units.
pub(super) fn view_data(
    camera: &Camera,
    whole: &Camera,
    farthest: f64,
    sh_degree: u32,
) -> ViewData {
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let margin = f64::from(limits::CLAMP_MARGIN);
    let bounds = |size: f64, centre: f64, focal: f64| match camera.projection {
        Projection::Perspective => (
            (-margin * size - centre) / focal,
            ((1.0 + margin) * size - centre) / focal,
        ),
        // The Jacobian is the same everywhere, so that there is nothing to clamp.
        Projection::Orthographic => (f64::from(f32::MIN), f64::from(f32::MAX)),
    };
    // A splat has the same shape in each part of a picture.
    let (x_low, x_high) = bounds(f64::from(whole.width), whole.cx, whole.fx);
    let (y_low, y_high) = bounds(f64::from(whole.height), whole.cy, whole.fy);
    let longest_focal = match camera.projection {
        Projection::Perspective => camera.fx.max(camera.fy),
        // Of the perspective camera that shows what is deepest at this scale.
        Projection::Orthographic => camera.fx.max(camera.fy) * farthest,
    };
    ViewData {
        focal: [camera.fx, camera.fy, camera.cx, camera.cy].map(|x| x as f32),
        slope_bounds: [x_low, x_high, y_low, y_high].map(|x| x as f32),
        size: [width, height, 1.0 / width, 1.0 / height].map(|x| x as f32),
        precise_view: (longest_focal > f64::from(limits::PRECISE_FOCAL)).into(),
        sh_degree,
        projection: match camera.projection {
            Projection::Perspective => types::PROJECTION_PERSPECTIVE,
            Projection::Orthographic => types::PROJECTION_ORTHOGRAPHIC,
        },
        near_cut: camera.nearest(1.0) as f32,
    }
}

/// The view of a layer from the camera, which is given in the layer's space. `unit` is the scene's units in one of the
/// layer's.
pub(super) fn layer_view(camera: &Camera, unit: f64) -> LayerView {
    let rows = camera.rotation.transpose();
    let row = |v: DVec3| {
        let ([x, y, z], [low_x, low_y, low_z]) = two_float(v);
        ([x, y, z, 0.0], [low_x, low_y, low_z, 0.0])
    };
    let (rotation_x, low_x) = row(unit * rows.x_axis);
    let (rotation_y, low_y) = row(unit * rows.y_axis);
    let (rotation_z, low_z) = row(unit * rows.z_axis);
    let (eye_high, eye_low) = row(camera.eye);
    LayerView {
        rotation_x,
        rotation_y,
        rotation_z,
        rotation_low: [low_x, low_y, low_z],
        eye_high,
        eye_low,
        unit: unit as f32,
        pad: [0; 3],
    }
}

/// A vector as the sum of two single-precision ones.
pub(super) fn two_float(v: DVec3) -> ([f32; 3], [f32; 3]) {
    let high = v.as_vec3();
    (high.into(), (v - high.as_dvec3()).as_vec3().into())
}
