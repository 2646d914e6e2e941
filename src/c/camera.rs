//! Cameras: a plain struct, and four ways to make one; `matrices` and `shots` have others.

use rara::glam::{DMat3, DMat4, DVec3};
use rara::scene::Bounds;
use rara::{Camera, Projection, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, list, read, versioned, write};
use crate::gaussians::RaraGaussians;
use crate::handles::alive;

/// How a camera sees.
pub type RaraProjection = u32;
/// The camera is in perspective.
pub const RARA_PROJECTION_PERSPECTIVE: RaraProjection = 0;
/// Lines of sight run along the view axis.
pub const RARA_PROJECTION_ORTHOGRAPHIC: RaraProjection = 1;

pub(crate) fn projection(value: RaraProjection) -> Result<Projection> {
    Ok(match value {
        RARA_PROJECTION_PERSPECTIVE => Projection::Perspective,
        RARA_PROJECTION_ORTHOGRAPHIC => Projection::Orthographic,
        _ => return invalid(format!("projection {value} is no RaraProjection")),
    })
}

pub(crate) fn projection_in_c(projection: Projection) -> RaraProjection {
    match projection {
        Projection::Orthographic => RARA_PROJECTION_ORTHOGRAPHIC,
        _ => RARA_PROJECTION_PERSPECTIVE,
    }
}

/// A camera in COLMAP's convention: +x right, +y down, +z forward, pixel centres at half-integers.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraCamera {
    /// Set by the functions that make a camera: the size that they were given, or less where this library knows less.
    pub struct_size: usize,
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
    /// How it sees.
    pub projection: RaraProjection,
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
    /// The depth along the view axis, world units, from which on the scene is kept: a plane across the axis that moves with
    /// the camera and cuts every layer, whatever else cuts it, those with a clip of their own too. Splats are cut exactly, as
    /// by any other plane; RARA_MODE_NONE does not ask. -INFINITY, which the functions that make a camera set, for no such
    /// plane.
    pub clip_near: f64,
    /// The depth up to which the scene is kept, likewise. INFINITY, which these functions set, for no such plane.
    pub clip_far: f64,
    /// The depth along the view axis, world units, from which on splats are drawn: those whose centres are nearer are left out
    /// whole. 0, which these functions set, stands for 0.2 units of the scene, as in 3DGS.
    pub near_cut: f64,
}

versioned!(RaraCamera);

impl From<Camera> for RaraCamera {
    fn from(camera: Camera) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            width: camera.width,
            height: camera.height,
            projection: projection_in_c(camera.projection),
            fx: camera.fx,
            fy: camera.fy,
            cx: camera.cx,
            cy: camera.cy,
            eye: camera.eye.into(),
            rotation: camera.rotation.transpose().to_cols_array(),
            clip_near: camera.clip_near.unwrap_or(f64::NEG_INFINITY),
            clip_far: camera.clip_far.unwrap_or(f64::INFINITY),
            near_cut: camera.near_cut.unwrap_or(0.0),
        }
    }
}

/// A camera that is none, with no planes.
pub(crate) const NOWHERE: RaraCamera = RaraCamera {
    clip_near: f64::NEG_INFINITY,
    clip_far: f64::INFINITY,
    ..Versioned::BLANK
};

/// Reads a host's camera.
pub(crate) unsafe fn camera(camera: *const RaraCamera) -> Result<Camera> {
    read(camera, NOWHERE, "camera")?.camera()
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
        let depth = |depth: f64, none: f64, field: &str| {
            let is_none = depth == none;
            match is_none || depth.is_finite() {
                true => Ok((!is_none).then_some(depth)),
                false => invalid(format!(
                    "camera->{field} is {depth}: give a depth, or {none} for none"
                )),
            }
        };
        let near = depth(self.clip_near, f64::NEG_INFINITY, "clip_near")?;
        let far = depth(self.clip_far, f64::INFINITY, "clip_far")?;
        let cut = depth(self.near_cut, 0.0, "near_cut")?;
        let turned = turned.projection(projection(self.projection)?);
        // Exactly the host's numbers, once all of them have been found possible.
        let exact = turned.rotation(rotation).eye(eye).resized(size)?;
        Ok(exact.clip_near(near).clip_far(far).near_cut(cut))
    }
}

/// A camera in perspective at `eye` that looks at `target`; each is three numbers in world units. `up` points up in the
/// picture; in the usual world, where y is down, it is 0, -1, 0. `fov_y` is the full vertical field of view in degrees.
/// `camera_size` is sizeof *camera.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_look_at(
    eye: *const f64,
    target: *const f64,
    up: *const f64,
    fov_y: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    make(camera, camera_size, || {
        let [eye, target, up] = look(eye, target, up)?;
        Camera::look_at(eye, target, up, fov_y, (width, height))
    })
}

/// A camera without perspective at `eye` that looks at `target`, whose picture of `width` x `height` pixels is `view_height`
/// world units high. `eye`, `target` and `up` are as for rara_camera_look_at.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_orthographic(
    eye: *const f64,
    target: *const f64,
    up: *const f64,
    view_height: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    make(camera, camera_size, || {
        let [eye, target, up] = look(eye, target, up)?;
        Camera::orthographic(eye, target, up, view_height, (width, height))
    })
}

/// A camera from a rigid world-to-camera matrix: 16 numbers, row-major, so that the translation is in numbers 3, 7
/// and 11. Focal lengths and principal point are in pixels.
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
    camera_size: usize,
) -> RaraResult {
    make(camera, camera_size, || {
        let matrix = DMat4::from_cols_slice(list(matrix, 16, "matrix")?).transpose();
        Camera::from_world_to_camera(matrix, (fx, fy, cx, cy), (width, height))
    })
}

/// A camera that shows a scene from the front, the right and above, near enough to fill the picture. `up` and `fov_y` are
/// as for rara_camera_look_at.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_frame(
    gaussians: *const RaraGaussians,
    up: *const f64,
    fov_y: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    make(camera, camera_size, || {
        let bounds = Bounds::of(&alive(gaussians, "gaussians")?.gaussians);
        Camera::frame(&bounds, vector(up, "up")?, fov_y, (width, height))
    })
}

/// Writes the camera that `made` gives.
pub(crate) unsafe fn make(
    camera: *mut RaraCamera,
    camera_size: usize,
    made: impl FnOnce() -> Result<Camera>,
) -> RaraResult {
    guard(|| {
        // A struct that is null or of no version is named before anything else.
        write(camera, camera_size, &NOWHERE, "camera")?;
        write(camera, camera_size, &made()?.into(), "camera")
    })
}

/// The eye, the target and the upward direction of a camera.
unsafe fn look(eye: *const f64, target: *const f64, up: *const f64) -> Result<[DVec3; 3]> {
    Ok([
        vector(eye, "eye")?,
        vector(target, "target")?,
        vector(up, "up")?,
    ])
}

pub(crate) unsafe fn vector(numbers: *const f64, name: &str) -> Result<DVec3> {
    Ok(DVec3::from_slice(list(numbers, 3, name)?))
}
