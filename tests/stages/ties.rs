//! Ties: single precision may find another class than the twin at a threshold, and nowhere else.

use glam::{DQuat, DVec3, Vec3};
use rara::{Camera, Clip, Gaussians, Placement, Settings};
use rara_reference::{Side, ViewTransform, classify, clip};

use crate::common;

/// By how much a Gaussian may seem to be another one, as a share: eight units in the last place. Opacities go through a
/// logarithm, for which Vulkan promises 2^-21 near 1.
const SLACK: f64 = 1.0 / (1 << 20) as f64;

/// The classes that the twin in double precision finds for a Gaussian that is off by so much in opacity, in size, and in
/// its place relative to the eye or to the planes.
pub fn classes(
    scene: &Gaussians,
    index: usize,
    camera: Option<&Camera>,
    planes: &Clip,
    settings: &Settings,
) -> Vec<Side> {
    let one = common::picked(scene, [index]);
    let at = one.positions()[0].as_dvec3();
    let distance = camera.map_or(at.length(), |camera| (at - camera.eye).length());
    let ways = [DVec3::X, DVec3::Y, DVec3::Z];
    let turned = ways.map(|way| camera.map_or(way, |camera| camera.rotation.transpose() * way));
    let mut shifts = vec![DVec3::ZERO];
    for way in turned.iter().flat_map(|&way| [way, -way]) {
        shifts.push(SLACK * distance * way);
    }
    let mut found = Vec::new();
    for opacity in [1.0 - SLACK, 1.0, 1.0 + SLACK] {
        for size in [1.0 - SLACK, 1.0, 1.0 + SLACK] {
            for &shift in &shifts {
                let mut near = one.clone();
                near.opacities_mut()[0] = (f64::from(one.opacities()[0]) * opacity) as f32;
                near.scales_mut()[0] = (one.scales()[0].as_dvec3() * size).as_vec3();
                // The Gaussian's place is rounded, so everything else moves instead.
                let place = Placement::new(shift, DQuat::IDENTITY, 1.0);
                let planes = planes.in_scene(&place.expect("a finite shift"));
                let sides = match camera {
                    Some(camera) => {
                        let eye = camera.eye - shift;
                        let view = ViewTransform::<f64>::new(&camera.eye(eye));
                        classify::classify(&near, &view, &planes, settings)
                    }
                    None => clip::clip::<f64>(&near, &planes, settings),
                };
                if !found.contains(&sides[0]) {
                    found.push(sides[0]);
                }
            }
        }
    }
    found
}

/// How far apart two numbers are, in units in the last place of the larger of `size` and them.
pub fn ulps(a: f32, b: f32, size: f32) -> f32 {
    let largest = a.abs().max(b.abs()).max(size).max(f32::MIN_POSITIVE);
    (a - b).abs() / (largest * f32::EPSILON)
}

/// The largest of some numbers' distances from 0.
pub fn largest(v: Vec3) -> f32 {
    v.abs().max_element()
}
