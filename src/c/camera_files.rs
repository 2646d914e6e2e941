//! Cameras from files.

use std::ffi::c_char;

use rara::camera_files::load_cameras;
use rara::{Error, Projection};

use crate::boundary::{RaraResult, exclusive, guard};
use crate::camera::RaraCamera;
use crate::text::{self, fixed};

/// Room for a camera's name in RaraNamedCamera, the NUL included.
pub const RARA_MAX_CAMERA_NAME: usize = 256;

/// A camera and what its file calls it. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraNamedCamera {
    /// The picture's name in the file, or the camera's number there: UTF-8, cut off where it does not fit.
    pub name: [c_char; RARA_MAX_CAMERA_NAME],
    /// The camera.
    pub camera: RaraCamera,
}

/// Loads the cameras of a 3DGS cameras.json, a nerfstudio transforms.json, a COLMAP sparse folder, or a single one from
/// JSON with width, height, fx, fy, cx, cy and world_to_camera. JSON files keep their order, COLMAP's cameras are
/// sorted by name. Cameras with lens distortion, and orthographic ones, are RARA_ERROR_FORMAT.
///
/// On entry `*count` is how many cameras there is room for at `cameras`; it becomes how many the file has. No more are
/// written than there is room for; with `cameras` null the call only counts. `path` is as for rara_gaussians_load.
///
/// # Safety
/// `path` ends in NUL; `count` points to a number; `cameras` is null, or has room for `*count` cameras.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cameras_load(
    path: *const c_char,
    cameras: *mut RaraNamedCamera,
    count: *mut usize,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        let count = exclusive(count, "count")?;
        let path = text::path(path, "path")?;
        let loaded = load_cameras(&path)?;
        if let Some(flat) = loaded
            .iter()
            .find(|n| n.camera.projection != Projection::Perspective)
        {
            let message = format!(
                "camera `{}` is orthographic, which no RaraCamera can be",
                flat.name
            );
            return Err(Error::format(path, message));
        }
        let room = if cameras.is_null() { 0 } else { *count };
        for (i, named) in loaded.iter().take(room).enumerate() {
            cameras.add(i).write(RaraNamedCamera {
                name: fixed(&named.name),
                camera: named.camera.into(),
            });
        }
        *count = loaded.len();
        Ok(())
    })
}
