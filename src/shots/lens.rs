//! The lens of a camera that no file gives, and the depths at which a camera cuts.

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Error, Result};

/// The default up direction of the world: -y, as in COLMAP.
pub const UP: DVec3 = DVec3::NEG_Y;

/// The projection of a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// The vertical field of view, degrees.
    Perspective(f64),
    /// The height of the picture, world units; `None` for the height that holds the scene.
    Orthographic(Option<f64>),
}

impl Lens {
    /// Returns a camera at `eye` that looks at `target`. If it looks along `up`, [`upright`] chooses another up direction.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is no such camera, or if an orthographic lens has no height.
    pub fn look(
        self,
        (eye, target): (DVec3, DVec3),
        up: DVec3,
        size: (u32, u32),
    ) -> Result<Camera> {
        let up = upright(target - eye, up);
        match self {
            Self::Perspective(fov_y) => Camera::look_at(eye, target, up, fov_y, size),
            Self::Orthographic(Some(height)) => Camera::orthographic(eye, target, up, height, size),
            Self::Orthographic(None) => Err(Error::Invalid(
                "an orthographic camera whose eye is given needs the height of its picture".into(),
            )),
        }
    }

    /// A camera that holds the bounds, seen from their front, the right and above.
    pub(crate) fn frame(self, bounds: &Bounds, up: DVec3, size: (u32, u32)) -> Result<Camera> {
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

/// Returns the up direction of a camera that looks along `forward`. It is `up`, unless `forward` is parallel to `up`: then it
/// is z, or -y if `forward` is parallel to z.
pub fn upright(forward: DVec3, up: DVec3) -> DVec3 {
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

/// The depths at which a camera cuts, world units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Depths {
    /// The value of [`Camera::clip_near`].
    pub near: Option<f64>,
    /// The value of [`Camera::clip_far`].
    pub far: Option<f64>,
    /// The value of [`Camera::near_cut`].
    pub cut: Option<f64>,
}

impl Depths {
    /// Returns the camera with near and far planes and a near cut at these depths. It keeps its own where a depth is `None`.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the camera cannot cut there.
    pub fn camera(self, camera: Camera) -> Result<Camera> {
        let camera = camera
            .clip_near(self.near.or(camera.clip_near))
            .clip_far(self.far.or(camera.clip_far))
            .near_cut(self.cut.or(camera.near_cut));
        camera.check_near_cut()?;
        camera.clip_planes()?;
        Ok(camera)
    }
}
