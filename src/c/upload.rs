//! Scenes onto the device: by rara's own means, or by the host's.

use rara::SceneBuffers;
use rara::ash::vk;

use crate::boundary::{RaraResult, exclusive, guard, recording};
use crate::device::RaraDevice;
use crate::handles::{alive, create};
use crate::layer::{RaraLayer, given};
use crate::scene::{RaraSceneBuffers, RaraShFormat, numbers_of, of_layers};
use crate::settings::choice;
use crate::staging::{self, RaraStaging};

/// Uploads a scene of layers, one or several, which are all of one struct_size. Only this function and rara_renderer_channels
/// submit to the host's queue and wait. The layers are sorted and blended together, wherever they reach into each other.
/// Where two Gaussians are equally deep, the earlier layer's is in front; of those that rara_gaussians_select has divided the
/// one is that was before the other.
///
/// # Safety
/// The layers are as their fields say, and nobody else uses the queue meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_upload(
    device: *const RaraDevice,
    layers: *const RaraLayer,
    layer_count: usize,
    sh_format: RaraShFormat,
    scene: *mut *mut RaraSceneBuffers,
) -> RaraResult {
    create(scene, "scene", || {
        let device = alive(device, "device")?;
        let layers = given(layers, layer_count)?;
        let numbers = numbers_of(&layers);
        let scene = of_layers(&layers, &numbers);
        let format = choice(sh_format, "sh_format")?;
        SceneBuffers::upload(&device.0, scene, format).map(RaraSceneBuffers::new)
    })
}

/// Bytes of staging memory that rara_scene_buffers_upload_with needs for a scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_staging_bytes(
    layers: *const RaraLayer,
    layer_count: usize,
    sh_format: RaraShFormat,
    bytes: *mut u64,
) -> RaraResult {
    guard(|| {
        let bytes = exclusive(bytes, "bytes")?;
        let layers = given(layers, layer_count)?;
        let numbers = numbers_of(&layers);
        let scene = of_layers(&layers, &numbers);
        *bytes = SceneBuffers::staging_bytes(scene, choice(sh_format, "sh_format")?);
        Ok(())
    })
}

/// Uploads a scene as rara_scene_buffers_upload does, but by the host's own means: allocates its buffers, writes it into the
/// host's staging memory and records the copies. Nothing is submitted and nothing waits, so that a scene can come or be
/// replaced while frames are in flight. The calling thread converts the scene meanwhile; it need not be the one that draws.
///
/// Synchronisation: the copies wait for nothing, as their memory is new, and nothing is needed after them, since
/// rara_renderer_prepare begins with a barrier that waits for transfers. It may be recorded later into the same command buffer,
/// or into one that is submitted later to the same queue. Where `cmd` goes to another queue, as one for transfers alone, whose
/// family is one of `shared_families` of RaraAdoptDesc, the submission of rara_renderer_prepare waits for a semaphore. What is
/// written to the staging memory reaches the device with the submission where the memory is host-coherent; else the host flushes
/// the range before it submits.
///
/// Lifetimes: the host leaves the staging range alone and keeps `*scene` alive until `cmd` has executed. A scene that is
/// replaced lives until the last frame that was prepared with it has executed; `layers` and what they point to may be freed
/// at once. If `cmd` is never submitted, `*scene` must not be drawn. After an error nothing has been recorded.
///
/// # Safety
/// The layers are as their fields say. `cmd` is recording outside a rendering scope, and will be submitted to the device's
/// queue or to one of a shared family, or never; no other thread uses its pool. `staging` is as its fields say, and neither the
/// device nor anybody else uses its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_upload_with(
    device: *const RaraDevice,
    cmd: vk::CommandBuffer,
    staging: *const RaraStaging,
    layers: *const RaraLayer,
    layer_count: usize,
    sh_format: RaraShFormat,
    scene: *mut *mut RaraSceneBuffers,
) -> RaraResult {
    create(scene, "scene", || {
        let device = alive(device, "device")?;
        let cmd = recording(cmd)?;
        let staging = staging::staging(staging)?;
        let layers = given(layers, layer_count)?;
        let numbers = numbers_of(&layers);
        let scene = of_layers(&layers, &numbers);
        let format = choice(sh_format, "sh_format")?;
        SceneBuffers::upload_with(&device.0, cmd, staging, scene, format).map(RaraSceneBuffers::new)
    })
}
