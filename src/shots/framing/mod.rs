//! The camera of a scene that came without one: as near as shows all of it that is visible.

mod linked;
mod outside;
mod reach;
mod visible;

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Result};
use rara_base::setters;

use super::lens::{Depths, Lens, UP};
use super::orbit::Orbit;
pub use outside::Outside;
pub use visible::Visible;

setters! {
    /// The framing of a scene: the lens and the position of the camera. Without an eye and a target, the camera is in front of
    /// the scene, to the right and above, as near as possible with everything visible in the picture.
    #[derive(Debug, Clone, Copy)]
    #[non_exhaustive]
    pub struct Framing {
        /// The projection.
        pub lens: Lens,
        /// The picture's width and height, pixels.
        pub size: (u32, u32),
        /// The direction that is up in the picture. Default: [`UP`].
        pub up: DVec3,
        /// The depths at which the camera cuts. Default: none.
        pub depths: Depths,
        /// The position of the camera, which looks at the middle of the visible part. Default: none.
        pub eye: Option<DVec3>,
        /// The point that the camera looks at, in place of the middle of the visible part, from the same side and distance.
        /// Default: none.
        pub target: Option<DVec3>,
    }
}

impl Framing {
    /// Makes a framing of everything that is visible.
    pub fn new(lens: Lens, size: (u32, u32)) -> Self {
        Self {
            lens,
            size,
            up: UP,
            depths: Depths::default(),
            eye: None,
            target: None,
        }
    }

    /// Checks everything that does not depend on the scene.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara::Error::Invalid) if no scene has such a camera.
    pub fn check(&self) -> Result<()> {
        let eye = self.eye.unwrap_or_default();
        let aside = self.up.normalize_or(UP).any_orthonormal_vector();
        let camera = self.turned(eye + aside * (1.0 + eye.length()))?;
        self.depths.camera(camera).map(drop)
    }

    /// Returns true if the picture shows everything visible: no eye, no target and no height of an orthographic picture is
    /// given.
    pub fn holds_all(&self) -> bool {
        self.eye.or(self.target).is_none() && !matches!(self.lens, Lens::Orthographic(Some(_)))
    }

    /// Returns the camera that shows everything visible, or looks at it from the eye.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara::Error::Invalid) if there is no such camera, for example with the eye in the middle of what is
    /// visible.
    pub fn camera(&self, visible: &Visible) -> Result<Camera> {
        let camera = self.turned(visible.middle())?;
        let placed = match self.lens {
            _ if self.eye.is_some() => camera,
            Lens::Perspective(_) => self.aimed(visible.near(camera), visible.middle()),
            Lens::Orthographic(height) => {
                let middle = visible.middle_across(camera.rotation);
                let camera = match height {
                    Some(_) => camera,
                    None => scaled(camera, visible.scale(&camera, middle)),
                };
                let point = self.target.unwrap_or(middle);
                camera.eye(visible.before(camera.rotation, point))
            }
        };
        self.depths.camera(placed)
    }

    /// Returns the camera that shows a whole box, whatever is visible in it.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara::Error::Invalid) if there is no such camera.
    pub fn boxed(&self, bounds: &Bounds) -> Result<Camera> {
        let camera = match self.eye {
            Some(_) => self.turned(bounds.centre())?,
            None => self.lens.frame(bounds, self.up, self.size)?,
        };
        self.depths.camera(self.aimed(camera, bounds.centre()))
    }

    /// Returns the cameras of an orbit around the middle of the visible part, or around the target. They are as near as
    /// possible with everything in every picture, or start at the eye if it is given.
    ///
    /// # Errors
    /// The errors of [`camera`](Self::camera).
    pub fn orbit(&self, orbit: Orbit, visible: &Visible) -> Result<Vec<Camera>> {
        let pivot = self.target.unwrap_or(visible.middle());
        let camera = self.depths.camera(self.turned(pivot)?)?;
        let places = orbit.cameras(camera, (pivot, self.up));
        let step = places.len().div_ceil(PLACES).max(1);
        let looked_at = || places.iter().step_by(step);
        let forward = camera.rotation.row(2);
        let camera = match self.lens {
            _ if self.eye.is_some() => return Ok(places),
            Lens::Perspective(_) => {
                let distances = looked_at().map(|camera| visible.distance(camera, pivot));
                camera.eye(pivot - forward * distances.fold(0.0, f64::max))
            }
            Lens::Orthographic(height) => {
                let scales = looked_at().map(|camera| visible.scale(camera, pivot));
                let camera = match height {
                    Some(_) => camera,
                    None => scaled(camera, scales.fold(f64::INFINITY, f64::min)),
                };
                // As far away as from the side on which the pivot is farthest behind all that is visible.
                let aside = pivot.distance(visible.middle());
                camera.eye(visible.before(camera.rotation, pivot) - forward * aside)
            }
        };
        Ok(orbit.cameras(camera, (pivot, self.up)))
    }

    /// The camera with its lens and its axes: it looks at the middle of what is framed from the eye, if that is given, and
    /// otherwise from the front, the right and above, with its eye anywhere.
    fn turned(&self, middle: DVec3) -> Result<Camera> {
        let unit = Bounds {
            min: DVec3::NEG_ONE,
            max: DVec3::ONE,
        };
        match self.eye {
            Some(eye) => self.lens.look((eye, middle), self.up, self.size),
            None => self.lens.frame(&unit, self.up, self.size),
        }
    }

    /// The camera that looks at the middle from where it stands, moved so that it looks at the target likewise.
    fn aimed(&self, camera: Camera, middle: DVec3) -> Camera {
        let forward = camera.rotation.row(2);
        match self.target {
            Some(target) => camera.eye(target - forward * forward.dot(middle - camera.eye)),
            None => camera,
        }
    }
}

/// The most places of an orbit that are looked at.
const PLACES: usize = 64;

fn scaled(camera: Camera, scale: f64) -> Camera {
    camera.fx(scale).fy(scale)
}

#[cfg(test)]
mod tests;
