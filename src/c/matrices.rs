//! Cameras as engines have them: from a view and a projection matrix.

use rara::ash::vk;
use rara::glam::{DMat4, Mat4};
use rara::{Camera, Ndc, Result};

use crate::boundary::{
    RaraResult, Versioned, exclusive, guard, invalid, list, read, versioned, write,
};
use crate::camera::{NOWHERE, RaraCamera};
use crate::depth::RaraDepthMap;

/// How the 16 numbers of a matrix lie in memory.
pub type RaraMatrixOrder = u32;
/// A view's translation is in numbers 12, 13 and 14: columns one after the other, of matrices that stand before column
/// vectors (glm, Eigen), or rows, of matrices that stand behind row vectors (DirectXMath). The default.
pub const RARA_MATRIX_ORDER_TRANSLATION_LAST: RaraMatrixOrder = 0;
/// A view's translation is in numbers 3, 7 and 11: rows one after the other, of matrices that stand before column vectors.
pub const RARA_MATRIX_ORDER_TRANSLATION_BESIDE: RaraMatrixOrder = 1;

/// What a host's matrices do not say of themselves and of its clip space, after the division by w: its normalised device
/// coordinates.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraNdc {
    /// Set by rara_ndc_default.
    pub struct_size: usize,
    /// How both matrices lie in memory.
    pub order: RaraMatrixOrder,
    /// True when a y of 1 is the picture's upper edge, as in Direct3D, Metal, WebGPU and OpenGL, and in Vulkan with a viewport
    /// of negative height. Default: false.
    pub y_up: vk::Bool32,
    /// True when depths go from -1 to 1, as in OpenGL and by VK_EXT_depth_clip_control; the buffer then holds (z + 1) / 2.
    /// Default: false, from 0 to 1.
    pub negative_one_to_one: vk::Bool32,
    /// True when nearer is more in the depth buffer. It is asked of orthographic projections alone, whose matrix is the same
    /// for one that looks the other way; that of a perspective one says it. Default: false.
    pub reversed: vk::Bool32,
}

versioned!(RaraNdc);

const VULKAN: RaraNdc = Versioned::BLANK;

/// Vulkan's own: y down, depths from 0 to 1, nearer is less, a view's translation in numbers 12 to 14. `ndc_size` is sizeof
/// *ndc.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_ndc_default(ndc: *mut RaraNdc, ndc_size: usize) -> RaraResult {
    guard(|| write(ndc, ndc_size, &VULKAN, "ndc"))
}

/// The camera of a host's matrices of 16 numbers each, whose rotation has a mirror in it where the world is left-handed, and
/// what its depth buffer holds, for rara_renderer_set_depth_map; `map` may be null. `width` and `height` are the viewport's,
/// pixels; `camera_size` is sizeof *camera. A null `ndc` is rara_ndc_default's.
///
/// The axes of the view may be any, with y up or down and z forward or back, left-handed ones too. The view may scale,
/// evenly along its axes, and lead from a scene instead of the world (the view times a model's matrix), mirrors included.
/// The projection may be reversed, infinite, off-centre, jittered, turned by quarters (as for a display's pre-rotation) or
/// orthographic. RARA_ERROR_INVALID names the matrix and what in it is not possible: an entry that is not finite, a matrix
/// that is singular or looks transposed, a view that shears or scales unevenly, a projection that shears, or whose depth is
/// not a function of the distance alone (as with an oblique near plane).
///
/// RaraCamera::near_cut says from which depth on splats are drawn, whatever the projection's near plane. An orthographic
/// camera's eye is moved back where that would leave out what lies behind the near plane; depths count from there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_of_projection(
    view: *const f64,
    projection: *const f64,
    ndc: *const RaraNdc,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
    map: *mut RaraDepthMap,
) -> RaraResult {
    guard(|| {
        let matrices = [(view, "view"), (projection, "projection")]
            .map(|(numbers, name)| list(numbers, 16, name).map(DMat4::from_cols_slice));
        of_projection(matrices, ndc, (width, height), (camera, camera_size), map)
    })
}

/// Does the same as rara_camera_of_projection, for matrices in single precision.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_of_projection_floats(
    view: *const f32,
    projection: *const f32,
    ndc: *const RaraNdc,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
    map: *mut RaraDepthMap,
) -> RaraResult {
    guard(|| {
        let wide = |numbers: &[f32]| Mat4::from_cols_slice(numbers).as_dmat4();
        let matrices = [(view, "view"), (projection, "projection")]
            .map(|(numbers, name)| list(numbers, 16, name).map(wide));
        of_projection(matrices, ndc, (width, height), (camera, camera_size), map)
    })
}

/// # Safety
/// As for [`rara_camera_of_projection`].
unsafe fn of_projection(
    [view, projection]: [Result<DMat4>; 2],
    ndc: *const RaraNdc,
    size: (u32, u32),
    (camera, camera_size): (*mut RaraCamera, usize),
    map: *mut RaraDepthMap,
) -> Result<()> {
    // A struct that is null or of no version is named before anything else.
    write(camera, camera_size, &NOWHERE, "camera")?;
    let ndc = match ndc.is_null() {
        true => VULKAN,
        false => read(ndc, VULKAN, "ndc")?,
    };
    let ordered = |matrix: DMat4| match ndc.order {
        RARA_MATRIX_ORDER_TRANSLATION_LAST => Ok(matrix),
        RARA_MATRIX_ORDER_TRANSLATION_BESIDE => Ok(matrix.transpose()),
        other => invalid(format!("ndc->order {other} is no RaraMatrixOrder")),
    };
    let space = Ndc::VULKAN
        .y_up(ndc.y_up != 0)
        .negative_one_to_one(ndc.negative_one_to_one != 0)
        .reversed(ndc.reversed != 0);
    let (view, projection) = (ordered(view?)?, ordered(projection?)?);
    let (made, depth) = Camera::of_projection(view, projection, space, size)?;
    write(camera, camera_size, &made.into(), "camera")?;
    if !map.is_null() {
        *exclusive(map, "map")? = RaraDepthMap::new(depth, made.projection);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
