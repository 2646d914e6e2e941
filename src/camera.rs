//! A pinhole camera in COLMAP's convention: +x right, +y down, +z forward, pixel centres at half-integers.

use glam::{DMat3, DMat4, DVec3};

use crate::error::{Error, Result};
use crate::setters::setters;

/// A pinhole camera and the size of its picture. All in f64: the GPU gets single-precision values derived from it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Camera {
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
    /// Focal length along x, pixels.
    pub fx: f64,
    /// Focal length along y, pixels.
    pub fy: f64,
    /// Principal point, pixels from the picture's left edge (`width / 2` is the middle).
    pub cx: f64,
    /// Principal point, pixels from the picture's top edge (`height / 2` is the middle).
    pub cy: f64,
    /// The eye's position, world units.
    pub eye: DVec3,
    /// World to camera rotation (rows are the camera's right, down and forward axes in the world).
    pub rotation: DMat3,
}

setters!(Camera {
    width: u32,
    height: u32,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    eye: DVec3,
    rotation: DMat3,
});

impl Camera {
    /// Largest picture side, pixels. Vulkan guarantees 4096; every driver we know has at least this.
    pub const MAX_SIZE: u32 = 16384;

    /// A camera at `eye` that looks at `target`. `up` points up in the picture (the default world has y down: `-Y`).
    /// `fov_y` is the full vertical field of view in degrees.
    pub fn look_at(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        fov_y: f64,
        (width, height): (u32, u32),
    ) -> Result<Self> {
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(Error::Invalid(
                "the camera's eye, target and up must be finite numbers".into(),
            ));
        }
        if !(fov_y > 0.0 && fov_y < 180.0) {
            return Err(Error::Invalid(format!(
                "a field of view of {fov_y} degrees is not between 0 and 180"
            )));
        }
        let forward = (target - eye).try_normalize();
        let forward = forward.ok_or_else(|| {
            Error::Invalid("the camera's eye and target are the same point".into())
        })?;
        let right = forward
            .cross(up)
            .try_normalize()
            .filter(|_| forward.cross(up).length() > 1e-12 * up.length());
        let right = right.ok_or_else(|| {
            Error::Invalid("the camera looks along its own up vector; give another --up".into())
        })?;
        let down = forward.cross(right);
        let focal = f64::from(height) / 2.0 / (fov_y.to_radians() / 2.0).tan();
        let camera = Self {
            width,
            height,
            fx: focal,
            fy: focal,
            cx: f64::from(width) / 2.0,
            cy: f64::from(height) / 2.0,
            eye,
            rotation: DMat3::from_cols(right, down, forward).transpose(),
        };
        camera.checked()
    }

    /// A camera from a rigid world-to-camera matrix. The rotation part is made orthonormal when it is nearly so
    /// already (files round it); anything else (scale, shear, mirror) is an error.
    pub fn from_world_to_camera(
        matrix: DMat4,
        (fx, fy, cx, cy): (f64, f64, f64, f64),
        (width, height): (u32, u32),
    ) -> Result<Self> {
        let rows = DMat3::from_mat4(matrix).transpose();
        let error = (rows.transpose() * rows - DMat3::IDENTITY)
            .to_cols_array()
            .iter()
            .fold(0.0_f64, |a, x| a.max(x.abs()));
        if !matrix.is_finite() || error.is_nan() || error > 1e-3 || rows.determinant() < 0.0 {
            return Err(Error::Invalid("the camera's matrix is not a rotation and a translation (scale, shear and mirrors are not supported)".into()));
        }
        let forward = rows.z_axis.normalize();
        let right = (rows.x_axis - forward * rows.x_axis.dot(forward)).normalize();
        let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
        let eye = -(rotation.transpose() * matrix.w_axis.truncate());
        Self {
            width,
            height,
            fx,
            fy,
            cx,
            cy,
            eye,
            rotation,
        }
        .checked()
    }

    fn checked(self) -> Result<Self> {
        let possible = 1..=Self::MAX_SIZE;
        if !(possible.contains(&self.width) && possible.contains(&self.height)) {
            return Err(Error::Invalid(format!(
                "a picture of {}x{} is not possible; each side is 1 to {} pixels",
                self.width,
                self.height,
                Self::MAX_SIZE
            )));
        }
        let focal_ok = |f: f64| f.is_finite() && f > 0.0;
        if !(focal_ok(self.fx) && focal_ok(self.fy) && self.cx.is_finite() && self.cy.is_finite()) {
            return Err(Error::Invalid(
                "the camera's focal lengths must be positive and its principal point finite".into(),
            ));
        }
        // Finite numbers of a file can still sum up beyond the range.
        if !self.eye.is_finite() {
            return Err(Error::Invalid("the camera's position is not finite".into()));
        }
        Ok(self)
    }

    /// The same camera for a picture of another size: focal lengths and principal point scale with it.
    pub fn resized(self, (width, height): (u32, u32)) -> Result<Self> {
        let (sx, sy) = (
            f64::from(width) / f64::from(self.width),
            f64::from(height) / f64::from(self.height),
        );
        Self {
            width,
            height,
            fx: self.fx * sx,
            fy: self.fy * sy,
            cx: self.cx * sx,
            cy: self.cy * sy,
            ..self
        }
        .checked()
    }

    /// World to camera, as one matrix.
    pub fn world_to_camera(&self) -> DMat4 {
        DMat4::from_mat3_translation(self.rotation, -(self.rotation * self.eye))
    }
}
