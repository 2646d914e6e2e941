//! The view in a frame's constants: the camera's picture, and where each layer has the camera.

use glam::DVec3;

use crate::camera::Camera;
use crate::limits;
use crate::types::{LayerView, ViewData};

/// The picture of a camera, and the degree up to which colours are evaluated.
pub(super) fn view_data(camera: &Camera, sh_degree: u32) -> ViewData {
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let margin = f64::from(limits::CLAMP_MARGIN);
    let bounds = |size: f64, centre: f64, focal: f64| {
        (
            (-margin * size - centre) / focal,
            ((1.0 + margin) * size - centre) / focal,
        )
    };
    let (x_low, x_high) = bounds(width, camera.cx, camera.fx);
    let (y_low, y_high) = bounds(height, camera.cy, camera.fy);
    ViewData {
        focal: [camera.fx, camera.fy, camera.cx, camera.cy].map(|x| x as f32),
        slope_bounds: [x_low, x_high, y_low, y_high].map(|x| x as f32),
        size: [width, height, 1.0 / width, 1.0 / height].map(|x| x as f32),
        precise_view: (camera.fx.max(camera.fy) > f64::from(limits::PRECISE_FOCAL)).into(),
        sh_degree,
        pad: [0; 2],
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
