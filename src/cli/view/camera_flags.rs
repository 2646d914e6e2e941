//! The flags of `rara render` that place a camera, and those of the planes that move with it.

use rara::{Camera, Projection};

/// Share of a number by which cameras that flags place may differ from each other by rounding.
const ROUNDING: f64 = 1e-9;

/// The flags that place this camera; `None` for one whose pixels are not square or whose principal point is not the picture's
/// middle, which only a file can say.
pub(super) fn flags(camera: &Camera) -> Option<String> {
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let is_near = |a: f64, b: f64| (a - b).abs() <= ROUNDING * b.abs();
    let is_plain = is_near(camera.fx, camera.fy)
        && is_near(camera.cx, width / 2.0)
        && is_near(camera.cy, height / 2.0);
    if !is_plain {
        return None;
    }
    let (eye, forward) = (camera.eye, camera.rotation.row(2));
    // The target is about as far away as the eye is from the origin, so that neither is lost in the other's rounding.
    let target = eye + forward * eye.length().max(1.0);
    let up = -camera.rotation.row(1);
    let list = |v: glam::DVec3| format!("{},{},{}", v.x, v.y, v.z);
    let lens = match camera.projection {
        Projection::Orthographic => format!("--ortho {}", height / camera.fy),
        _ => {
            let half = (height / 2.0 / camera.fy).atan();
            format!("--fov-y {}", 2.0 * half.to_degrees())
        }
    };
    Some(format!(
        "--eye {} --target {} --up {} {lens} --size {}x{}",
        list(eye),
        list(target),
        list(up),
        camera.width,
        camera.height
    ))
}

/// The flags of the planes and the near cut that move with this camera, of which no file says anything.
pub(super) fn planes(camera: &Camera) -> Vec<String> {
    let planes = [
        ("--clip-near", camera.clip_near),
        ("--clip-far", camera.clip_far),
        ("--near-cut", camera.near_cut),
    ];
    let flag = |(flag, depth): (&str, Option<f64>)| depth.map(|depth| format!("{flag} {depth}"));
    planes.into_iter().filter_map(flag).collect()
}

#[cfg(test)]
mod tests;
