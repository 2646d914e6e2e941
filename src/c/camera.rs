//! Cameras: a plain struct, and three ways to make one; `matrices` has a fourth.

use rara::Camera;
use rara::Result;
use rara::glam::{DMat3, DMat4, DVec3};
use rara::scene::Bounds;

use crate::boundary::{RaraResult, exclusive, guard, list};
use crate::gaussians::RaraGaussians;
use crate::handles::alive;

/// A camera in COLMAP's convention: +x right, +y down, +z forward, pixel centres at half-integers. It is a pinhole, unless
/// rara_renderer_configure_orthographic takes it. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraCamera {
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
    /// Focal length along x, pixels; without perspective the pixels of a world unit.
    pub fx: f64,
    /// Focal length along y, pixels; without perspective the pixels of a world unit.
    pub fy: f64,
    /// Principal point, pixels from the picture's left edge; width / 2 is the middle.
    pub cx: f64,
    /// Principal point, pixels from the picture's top edge; height / 2 is the middle.
    pub cy: f64,
    /// The eye's position, world units.
    pub eye: [f64; 3],
    /// World to camera rotation, row-major: the rows are the camera's right, down and forward axes in the world. A determinant
    /// of -1 mirrors the picture's world, as rara_camera_of_projection does for a left-handed host.
    pub rotation: [f64; 9],
}

impl From<Camera> for RaraCamera {
    fn from(camera: Camera) -> Self {
        Self {
            width: camera.width,
            height: camera.height,
            fx: camera.fx,
            fy: camera.fy,
            cx: camera.cx,
            cy: camera.cy,
            eye: camera.eye.into(),
            rotation: camera.rotation.transpose().to_cols_array(),
        }
    }
}

impl RaraCamera {
    /// The camera, checked, since a host may have written anything into it.
    pub(crate) fn camera(&self) -> Result<Camera> {
        let size = (self.width, self.height);
        let lens = (self.fx, self.fy, self.cx, self.cy);
        let rotation = DMat3::from_cols_array(&self.rotation).transpose();
        let eye = DVec3::from(self.eye);
        // A mirror is a rotation with every axis turned around.
        let proper = match rotation.determinant() < 0.0 {
            true => -rotation,
            false => rotation,
        };
        let turned = Camera::from_world_to_camera(DMat4::from_mat3(proper), lens, size)?;
        // Exactly the host's numbers, once all of them have been found possible.
        turned.rotation(rotation).eye(eye).resized(size)
    }
}

/// A camera in perspective at `eye` that looks at `target`; each is three numbers in world units. `up` points up in the
/// picture; in the usual world, where y is down, it is 0, -1, 0. `fov_y` is the full vertical field of view in degrees.
///
/// # Safety
/// `eye`, `target` and `up` point to three numbers each; `camera` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_look_at(
    eye: *const f64,
    target: *const f64,
    up: *const f64,
    fov_y: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        make(camera, || {
            let [eye, target, up] = look(eye, target, up)?;
            Camera::look_at(eye, target, up, fov_y, (width, height))
        })
    }
}

/// A camera from a rigid world-to-camera matrix: 16 numbers, row-major, so that the translation is in numbers 3, 7
/// and 11. Focal lengths and principal point are in pixels.
///
/// # Safety
/// `matrix` points to 16 numbers; `camera` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_from_world_to_camera(
    matrix: *const f64,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        make(camera, || {
            let matrix = DMat4::from_cols_slice(list(matrix, 16, "matrix")?).transpose();
            Camera::from_world_to_camera(matrix, (fx, fy, cx, cy), (width, height))
        })
    }
}

/// A camera that shows a scene from the front, the right and above, near enough to fill the picture. `up` and `fov_y` are
/// as for rara_camera_look_at.
///
/// # Safety
/// `gaussians` is alive; `up` points to three numbers; `camera` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_frame(
    gaussians: *const RaraGaussians,
    up: *const f64,
    fov_y: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        make(camera, || {
            let bounds = Bounds::of(&alive(gaussians, "gaussians")?.gaussians);
            Camera::frame(&bounds, vector(up, "up")?, fov_y, (width, height))
        })
    }
}

/// Writes the camera that `made` gives.
///
/// # Safety
/// `camera` is null or may be overwritten.
pub(crate) unsafe fn make(
    camera: *mut RaraCamera,
    made: impl FnOnce() -> Result<Camera>,
) -> RaraResult {
    guard(|| {
        // SAFETY: the caller's promise.
        let camera = unsafe { exclusive(camera, "camera") }?;
        *camera = made()?.into();
        Ok(())
    })
}

/// The eye, the target and the upward direction of a camera.
///
/// # Safety
/// Each is null or points to three numbers.
pub(crate) unsafe fn look(
    eye: *const f64,
    target: *const f64,
    up: *const f64,
) -> Result<[DVec3; 3]> {
    // SAFETY: the caller's promise.
    unsafe {
        Ok([
            vector(eye, "eye")?,
            vector(target, "target")?,
            vector(up, "up")?,
        ])
    }
}

/// # Safety
/// `numbers` is null or points to three of them.
pub(crate) unsafe fn vector(numbers: *const f64, name: &str) -> Result<DVec3> {
    // SAFETY: the caller's promise.
    Ok(DVec3::from_slice(unsafe { list(numbers, 3, name) }?))
}
