//! Frames that are configured ahead: a host configures the next one while it records this one.

use rara::FrameToken;
use rara::ash::vk;

use crate::boundary::{RaraResult, guard, recording, shared};
use crate::camera::RaraCamera;
use crate::clip::{self, RaraClip};
use crate::depth::{self, RaraDepthImage};
use crate::handles::{alive, alone, create, destroy};
use crate::renderer::RaraRenderer;
use crate::scene::RaraSceneBuffers;
use crate::settings::{self, RaraSettings};

/// A frame that was configured ahead, to be prepared and drawn whatever is configured after it. One thread at a time uses it.
pub struct RaraFrameToken(FrameToken);

/// As rara_renderer_configure, for a host that configures a frame while it records another: the frame goes with the token, and
/// what rara_renderer_configure has configured stays. Frames are prepared in the order in which they are configured, and
/// each is drawn before the next is prepared. Before it prepares frame n, the host has waited for frame
/// n - frames_in_flight. A frame that is configured while another one waits to be prepared takes nothing over from it.
///
/// # Safety
/// As for rara_renderer_configure, and `token` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_configure_ahead(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    clip: *const RaraClip,
    settings: *const RaraSettings,
    token: *mut *mut RaraFrameToken,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(token, "token", || {
            let mut renderer = alone(renderer, "renderer")?;
            let scene = alive(scene, "scene")?;
            let camera = shared(camera, "camera")?.camera()?;
            let (camera, clip) = clip::kept(clip)?.seen_by(camera);
            let settings = settings::settings(settings)?;
            let renderer = &mut renderer.0;
            let token = renderer.configure_ahead(&scene.buffers, &camera, &clip, &settings)?;
            Ok(RaraFrameToken(token))
        })
    })
}

/// Records the stages of a token's frame, as rara_renderer_prepare does, or with `depth`, which else is null,
/// rara_renderer_prepare_behind. RARA_ERROR_INVALID for another renderer's token, for one that is prepared already, and for
/// one that takes over from another frame than the one prepared last; nothing is recorded then.
///
/// # Safety
/// As for those; `scene` is the one given to rara_renderer_configure_ahead.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_prepare_token(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
    depth: *const RaraDepthImage,
    token: *mut RaraFrameToken,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        let mut renderer = alone(renderer, "renderer")?;
        let mut token = alone(token, "token")?;
        let scene = alive(scene, "scene")?;
        let depth = match depth.is_null() {
            true => None,
            false => Some(depth::depth_image(depth)?),
        };
        let (renderer, token) = (&mut renderer.0, &mut token.0);
        renderer.prepare_token(recording(cmd)?, &scene.buffers, depth.as_ref(), token)
    })
}

/// Records a token's splats, as rara_renderer_draw does, before another frame is prepared.
///
/// # Safety
/// As for rara_renderer_draw.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_draw_token(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    x: f32,
    y: f32,
    token: *const RaraFrameToken,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        let mut renderer = alone(renderer, "renderer")?;
        let token = alive(token, "token")?;
        renderer.0.draw_token(recording(cmd)?, [x, y], &token.0)
    })
}

/// Records a token's expected depths, as rara_renderer_draw_depth does, before another frame is prepared.
///
/// # Safety
/// As for rara_renderer_draw_depth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_draw_token_depth(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    x: f32,
    y: f32,
    token: *const RaraFrameToken,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        let mut renderer = alone(renderer, "renderer")?;
        let token = alive(token, "token")?;
        renderer
            .0
            .draw_token_depth(recording(cmd)?, [x, y], &token.0)
    })
}

/// Ends a token, prepared or not; null is ignored. The memory of a frame that the device works on stays until it is done.
///
/// # Safety
/// `token` is null, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_frame_token_destroy(token: *mut RaraFrameToken) {
    destroy(token);
}
