//! The renderer: a host's frame in three calls.

use rara::ash::vk;
use rara::{Projection, Renderer, Result};

use crate::boundary::{RaraResult, guard, invalid, recording, shared};
use crate::camera::RaraCamera;
use crate::clip::{self, FrameClip, RaraClip};
use crate::depth::{self, RaraDepthImage, RaraDepthMap};
use crate::device::RaraDevice;
use crate::handles::{alive, alone, create, destroy};
use crate::renderer_desc::{RaraRendererDesc, renderer_desc};
use crate::scene::RaraSceneBuffers;
use crate::settings::{self, RaraSettings};

/// Draws scenes into the host's rendering scopes. One thread at a time uses it.
///
/// A frame is three calls: rara_renderer_configure allocates and compiles what is new; rara_renderer_prepare records
/// compute stages, outside any rendering scope; rara_renderer_draw records the splats inside one. The host submits both
/// in this order, to the queue that it lent.
///
/// Frames in flight: before the host configures frame n it has waited for frame n - frames_in_flight, and before it
/// destroys the renderer it has waited for all of its frames.
///
/// Synchronisation: none is needed between the two recorded calls, nor for the buffers of renderer and scene. The
/// attachments are the host's to synchronise, as for any draw of its own.
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
///
/// # Safety
/// `device` is alive, `desc` is as its fields say, and `renderer` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_create(
    device: *const RaraDevice,
    desc: *const RaraRendererDesc,
    renderer: *mut *mut RaraRenderer,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(renderer, "renderer", || {
            let device = alive(device, "device")?;
            Renderer::new(&device.0, renderer_desc(desc)?).map(RaraRenderer)
        })
    })
}

/// Creates another renderer on the same device that shares the compiled pipelines of `other`: one for each view that is
/// drawn in the same scope. Its working memory is its own.
///
/// # Safety
/// `other` is alive, `desc` is as its fields say, and `renderer` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_create_sharing(
    other: *const RaraRenderer,
    desc: *const RaraRendererDesc,
    renderer: *mut *mut RaraRenderer,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(renderer, "renderer", || {
            let other = alive(other, "other")?;
            other.0.sharing(renderer_desc(desc)?).map(RaraRenderer)
        })
    })
}

/// Changes what the host's depth buffer holds for a depth, from the next rara_renderer_configure on.
///
/// # Safety
/// `renderer` is alive, was created with a depth attachment, and is not used by another thread; `map` points to one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_set_depth_map(
    renderer: *mut RaraRenderer,
    map: *const RaraDepthMap,
) -> RaraResult {
    with(renderer, |renderer| {
        // SAFETY: the caller's promise.
        renderer.set_depth_map(unsafe { shared(map, "map") }?.map()?)
    })
}

/// Changes the format of the colour attachment, from the next rara_renderer_configure on, which compiles what the format needs
/// and keeps what was compiled for others: for a host whose swapchain changes, or that draws into several targets.
///
/// # Safety
/// `renderer` is alive, and no other thread uses it.
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

/// Decides what the next frame needs, and allocates and compiles what is missing. The camera's picture is the viewport that
/// rara_renderer_draw sets. A null `clip` clips nothing, null `settings` are the defaults. After an error nothing can be
/// recorded until a call succeeds.
///
/// # Safety
/// `renderer` and `scene` are alive and of one device; no other thread uses `renderer`; the other pointers are null or
/// point to what they say. The host has waited for the frames that RaraRenderer says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_configure(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    clip: *const RaraClip,
    settings: *const RaraSettings,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        let seen = || Ok((Projection::Perspective, clip::kept(clip)?));
        configure(renderer, scene, camera, seen, settings)
    }
}

/// Configures with the projection and the clip that `seen` reads.
///
/// # Safety
/// As for [`rara_renderer_configure`].
pub(crate) unsafe fn configure(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    seen: impl FnOnce() -> Result<(Projection, FrameClip)>,
    settings: *const RaraSettings,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        with(renderer, |renderer| {
            let scene = alive(scene, "scene")?;
            let camera = shared(camera, "camera")?.camera()?;
            let (projection, kept) = seen()?;
            let (camera, clip) = kept.seen_by(camera.projection(projection));
            let settings = settings::settings(settings)?;
            renderer.configure(&scene.buffers, &camera, &clip, &settings)
        })
    }
}

/// Records the stages up to the draw, outside any rendering scope.
///
/// # Safety
/// `cmd` is recording outside a rendering scope, and will be submitted to the device's queue, or never. `scene` is the
/// one given to rara_renderer_configure, and lives until the commands have executed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_prepare(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        with(renderer, |renderer| {
            let scene = alive(scene, "scene")?;
            renderer.prepare(recording(cmd)?, &scene.buffers)
        })
    }
}

/// Like rara_renderer_prepare, for a renderer whose RaraDepthDesc is readable. It also takes the depths of what the host
/// has already drawn, so that tiles leave out the splats behind it.
///
/// The part of the image under the viewport is copied, at VK_PIPELINE_STAGE_2_COPY_BIT by VK_ACCESS_2_TRANSFER_READ_BIT:
/// the host's barrier before the call makes its depths visible to that, its barrier after the call waits for it.
///
/// # Safety
/// As for rara_renderer_prepare; and `depth` is as its fields say, visible to the copy, and lives until the commands have
/// executed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_prepare_behind(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
    depth: *const RaraDepthImage,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        with(renderer, |renderer| {
            let scene = alive(scene, "scene")?;
            let depth = depth::depth_image(depth)?;
            renderer.prepare_behind(recording(cmd)?, &scene.buffers, &depth)
        })
    }
}

/// Records the splats inside the host's rendering scope, premultiplied and over what is there. `x` and `y` are the upper
/// left corner of the camera's picture in the attachment, whole pixels; the viewport is set to that picture, upright where
/// row 0 of the attachment is the upper one, whatever viewport the host has. The host's scissor holds. The call may be
/// recorded more than once for a prepared frame. RARA_ERROR_INVALID where `x` or `y` is not finite.
///
/// # Safety
/// `cmd` is inside a rendering scope with the attachments of RaraRendererDesc and no others, one layer and no view mask;
/// a scissor is set by vkCmdSetScissor; rara_renderer_prepare was recorded for the same frame before it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_draw(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    x: f32,
    y: f32,
) -> RaraResult {
    // SAFETY: the caller's promises.
    with(renderer, |renderer| unsafe {
        renderer.draw(recording(cmd)?, [x, y])
    })
}

/// Records the splats' depths inside a rendering scope of their own, with a colour attachment of expected_depth_format
/// and, if there is one, the same depth attachment. Where the host has cleared both channels to 0, red / green is the
/// pixel's expected depth along the view axis, world units, and green its alpha. `x` and `y` are as for
/// rara_renderer_draw.
///
/// # Safety
/// As for rara_renderer_draw, in such a scope.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_draw_depth(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    x: f32,
    y: f32,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        with(renderer, |renderer| {
            renderer.draw_depth(recording(cmd)?, [x, y])
        })
    }
}

/// Forgets what earlier frames have computed, as is needed after a frame that was prepared and not submitted.
/// rara_renderer_configure comes after it.
///
/// # Safety
/// `renderer` is alive, and no other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_forget(renderer: *mut RaraRenderer) -> RaraResult {
    with(renderer, |renderer| {
        renderer.forget();
        Ok(())
    })
}

/// Frees a renderer's memory and pipelines; null is ignored. The host has waited for all of its frames.
///
/// # Safety
/// `renderer` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_destroy(renderer: *mut RaraRenderer) {
    destroy(renderer);
}
