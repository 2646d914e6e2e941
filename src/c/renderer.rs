//! The renderer.

use std::ffi::c_char;

use rara::ash::vk;
use rara::{Renderer, Result};

use crate::boundary::{RaraResult, guard, invalid, shared};
use crate::depth::RaraDepthMap;
use crate::device::RaraDevice;
use crate::handles::{alive, alone, create, destroy};
use crate::renderer_desc::{RaraRendererDesc, renderer_desc};
use crate::text::text;

/// Draws scenes into the host's rendering scopes. Calls of several threads take turns.
///
/// A frame is three calls: rara_renderer_configure allocates and compiles what is new, and makes the frame;
/// rara_renderer_prepare records its compute stages, outside any rendering scope; rara_renderer_draw records its splats
/// inside one. The host submits both in this order, to the queue that it lent.
///
/// Frames in flight: before the host configures frame n it has waited for frame n - frames_in_flight, and before it
/// destroys the renderer it has waited for all of its frames. Frames are prepared in the order in which they are configured,
/// and each is drawn before the next is prepared; one that is configured while another waits to be prepared takes nothing
/// over from it. Where the next frame is configured before this one's slot is free, frames_in_flight is one more than the
/// host's slots.
///
/// Synchronisation: none is needed between the two recorded calls, nor for the buffers of renderer and scene. The
/// attachments are the host's to synchronise, as for any draw of its own.
///
/// Two queues: with `compute_family` of RaraRendererDesc, what rara_renderer_prepare and a cut, a picker or a layer editor of
/// the renderer record goes to a queue of that family, and the draws go to the queue that was lent. Then a semaphore has the
/// draws wait for their preparation, and another one has each preparation wait for the draws before it.
///
/// The calls bind pipelines, push constants and, with RARA_BINDINGS_BOUND, push descriptor set 0: the host binds its own
/// again. rara_renderer_draw sets the viewport, so that the host's own may be any, of negative height too, and binding
/// rara's pipelines undoes all other dynamic state but the scissor: the host sets all that its pipelines need again. The
/// scissor is the host's, and is not touched. No image and no layout is.
pub struct RaraRenderer(pub(crate) Renderer);

/// Calls a function with a renderer, or says why there is none.
pub(crate) fn with(
    renderer: *mut RaraRenderer,
    act: impl FnOnce(&mut Renderer) -> Result<()>,
) -> RaraResult {
    guard(|| act(&mut alone(renderer, "renderer")?.0))
}

/// Creates a renderer. The first frame that needs a pipeline or buffer creates it. RARA_ERROR_DEVICE where the device
/// cannot draw into such attachments.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_create(
    device: *const RaraDevice,
    desc: *const RaraRendererDesc,
    renderer: *mut *mut RaraRenderer,
) -> RaraResult {
    create(renderer, "renderer", || {
        let device = alive(device, "device")?;
        Renderer::new(&device.0, renderer_desc(desc)?).map(RaraRenderer)
    })
}

/// Names the renderer: its commands are under a debug label of that name, as far as 63 bytes go, which tells the eyes of a
/// frame apart. An empty name takes the label away.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_set_name(
    renderer: *mut RaraRenderer,
    name: *const c_char,
) -> RaraResult {
    with(renderer, |renderer| {
        renderer.set_name(text(name, "name")?);
        Ok(())
    })
}

/// Creates another renderer on the same device that shares the compiled pipelines of `other`: one for each view that is
/// drawn in the same scope. Its working memory is its own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_create_sharing(
    other: *const RaraRenderer,
    desc: *const RaraRendererDesc,
    renderer: *mut *mut RaraRenderer,
) -> RaraResult {
    create(renderer, "renderer", || {
        let other = alive(other, "other")?;
        other.0.sharing(renderer_desc(desc)?).map(RaraRenderer)
    })
}

/// Changes what the host's depth buffer holds for a depth, from the next rara_renderer_configure on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_set_depth_map(
    renderer: *mut RaraRenderer,
    map: *const RaraDepthMap,
) -> RaraResult {
    with(renderer, |renderer| {
        renderer.set_depth_map(shared(map, "map")?.map()?)
    })
}

/// Changes the format of the colour attachment, from the next rara_renderer_configure on, which compiles what the format needs
/// and keeps what was compiled for others: for a host whose swapchain changes, or that draws into several targets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_set_color_format(
    renderer: *mut RaraRenderer,
    color_format: vk::Format,
) -> RaraResult {
    with(renderer, |renderer| {
        if color_format == vk::Format::UNDEFINED {
            return invalid("color_format is VK_FORMAT_UNDEFINED");
        }
        renderer.set_color_format(color_format);
        Ok(())
    })
}

/// Forgets what earlier frames have computed, as is needed after a frame that was prepared and not submitted.
/// rara_renderer_configure comes after it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_forget(renderer: *mut RaraRenderer) -> RaraResult {
    with(renderer, |renderer| {
        renderer.forget();
        Ok(())
    })
}

/// Frees a renderer's memory and pipelines; null is ignored. The host has waited for all of its frames, or calls
/// rara_device_destroy_after.
///
/// # Safety
/// `renderer` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_destroy(renderer: *mut RaraRenderer) {
    destroy(renderer);
}
