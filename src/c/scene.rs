//! Scenes: from files and memory, and onto the device.

use std::ffi::{CStr, c_char};
use std::io::Cursor;
use std::path::PathBuf;

use rara::scene::{Bounds, Loaded, load, load_from};
use rara::{Gaussians, Result, SceneBuffers, ShFormat};

use crate::boundary::{
    RaraResult, Versioned, create, destroy, exclusive, guard, invalid, list, shared, string, write,
};
use crate::device::RaraDevice;

/// A scene in the host's memory. It may be destroyed when it is on the device. May be read by several threads at once.
pub struct RaraGaussians(pub(crate) Loaded);

/// A scene in device memory. May be used by several threads and renderers at once.
pub struct RaraSceneBuffers(pub(crate) SceneBuffers);

/// What a scene is, and what of its file could not be used.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraGaussiansInfo {
    /// Set by rara_gaussians_info.
    pub struct_size: usize,
    /// Gaussians in the scene.
    pub count: u64,
    /// Elements of the file that were left out: numbers that are not finite.
    pub dropped: u64,
    /// Elements that were kept with a value put right.
    pub repaired: u64,
    /// Degree of its spherical harmonics, 0 to 3.
    pub sh_degree: u32,
    /// The corner of the scene's box with the smallest coordinates. The box holds all but the outermost percent of the
    /// centres at each end of each axis.
    pub bounds_min: [f64; 3],
    /// The corner with the largest coordinates.
    pub bounds_max: [f64; 3],
}

// SAFETY: repr(C), plain numbers, the size first.
unsafe impl Versioned for RaraGaussiansInfo {
    const NAME: &'static str = "RaraGaussiansInfo";
}

/// How spherical harmonics lie in device memory; bytes are of a Gaussian of degree 3.
pub type RaraShFormat = u32;
/// 8 bits a coefficient: 56 bytes.
pub const RARA_SH_FORMAT_BYTE: RaraShFormat = 0;
/// 10 to 11 bits a coefficient: 68 bytes. What the preset balanced uses.
pub const RARA_SH_FORMAT_PACKED: RaraShFormat = 1;
/// 16-bit floats: 96 bytes.
pub const RARA_SH_FORMAT_HALF: RaraShFormat = 2;
/// 32-bit floats: 192 bytes.
pub const RARA_SH_FORMAT_FLOAT: RaraShFormat = 3;

fn sh_format(value: RaraShFormat) -> Result<ShFormat> {
    Ok(match value {
        RARA_SH_FORMAT_BYTE => ShFormat::Byte,
        RARA_SH_FORMAT_PACKED => ShFormat::Packed,
        RARA_SH_FORMAT_HALF => ShFormat::Half,
        RARA_SH_FORMAT_FLOAT => ShFormat::Float,
        _ => return invalid(format!("sh_format {value} is no RaraShFormat")),
    })
}

/// Loads a 3DGS .ply file: ascii or binary, spherical harmonics of degree 0 to 3.
///
/// `path` is UTF-8, on Unix whatever the file system takes.
///
/// # Safety
/// `path` ends in NUL; `gaussians` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_load(
    path: *const c_char,
    gaussians: *mut *mut RaraGaussians,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(gaussians, "gaussians", || {
            let path = path_of(string(path, "path")?)?;
            load(&path, &mut |_, _| ()).map(RaraGaussians)
        })
    })
}

/// Loads a 3DGS .ply file that is in memory, such as an archive's entry. `name` stands for it in messages.
///
/// # Safety
/// `data` points to `size` bytes, which are not used afterwards; `name` ends in NUL; `gaussians` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_load_from(
    data: *const u8,
    size: usize,
    name: *const c_char,
    gaussians: *mut *mut RaraGaussians,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(gaussians, "gaussians", || {
            let name = path_of(string(name, "name")?)?;
            let source = Cursor::new(list(data, size, "data")?);
            load_from(source, &name, &mut |_, _| ()).map(RaraGaussians)
        })
    })
}

/// Adds another scene to one, so that both are sorted and composited as one.
///
/// # Safety
/// Both are alive and not the same; nobody else uses `gaussians` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_append(
    gaussians: *mut RaraGaussians,
    other: *const RaraGaussians,
) -> RaraResult {
    guard(|| {
        if std::ptr::eq(gaussians, other) && !other.is_null() {
            return invalid("gaussians and other are the same scene");
        }
        // SAFETY: the caller's promises, and they are two.
        let (to, from) = unsafe { (exclusive(gaussians, "gaussians")?, shared(other, "other")?) };
        to.0.gaussians.append(&from.0.gaussians);
        to.0.report.dropped += from.0.report.dropped;
        to.0.report.repaired += from.0.report.repaired;
        Ok(())
    })
}

/// What a scene is. `info_size` is sizeof *info.
///
/// # Safety
/// `gaussians` is alive; `info` has room for `info_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_info(
    gaussians: *const RaraGaussians,
    info: *mut RaraGaussiansInfo,
    info_size: usize,
) -> RaraResult {
    guard(|| {
        // SAFETY: the caller's promise.
        let Loaded { gaussians, report } = &unsafe { shared(gaussians, "gaussians") }?.0;
        let bounds = Bounds::of(gaussians);
        let found = RaraGaussiansInfo {
            struct_size: size_of::<RaraGaussiansInfo>(),
            count: gaussians.len() as u64,
            dropped: report.dropped,
            repaired: report.repaired,
            sh_degree: gaussians.sh_degree,
            bounds_min: bounds.min.into(),
            bounds_max: bounds.max.into(),
        };
        // SAFETY: the caller's promise.
        unsafe { write(info, info_size, &found, "info") }
    })
}

/// Frees a scene's memory; null is ignored.
///
/// # Safety
/// `gaussians` is null, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_destroy(gaussians: *mut RaraGaussians) {
    // SAFETY: the caller's promise.
    unsafe { destroy(gaussians) };
}

/// Uploads a scene. This is the one function that submits to the host's queue, and waits.
///
/// # Safety
/// `device` and `gaussians` are alive; nobody else uses the queue meanwhile; `scene` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_upload(
    device: *const RaraDevice,
    gaussians: *const RaraGaussians,
    sh_format: RaraShFormat,
    scene: *mut *mut RaraSceneBuffers,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(scene, "scene", || {
            let device = &shared(device, "device")?.0;
            let gaussians: &Gaussians = &shared(gaussians, "gaussians")?.0.gaussians;
            let format = self::sh_format(sh_format)?;
            SceneBuffers::upload(device, gaussians, format).map(RaraSceneBuffers)
        })
    })
}

/// Bytes of device memory that a scene takes, 0 for null.
///
/// # Safety
/// `scene` is null or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_bytes(scene: *const RaraSceneBuffers) -> u64 {
    let mut bytes = 0;
    guard(|| {
        // SAFETY: the caller's promise.
        bytes = unsafe { shared(scene, "scene") }?.0.bytes();
        Ok(())
    });
    bytes
}

/// Frees a scene's device memory; null is ignored. The host has waited for the frames that use it.
///
/// # Safety
/// `scene` is null, or alive and not used any more, by the device neither.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_destroy(scene: *mut RaraSceneBuffers) {
    // SAFETY: the caller's promise.
    unsafe { destroy(scene) };
}

#[cfg(unix)]
fn path_of(path: &CStr) -> Result<PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    Ok(std::ffi::OsStr::from_bytes(path.to_bytes()).into())
}

#[cfg(not(unix))]
fn path_of(path: &CStr) -> Result<PathBuf> {
    match path.to_str() {
        Ok(path) => Ok(path.into()),
        Err(_) => invalid("the path is not UTF-8"),
    }
}
