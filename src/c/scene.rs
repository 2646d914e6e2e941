//! Scenes onto the device.

use std::ffi::CString;
use std::sync::Arc;

use rara::ash::vk;
use rara::{Clip, Layer, LayerState, Result, Scene, SceneBuffers, ShFormat};

use crate::boundary::{RaraResult, exclusive, guard, invalid, recording};
use crate::device::RaraDevice;
use crate::gaussians::RaraGaussians;
use crate::handles::{alive, create, destroy, number};
use crate::numbering::{Numbers, numbers};
use crate::staging::{self, RaraStaging};
use crate::text::c_string;

/// A scene in device memory: one layer or several. Several threads and renderers may use it at once, but nobody else
/// while rara_scene_buffers_set_layer_state runs.
pub struct RaraSceneBuffers {
    pub(crate) buffers: SceneBuffers,
    /// The layers' names.
    pub(crate) names: Vec<CString>,
}

impl RaraSceneBuffers {
    pub(crate) fn new(buffers: SceneBuffers) -> Self {
        let layers = buffers.layers().iter();
        Self {
            names: layers.map(|layer| c_string(layer.name())).collect(),
            buffers,
        }
    }
}

/// How spherical harmonics lie in device memory; the sizes are of one Gaussian of degree 3.
pub type RaraShFormat = u32;
/// 8 bits a coefficient: 56 bytes.
pub const RARA_SH_FORMAT_BYTE: RaraShFormat = 0;
/// 10 to 11 bits a coefficient: 68 bytes. The preset balanced uses it.
pub const RARA_SH_FORMAT_PACKED: RaraShFormat = 1;
/// 16-bit floats: 96 bytes.
pub const RARA_SH_FORMAT_HALF: RaraShFormat = 2;
/// 32-bit floats: 192 bytes.
pub const RARA_SH_FORMAT_FLOAT: RaraShFormat = 3;

pub(crate) fn sh_format(value: RaraShFormat) -> Result<ShFormat> {
    Ok(match value {
        RARA_SH_FORMAT_BYTE => ShFormat::Byte,
        RARA_SH_FORMAT_PACKED => ShFormat::Packed,
        RARA_SH_FORMAT_HALF => ShFormat::Half,
        RARA_SH_FORMAT_FLOAT => ShFormat::Float,
        _ => return invalid(format!("sh_format {value} is no RaraShFormat")),
    })
}

/// Uploads a scene of one layer. Only this function, rara_scene_buffers_upload_layers and rara_renderer_channels submit to the
/// host's queue and wait.
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
    upload(device, sh_format, scene, || one_layer(gaussians))
}

/// A layer of a scene that is to be uploaded.
pub(crate) struct GivenLayer {
    pub(crate) gaussians: Arc<RaraGaussians>,
    pub(crate) name: String,
    pub(crate) state: LayerState,
    /// Its own; `None` where the frame's holds.
    pub(crate) clip: Option<Clip>,
}

/// The one layer that a set of Gaussians is.
fn one_layer(gaussians: *const RaraGaussians) -> Result<Vec<GivenLayer>> {
    Ok(vec![GivenLayer {
        gaussians: alive(gaussians, "gaussians")?,
        name: "scene".into(),
        state: LayerState::default(),
        clip: None,
    }])
}

/// What the Gaussians of these layers are numbered by.
pub(crate) fn numbers_of(given: &[GivenLayer]) -> Vec<Numbers<'_>> {
    let layers = given.iter().map(|given| {
        let RaraGaussians {
            gaussians, part, ..
        } = &*given.gaussians;
        (gaussians.len(), part.as_ref())
    });
    numbers(&layers.collect::<Vec<_>>())
}

/// The scene of these layers, whose numbers are those of [`numbers_of`].
pub(crate) fn of_layers<'a>(given: &'a [GivenLayer], numbers: &'a [Numbers<'_>]) -> Scene<'a> {
    let layer = |(given, numbers): (&'a GivenLayer, &'a Numbers<'_>)| {
        let mut layer =
            Layer::new(given.name.as_str(), &given.gaussians.gaussians).with(given.state);
        if let Some(clip) = &given.clip {
            layer = layer.clipped(clip.clone());
        }
        match numbers {
            Some((first, in_set)) => layer.numbered(*first, in_set),
            None => layer,
        }
    };
    given.iter().zip(numbers).map(layer).collect()
}

/// Uploads the scene that `layers` gives.
///
/// # Safety
/// As for rara_scene_buffers_upload, but for what `layers` reads.
pub(crate) unsafe fn upload(
    device: *const RaraDevice,
    sh_format: RaraShFormat,
    scene: *mut *mut RaraSceneBuffers,
    layers: impl FnOnce() -> Result<Vec<GivenLayer>>,
) -> RaraResult {
    guard(|| {
        create(scene, "scene", || {
            let device = alive(device, "device")?;
            let layers = layers()?;
            let numbers = numbers_of(&layers);
            let scene = of_layers(&layers, &numbers);
            let format = self::sh_format(sh_format)?;
            SceneBuffers::upload(&device.0, scene, format).map(RaraSceneBuffers::new)
        })
    })
}

/// Bytes of staging memory for the scene that `layers` gives.
pub(crate) unsafe fn staging_bytes(
    sh_format: RaraShFormat,
    bytes: *mut u64,
    layers: impl FnOnce() -> Result<Vec<GivenLayer>>,
) -> RaraResult {
    guard(|| {
        let bytes = exclusive(bytes, "bytes")?;
        let layers = layers()?;
        let numbers = numbers_of(&layers);
        let scene = of_layers(&layers, &numbers);
        *bytes = SceneBuffers::staging_bytes(scene, self::sh_format(sh_format)?);
        Ok(())
    })
}

/// Uploads the scene that `layers` gives by the host's own means.
///
/// # Safety
/// As for rara_scene_buffers_upload_with, but for what `layers` reads.
pub(crate) unsafe fn upload_with(
    device: *const RaraDevice,
    cmd: vk::CommandBuffer,
    staging: *const RaraStaging,
    sh_format: RaraShFormat,
    scene: *mut *mut RaraSceneBuffers,
    layers: impl FnOnce() -> Result<Vec<GivenLayer>>,
) -> RaraResult {
    guard(|| {
        create(scene, "scene", || {
            let device = alive(device, "device")?;
            let cmd = recording(cmd)?;
            let staging = staging::staging(staging)?;
            let layers = layers()?;
            let numbers = numbers_of(&layers);
            let scene = of_layers(&layers, &numbers);
            let format = self::sh_format(sh_format)?;
            SceneBuffers::upload_with(&device.0, cmd, staging, scene, format)
                .map(RaraSceneBuffers::new)
        })
    })
}

/// Bytes of staging memory that rara_scene_buffers_upload_with needs for a scene of one layer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_staging_bytes(
    gaussians: *const RaraGaussians,
    sh_format: RaraShFormat,
    bytes: *mut u64,
) -> RaraResult {
    staging_bytes(sh_format, bytes, || one_layer(gaussians))
}

/// Uploads a scene of one layer by the host's own means: allocates its buffers, writes it into the host's staging memory
/// and records the copies. Nothing is submitted and nothing waits, so that a scene can come or be replaced while frames
/// are in flight. The calling thread converts the scene meanwhile; it need not be the one that draws.
///
/// Synchronisation: the copies are ordered behind everything earlier in the queue, and nothing is needed after them,
/// since rara_renderer_prepare begins with a barrier that waits for transfers. It may be recorded later into the same
/// command buffer, or into one that is submitted later to the same queue. What is written to the staging memory reaches
/// the device with the submission where the memory is host-coherent; else the host flushes the range before it submits.
///
/// Lifetimes: the host leaves the staging range alone and keeps `*scene` alive until `cmd` has executed. A scene that is
/// replaced lives until the last frame that was prepared with it has executed; `gaussians` may be destroyed at once. If
/// `cmd` is never submitted, `*scene` must not be drawn. After an error nothing has been recorded.
///
/// # Safety
/// `device` and `gaussians` are alive. `cmd` is recording outside a rendering scope, and will be submitted to the
/// device's queue, or never; no other thread uses its pool. `staging` is as its fields say, and neither the device nor
/// anybody else uses its range. `scene` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_upload_with(
    device: *const RaraDevice,
    cmd: vk::CommandBuffer,
    staging: *const RaraStaging,
    gaussians: *const RaraGaussians,
    sh_format: RaraShFormat,
    scene: *mut *mut RaraSceneBuffers,
) -> RaraResult {
    upload_with(device, cmd, staging, sh_format, scene, || {
        one_layer(gaussians)
    })
}

/// Bytes of device memory that a scene takes, 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_bytes(scene: *const RaraSceneBuffers) -> u64 {
    number(scene, "scene", |scene| scene.buffers.bytes())
}

/// Frees a scene's device memory; null is ignored. The host has waited for the frames that use it.
///
/// # Safety
/// `scene` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_destroy(scene: *mut RaraSceneBuffers) {
    destroy(scene);
}
