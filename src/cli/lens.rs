//! The lens of a camera that no file gives, and the depths at which a camera cuts.

use glam::DVec3;
use rara::Camera;
use rara::scene::Bounds;

use super::failure::Failure;
use super::output;

/// The direction that is up in the world where nothing else is said.
pub(super) const UP: DVec3 = DVec3::NEG_Y;

/// The scale of an orthographic picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ortho {
    /// World units that it is high.
    Height(f64),
    /// So high that it holds the scene.
    Fit,
}

pub(super) fn ortho(text: &str) -> Result<Ortho, String> {
    match text.parse::<f64>() {
        _ if text == "fit" => Ok(Ortho::Fit),
        Ok(height) if height > 0.0 && height.is_finite() => Ok(Ortho::Height(height)),
        _ => Err("expected the picture's height in world units, above zero, or `fit`".into()),
    }
}

/// The projection of a camera that frames the scene.
#[derive(Debug, Clone, Copy)]
pub(super) enum Lens {
    /// Degrees of its vertical field of view.
    Perspective(f64),
    /// World units that its picture is high; `None` for as many as hold the scene.
    Orthographic(Option<f64>),
}

impl Lens {
    /// A camera at the first point that looks at the second.
    pub(super) fn look(
        self,
        (eye, target): (DVec3, DVec3),
        up: DVec3,
        size: (u32, u32),
    ) -> Result<Camera, Failure> {
        let turned = upright(target - eye, up);
        if turned != up {
            output::warn_once(format!(
                "note: the camera looks along what is up; up in the picture is {}",
                if turned == DVec3::Z { "z" } else { "-y" }
            ));
        }
        let camera = match self {
            Self::Perspective(fov_y) => Camera::look_at(eye, target, turned, fov_y, size),
            Self::Orthographic(Some(height)) => {
                Camera::orthographic(eye, target, turned, height, size)
            }
            Self::Orthographic(None) => {
                return Err(Failure::Usage(
                    "--ortho fit places the camera itself: give a height with --eye".into(),
                ));
            }
        };
        camera.map_err(Failure::usage)
    }

    /// A camera that holds the bounds, seen from their front, the right and above.
    pub(super) fn frame(
        self,
        bounds: &Bounds,
        up: DVec3,
        size: (u32, u32),
    ) -> rara::Result<Camera> {
        match self {
            Self::Perspective(fov_y) => Camera::frame(bounds, up, fov_y, size),
            Self::Orthographic(height) => {
                let camera = Camera::frame_orthographic(bounds, up, size)?;
                Ok(height.map_or(camera, |height| {
                    let scale = f64::from(size.1) / height;
                    camera.fx(scale).fy(scale)
                }))
            }
        }
    }
}

/// The direction that is up in the picture of a camera that looks this way: `up`, unless it looks along that. Then it is z, or
/// -y where it looks along z, as in sections.
pub(super) fn upright(forward: DVec3, up: DVec3) -> DVec3 {
    let is_along = |axis: DVec3| {
        let across = forward.normalize_or_zero().cross(axis);
        across.length() <= 1e-12 * axis.length()
    };
    match (is_along(up), is_along(DVec3::Z)) {
        (false, _) => up,
        (true, false) => DVec3::Z,
        (true, true) => DVec3::NEG_Y,
    }
}

/// The depths that `--clip-near`, `--clip-far` and `--near-cut` mean.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Depths {
    pub(super) near: Option<f64>,
    pub(super) far: Option<f64>,
    pub(super) cut: Option<f64>,
}

impl Depths {
    /// The camera with planes, and a near cut, at these depths, and at its own where none are given.
    pub(super) fn camera(self, camera: Camera) -> Result<Camera, Failure> {
        let camera = camera
            .clip_near(self.near.or(camera.clip_near))
            .clip_far(self.far.or(camera.clip_far))
            .near_cut(self.cut.or(camera.near_cut));
        camera.check_near_cut().map_err(Failure::usage)?;
        camera.clip_planes().map_err(Failure::usage)?;
        Ok(camera)
    }
}
