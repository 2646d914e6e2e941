//! Room for what will come, and the memory that it takes.

use std::ffi::c_char;

use rara::{FrameLimits, Preset, Result, Settings};

use crate::boundary::{
    RaraResult, Versioned, exclusive, guard, read, read_list, versioned, write, write_list,
};
use crate::camera::{self, RaraCamera};
use crate::device::RaraDevice;
use crate::frame::RaraFrame;
use crate::handles::{alive, number};
use crate::renderer::{RaraRenderer, with};
use crate::scene::{RARA_SH_FORMAT_PACKED, RaraSceneBuffers, RaraShFormat};
use crate::settings::RaraSettings;
use crate::settings::choice;
use crate::text::fixed;

/// The most that frames will ask for, for rara_renderer_reserve.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraFrameLimits {
    /// Set by rara_frame_limits_default.
    pub struct_size: usize,
    /// Width of the pictures, pixels.
    pub width: u32,
    /// Height of the pictures, pixels, which may be another picture's than the width.
    pub height: u32,
    /// Gaussians of a scene, all of its layers together.
    pub gaussians: u32,
    /// Layers of a scene. Default: 1.
    pub layers: u32,
    /// How the scenes' spherical harmonics are stored. Default: RARA_SH_FORMAT_PACKED.
    pub sh_format: RaraShFormat,
    /// Planes of a RaraClip that is a list of planes; RaraCamera::clip_near and clip_far add one each. Default: 6.
    pub planes: u32,
    /// Surfaces of a RaraClip that bends or combines. Default: 0, for none.
    pub surfaces: u32,
    /// Pairs of tile and splat, for which there is then exactly this room: a frame with more has coarse lists, the same
    /// picture but slower, and RaraFrameStats::fell_back says so. rara_scene_buffers_estimated_pairs tells a camera's.
    /// Default: 0, for the usual room, 2 a Gaussian and 64 a tile of 8x8 pixels, which grows and allocates where a frame needs
    /// more.
    pub pairs: u32,
    /// The settings that frames have, each with every kind of clip: modes, rasters, what is shown and with which laws. Only
    /// the call itself reads them. Default: null, for the default ones in all four modes.
    pub settings: *const RaraSettings,
    /// How many settings there are.
    pub settings_count: usize,
    /// Faces of the meshes whose insides a RaraClip has. Default: 0, for none.
    pub faces: u32,
}

versioned!(RaraFrameLimits);

impl RaraFrameLimits {
    fn new(width: u32, height: u32, gaussians: u32) -> Self {
        let usual = FrameLimits::new((width, height), gaussians);
        Self {
            width,
            height,
            gaussians,
            layers: usual.layers,
            sh_format: RARA_SH_FORMAT_PACKED,
            planes: usual.planes,
            surfaces: usual.surfaces,
            ..Versioned::BLANK
        }
    }

    unsafe fn limits(&self) -> Result<FrameLimits> {
        let default = RaraSettings::new(Preset::default());
        let (first, count) = (self.settings, self.settings_count);
        let given = read_list(first, count, default, "limits->settings")?;
        let settings: Vec<Settings> = given
            .iter()
            .map(RaraSettings::settings)
            .collect::<Result<_>>()?;
        let limits = FrameLimits::new((self.width, self.height), self.gaussians);
        let limits = limits
            .layers(self.layers)
            .sh_format(choice(self.sh_format, "sh_format")?)
            .planes(self.planes)
            .surfaces(self.surfaces)
            .faces(self.faces)
            .pairs((self.pairs > 0).then_some(self.pairs));
        Ok(match settings.is_empty() {
            true => limits,
            false => limits.settings(settings),
        })
    }
}

/// Limits of frames of one layer that is cut by up to six planes in any mode. `limits_size` is sizeof *limits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_frame_limits_default(
    limits: *mut RaraFrameLimits,
    limits_size: usize,
    width: u32,
    height: u32,
    gaussians: u32,
) -> RaraResult {
    let default = RaraFrameLimits::new(width, height, gaussians);
    guard(|| write(limits, limits_size, &default, "limits"))
}

/// Compiles the pipelines and allocates the working memory of all frames within limits: rara_renderer_configure then
/// compiles and allocates nothing for them, whatever their cameras, clips, modes and scenes. Frames beyond the limits are
/// configured as without them, and what was reserved stays.
///
/// It takes a fraction of a second to some seconds, submits nothing, and may be called on any thread, as while a scene loads;
/// the renderer is used by no other call meanwhile. A renderer of rara_renderer_create_sharing compiles for both.
/// rara_renderer_configure comes after it. RARA_ERROR_MEMORY where there is no room; of a budget's it is said before
/// anything is allocated or compiled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_reserve(
    renderer: *mut RaraRenderer,
    limits: *const RaraFrameLimits,
) -> RaraResult {
    with(renderer, |renderer| {
        let limits = read(limits, RaraFrameLimits::new(1, 1, 0), "limits")?;
        renderer.reserve(&limits.limits()?)
    })
}

/// Gives back the working memory, also what was reserved, but for what a frame like `keep` needs, which is prepared or null:
/// for that rara_renderer_configure then allocates nothing. The host has waited for all of the renderer's frames.
///
/// # Safety
/// `renderer` is alive, no other thread uses it, and the device has finished its frames; `keep` is null or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_trim(
    renderer: *mut RaraRenderer,
    keep: *const RaraFrame,
) -> RaraResult {
    with(renderer, |renderer| {
        let keep = match keep.is_null() {
            true => None,
            false => Some(alive(keep, "keep")?),
        };
        renderer.trim(keep.as_deref().map(RaraFrame::prepared).transpose()?)
    })
}

/// Bytes of device memory that the renderer's working memory takes, 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_bytes(renderer: *const RaraRenderer) -> u64 {
    number(renderer, "renderer", |renderer| renderer.0.bytes())
}

/// An estimate of the pairs of tile and splat in a camera's picture, for RaraFrameLimits::pairs: without what a clip leaves
/// out, with the scene where it was made, and with the usual near cut. Splats that are nearer have the most pairs of all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_estimated_pairs(
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    pairs: *mut u32,
) -> RaraResult {
    guard(|| {
        let pairs = exclusive(pairs, "pairs")?;
        let scene = alive(scene, "scene")?;
        let camera = camera::camera(camera)?;
        *pairs = scene.buffers.estimated_pairs(&camera);
        Ok(())
    })
}

/// Device memory and pipelines of a device.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraDeviceMemory {
    /// Set by rara_device_memory.
    pub struct_size: usize,
    /// Bytes that scenes and renderers take.
    pub bytes: u64,
    /// The most that `bytes` has ever been.
    pub peak_bytes: u64,
    /// The most that `bytes` may become, as rara_device_set_memory_budget has set it; 0 for no limit.
    pub budget: u64,
    /// Allocations so far, freed or not.
    pub allocation_count: u64,
    /// Pipelines compiled so far, destroyed or not.
    pub pipeline_count: u64,
}

versioned!(RaraDeviceMemory);

/// The device memory that rara has allocated, and the pipelines that it has compiled. `memory_size` is sizeof *memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_memory(
    device: *const RaraDevice,
    memory: *mut RaraDeviceMemory,
    memory_size: usize,
) -> RaraResult {
    guard(|| {
        let device = &alive(device, "device")?.0;
        let found = RaraDeviceMemory {
            struct_size: size_of::<RaraDeviceMemory>(),
            bytes: device.device_bytes(),
            peak_bytes: device.peak_device_bytes(),
            budget: device.memory_budget().unwrap_or(0),
            allocation_count: device.allocation_count(),
            pipeline_count: device.pipeline_count(),
        };
        write(memory, memory_size, &found, "memory")
    })
}

/// Room for the name of what takes memory, the NUL included.
pub const RARA_MEMORY_NAME_SIZE: usize = 64;

/// The memory that buffers or images of one name take together. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraNamedBytes {
    /// Their name, which is their debug name too: UTF-8, cut off where it does not fit.
    pub name: [c_char; RARA_MEMORY_NAME_SIZE],
    /// The bytes that they take, with what alignment adds.
    pub bytes: u64,
}

/// Lists what takes the device memory that rara has allocated, the largest first.
///
/// On entry `*count` is how many there is room for at `parts`; it becomes how many there are. No more are written than there is
/// room for, and none where `parts` is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_memory_by_name(
    device: *const RaraDevice,
    parts: *mut RaraNamedBytes,
    count: *mut usize,
) -> RaraResult {
    guard(|| {
        let device = alive(device, "device")?;
        write_list(parts, count, &device.0.memory_by_name(), |part| {
            RaraNamedBytes {
                name: fixed(&part.name),
                bytes: part.bytes,
            }
        })
    })
}

/// Sets the most bytes of device memory that all scenes and renderers of a device may take together; 0, as in the
/// beginning, for no limit but the device's. What would exceed it fails with RARA_ERROR_MEMORY before any of it is allocated,
/// and the message says what to do. What is there already stays. Any thread may call this at any time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_set_memory_budget(
    device: *const RaraDevice,
    bytes: u64,
) -> RaraResult {
    guard(|| {
        let device = &alive(device, "device")?.0;
        device.set_memory_budget((bytes > 0).then_some(bytes));
        Ok(())
    })
}
