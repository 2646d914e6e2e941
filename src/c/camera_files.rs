//! Cameras from files.

use std::ffi::c_char;

use rara::ash::vk;
use rara::camera_files::load_cameras;

use crate::boundary::{RaraResult, exclusive, guard, invalid, write};
use crate::camera::{NOWHERE, RaraCamera};
use crate::text::{self, fixed};

/// Room for a camera's name, the NUL included.
pub const RARA_MAX_CAMERA_NAME: usize = 256;

/// The name of a camera in its file. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraCameraName {
    /// The picture's name in the file, or the camera's number there: UTF-8, cut off where it does not fit.
    pub text: [c_char; RARA_MAX_CAMERA_NAME],
}

/// Loads the cameras of a 3DGS cameras.json, a nerfstudio transforms.json, a COLMAP sparse folder, or a single one from
/// JSON with width, height, fx, fy, cx, cy and world_to_camera. JSON files keep their order, COLMAP's cameras are
/// sorted by name. A camera that cannot be drawn, as one whose lens bends straight lines, becomes one of width 0, which no
/// function takes: rara_camera_load says why, and has its pinhole.
///
/// On entry `*count` is how many cameras there is room for at `cameras` and `names`; it becomes how many the file has. No more
/// are written than there is room for, and none where `cameras` or `names` is null. `camera_size` is sizeof *cameras. `path` is
/// as for rara_gaussians_load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cameras_load(
    path: *const c_char,
    cameras: *mut RaraCamera,
    camera_size: usize,
    names: *mut RaraCameraName,
    count: *mut usize,
) -> RaraResult {
    guard(|| {
        let count = exclusive(count, "count")?;
        let path = text::path(path, "path")?;
        let loaded = load_cameras(&path)?;
        for (i, named) in loaded.iter().take(*count).enumerate() {
            if !cameras.is_null() {
                let to = cameras.byte_add(i * camera_size);
                let camera = named.camera().map_or(NOWHERE, RaraCamera::from);
                write(to, camera_size, &camera, "cameras")?;
            }
            if !names.is_null() {
                let text = fixed(named.name());
                names.add(i).write(RaraCameraName { text });
            }
        }
        *count = loaded.len();
        Ok(())
    })
}

/// Loads one of the cameras that rara_cameras_load lists, by its number from 0. One that cannot be drawn is RARA_ERROR_FORMAT, and
/// its message names it, its lens and the file. With `undistort` a lens that bends straight lines is left out: the camera is the
/// pinhole of the same focal lengths and principal point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_load(
    path: *const c_char,
    number: usize,
    undistort: vk::Bool32,
    camera: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    guard(|| {
        let path = text::path(path, "path")?;
        let loaded = load_cameras(&path)?;
        let Some(named) = loaded.get(number) else {
            let file = path.display();
            return invalid(format!(
                "{file} has no camera {number}: its last is {}; numbers count from 0",
                loaded.len() - 1
            ));
        };
        let found = match undistort {
            0 => named.camera()?,
            _ => named.undistorted()?,
        };
        write(camera, camera_size, &found.into(), "camera")
    })
}
