//! A camera for a scene that came without one.

use glam::DVec3;

use crate::Bounds;
use crate::camera::Camera;
use crate::clip::Plane;
use rara_base::error::{Error, Result};

/// Three-quarter view: degrees round the scene from its front, and above its horizon.
const AZIMUTH: f64 = 35.0;
const ELEVATION: f64 = 18.0;
/// Share of the picture's half that the bounds may fill; the rest is a margin for what the percentiles left out.
const FILL: f64 = 0.9;
/// The nearest corner stays beyond this depth. Splats nearer than 0.2 are culled, so that a scene of a few
/// centimetres would vanish if the camera moved as close as would fill the picture.
const NEAREST: f64 = 0.25;

impl Camera {
    /// Makes a camera that looks at the middle of `bounds` from the front (the side of -z), the right and above, near enough to
    /// fill the picture. `up` is the world's up direction (`-Y` by convention), `fov_y` the full vertical field of view in
    /// degrees.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a zero `up`, an impossible field of view or picture size.
    pub fn frame(bounds: &Bounds, up: DVec3, fov_y: f64, size: (u32, u32)) -> Result<Self> {
        let towards_eye = three_quarter(up)?;
        let centre = bounds.centre();
        // The camera is turned first, and moved into place once the distance is known.
        let camera = Self::look_at(towards_eye, DVec3::ZERO, up, fov_y, size)?;
        let (tan_x, tan_y) = (camera.cx / camera.fx * FILL, camera.cy / camera.fy * FILL);
        let distance = bounds.corners().iter().fold(0.0_f64, |distance, corner| {
            let p = camera.rotation * (*corner - centre);
            let fits = (p.x.abs() / tan_x).max(p.y.abs() / tan_y);
            distance.max(fits.max(NEAREST) - p.z)
        });
        Ok(Self {
            eye: centre + towards_eye * distance,
            ..camera
        })
    }

    /// Makes an orthographic camera that looks at the middle of `bounds` from the same side as [`frame`](Self::frame), at the
    /// largest scale at which all of `bounds` is in the picture.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a zero `up` and an impossible picture size.
    pub fn frame_orthographic(bounds: &Bounds, up: DVec3, size: (u32, u32)) -> Result<Self> {
        let target = bounds.centre();
        let eye = target + three_quarter(up)? * standoff(bounds);
        Self::orthographic(eye, target, up, 1.0, size)?.fitted(bounds)
    }

    /// Makes an orthographic camera that looks at a plane along its normal, from the side that the plane cuts away, so that a
    /// clip by the plane shows the cut. The middle of `bounds` is in the middle of the picture, and all of `bounds` is in the
    /// picture. Parallel planes have pictures of the same scale.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Bounds, Camera, Plane, glam::DVec3};
    ///
    /// let bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
    /// let camera = Camera::facing(&Plane::new(DVec3::Z, -0.5)?, &bounds, DVec3::NEG_Y, (90, 90))?;
    /// assert_eq!(camera.rotation.row(2), DVec3::Z); // looks along the normal, at what is kept
    /// assert!(camera.eye.z < 0.5 && (camera.fx - 40.5).abs() < 1e-9);
    /// # Ok::<(), rara::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] for an `up` along the plane's normal and an impossible picture size.
    pub fn facing(plane: &Plane, bounds: &Bounds, up: DVec3, size: (u32, u32)) -> Result<Self> {
        let (normal, middle) = (plane.normal(), bounds.centre());
        // Splats that the plane cuts may have their centres before it, and are seen all the same.
        let target = middle - normal * plane.distance(middle);
        let eye = target - normal * standoff(bounds);
        Self::orthographic(eye, target, up, 1.0, size)?.fitted(bounds)
    }

    /// The orthographic camera at the largest scale at which the bounds are in its picture.
    fn fitted(self, bounds: &Bounds) -> Result<Self> {
        let scale = bounds
            .corners()
            .iter()
            .fold(f64::INFINITY, |scale, corner| {
                let p = self.rotation * (*corner - bounds.centre());
                scale
                    .min(FILL * self.cx / p.x.abs())
                    .min(FILL * self.cy / p.y.abs())
            });
        match scale.is_finite() && scale > 0.0 {
            true => Ok(self.fx(scale).fy(scale)),
            false => Err(Error::Invalid(
                "the scene's bounds have no extent that a picture could show; give a camera".into(),
            )),
        }
    }
}

/// The direction to the eye of a three-quarter view.
fn three_quarter(up: DVec3) -> Result<DVec3> {
    let up = up
        .try_normalize()
        .ok_or_else(|| Error::Invalid("the up vector must be finite and not zero".into()))?;
    // For a world with z up, the front is the side of -y.
    let front = if up.z.abs() < 0.9 {
        -DVec3::Z
    } else {
        -DVec3::Y
    };
    let front = (front - up * front.dot(up)).normalize();
    let side = up.cross(front);
    let (azimuth, elevation) = (AZIMUTH.to_radians(), ELEVATION.to_radians());
    Ok(elevation.cos() * (azimuth.cos() * front + azimuth.sin() * side) + elevation.sin() * up)
}

/// How far from the middle an orthographic eye stands: beyond the bounds, and as far again for what the percentiles left
/// out.
fn standoff(bounds: &Bounds) -> f64 {
    2.0 * bounds.radius() + NEAREST
}

#[cfg(test)]
mod tests;
