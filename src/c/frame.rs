//! Frames: configured, prepared, drawn.

use rara::ash::vk;
use rara::{ConfiguredFrame, Kept, PreparedFrame, Renderer, Result};

use crate::boundary::{RaraResult, guard, invalid, recording};
use crate::camera::{self, RaraCamera};
use crate::clip::{self, RaraClip};
use crate::cut::RaraCut;
use crate::depth::{self, RaraDepthImage};
use crate::handles::{alive, alone, create, destroy};
use crate::renderer::{RaraRenderer, with};
use crate::scene::RaraSceneBuffers;
use crate::settings::{self, RaraSettings};

/// A frame that rara_renderer_configure has made, rara_renderer_prepare records and rara_renderer_draw draws, whatever is
/// configured after it. It keeps the memory that it is recorded with: destroy it after its last draw. One thread at a time
/// uses it.
pub struct RaraFrame(FrameState);

enum FrameState {
    Configured(ConfiguredFrame),
    Prepared(PreparedFrame),
    /// Its preparation was refused.
    Refused,
}

impl RaraFrame {
    /// The frame, if it is prepared, for a draw.
    pub(crate) fn prepared(&self) -> Result<&PreparedFrame> {
        match &self.0 {
            FrameState::Prepared(frame) => Ok(frame),
            FrameState::Configured(_) | FrameState::Refused => {
                invalid("frame was not prepared: call rara_renderer_prepare before")
            }
        }
    }
}

/// Decides what a frame needs, and allocates and compiles what is missing. The camera's picture is the viewport that
/// rara_renderer_draw sets. A null `clip` clips nothing, null `settings` are the defaults.
///
/// # Safety
/// `renderer` and `scene` are of one device, and no other thread uses `renderer`. The host has waited for the frames that
/// RaraRenderer says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_configure(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    clip: *const RaraClip,
    settings: *const RaraSettings,
    frame: *mut *mut RaraFrame,
) -> RaraResult {
    create(frame, "frame", || {
        let clip = clip::clip(clip, "clip")?.unwrap_or_default();
        configured(renderer, scene, camera, &clip, settings)
    })
}

/// Does what rara_renderer_configure does, for a frame that shows a cut of the scene in place of a clip's. The frame's
/// rara_renderer_prepare comes after rara_cut_prepare. RARA_ERROR_INVALID for a cut that is not configured or is another scene's,
/// and for a camera with near or far planes, which would cut as well.
///
/// # Safety
/// As for rara_renderer_configure. The cut lives until the frame's commands have executed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_configure_cut(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    cut: *const RaraCut,
    settings: *const RaraSettings,
    frame: *mut *mut RaraFrame,
) -> RaraResult {
    create(frame, "frame", || {
        let cut = alive(cut, "cut")?;
        configured(renderer, scene, camera, &cut.0, settings)
    })
}

/// Configures a frame that shows what a clip or a cut keeps.
unsafe fn configured<'a>(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    kept: impl Into<Kept<'a>>,
    settings: *const RaraSettings,
) -> Result<RaraFrame> {
    let mut renderer = alone(renderer, "renderer")?;
    let scene = alive(scene, "scene")?;
    let camera = camera::camera(camera)?;
    let settings = settings::settings(settings)?;
    let renderer = &mut renderer.0;
    let frame = renderer.configure(&scene.buffers, &camera, kept.into(), &settings)?;
    Ok(RaraFrame(FrameState::Configured(frame)))
}

/// Records a frame's stages up to the draw, outside any rendering scope. `depth` is null, or for a renderer whose
/// RaraDepthDesc is readable the depths of what the host has already drawn, so that tiles leave out the splats behind it.
/// RARA_ERROR_INVALID for a frame of another renderer, of another scene, that is prepared already, or that takes over from
/// another one than the frame prepared last; nothing is recorded then, and the frame is of no more use.
///
/// The part of the depth image under the viewport is copied, at VK_PIPELINE_STAGE_2_COPY_BIT by
/// VK_ACCESS_2_TRANSFER_READ_BIT, or where RaraDepthDesc is `sampled`, sampled, at VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT by
/// VK_ACCESS_2_SHADER_SAMPLED_READ_BIT: the host's barrier before the call makes its depths visible to that, its barrier after
/// the call waits for it.
///
/// # Safety
/// `cmd` is recording outside a rendering scope, and will be submitted to the device's queue, or never. `scene` is the
/// one given to rara_renderer_configure, and lives until the commands have executed; so does the depth image, which is as
/// its fields say and visible to what reads it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_prepare(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
    depth: *const RaraDepthImage,
    frame: *mut RaraFrame,
) -> RaraResult {
    guard(|| {
        let mut renderer = alone(renderer, "renderer")?;
        let scene = alive(scene, "scene")?;
        let mut frame = alone(frame, "frame")?;
        let depth = match depth.is_null() {
            true => None,
            false => Some(depth::depth_image(depth)?),
        };
        let cmd = recording(cmd)?;
        let configured = match std::mem::replace(&mut frame.0, FrameState::Refused) {
            FrameState::Configured(configured) => configured,
            other => {
                frame.0 = other;
                return invalid(
                    "frame was given to rara_renderer_prepare already: configure another",
                );
            }
        };
        let prepared = renderer
            .0
            .prepare(cmd, &scene.buffers, depth.as_ref(), configured)?;
        frame.0 = FrameState::Prepared(prepared);
        Ok(())
    })
}

/// Records a frame's splats inside the host's rendering scope, premultiplied and over what is there. `x` and `y` are the upper
/// left corner of the camera's picture in the attachment, whole pixels; the viewport is set to that picture, upright where
/// row 0 of the attachment is the upper one, whatever viewport the host has. The host's scissor holds. The call may be
/// recorded more than once for a frame. RARA_ERROR_INVALID for another frame than the one that the renderer has prepared
/// last, and where `x` or `y` is not finite.
///
/// # Safety
/// `cmd` is inside a rendering scope with the attachments of RaraRendererDesc and no others, one layer and its `view_mask`;
/// a scissor is set by vkCmdSetScissor; the commands of rara_renderer_prepare come before it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_draw(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    x: f32,
    y: f32,
    frame: *const RaraFrame,
) -> RaraResult {
    draw(renderer, cmd, [x, y], frame, Renderer::draw)
}

/// Draws a frame that is prepared, by a renderer and into a command buffer that are there.
unsafe fn draw(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    origin: [f32; 2],
    frame: *const RaraFrame,
    by: unsafe fn(&mut Renderer, vk::CommandBuffer, [f32; 2], &PreparedFrame) -> Result<()>,
) -> RaraResult {
    with(renderer, |renderer| {
        let frame = alive(frame, "frame")?;
        by(renderer, recording(cmd)?, origin, frame.prepared()?)
    })
}

/// Records a frame's depths inside a rendering scope of their own, with a colour attachment of expected_depth_format
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
    frame: *const RaraFrame,
) -> RaraResult {
    draw(renderer, cmd, [x, y], frame, Renderer::draw_depth)
}

/// Records a frame's motion inside a rendering scope of its own, with a colour attachment of motion_format and, if there is one,
/// the same depth attachment. Red and green are where what a pixel shows was in the frame that this renderer has prepared
/// before, less where it is, px to the right and down; blue is the number of its layer, and alpha is 1, or 0 where that frame could
/// not show it: there was none, the clip or the layer's state hid it, or it was behind the eye. A pixel shows the splat that
/// adds most to its alpha. Pixels whose alpha is below motion_least_alpha keep what the host has drawn. Motion is 0 where
/// there is no frame before. `x` and `y` are as for rara_renderer_draw.
///
/// # Safety
/// As for rara_renderer_draw, in such a scope.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_draw_motion(
    renderer: *mut RaraRenderer,
    cmd: vk::CommandBuffer,
    x: f32,
    y: f32,
    frame: *const RaraFrame,
) -> RaraResult {
    draw(renderer, cmd, [x, y], frame, Renderer::draw_motion)
}

/// Ends a frame, prepared or not; null is ignored. The memory of a frame that the device works on stays until it is done.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_frame_destroy(frame: *mut RaraFrame) {
    destroy(frame);
}
