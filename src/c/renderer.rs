//! The renderer: a host's frame in three calls.

use rara::ash::vk;
use rara::gpu::{Bindings, Target};
use rara::{Clip, ExpectedDepthDesc, Projection, Renderer, RendererDesc, Result};

use crate::boundary::{
    RaraResult, Versioned, create, destroy, exclusive, guard, invalid, read, recording, shared,
    write,
};
use crate::camera::RaraCamera;
use crate::clip::{self, RaraClip};
use crate::depth::{self, RaraDepthDesc, RaraDepthImage, RaraDepthMap};
use crate::device::RaraDevice;
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

/// How shaders reach buffers.
pub type RaraBindings = u32;
/// By address, which is fast. The default.
pub const RARA_BINDINGS_ADDRESS: RaraBindings = 0;
/// Bound, so that the validation layer can watch them. Needs VK_KHR_push_descriptor; without it buffers are reached by
/// address.
pub const RARA_BINDINGS_BOUND: RaraBindings = 1;

/// The description of a renderer to be created.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraRendererDesc {
    /// Set by rara_renderer_desc_default.
    pub struct_size: usize,
    /// Format of the colour attachment. Splats are blended as stored, premultiplied, so sRGB formats give another picture.
    pub color_format: vk::Format,
    /// Samples a pixel of the attachments. Default: 1.
    pub samples: vk::SampleCountFlags,
    /// The depth attachment that splats are tested against; null, the default, if the scope has none. Only the call
    /// itself reads it.
    pub depth: *const RaraDepthDesc,
    /// A classic render pass, or one compatible with it, that lives until the last rara_renderer_configure; null, the
    /// default, stands for dynamic rendering.
    pub render_pass: vk::RenderPass,
    /// The subpass of render_pass to draw in.
    pub subpass: u32,
    /// How shaders reach buffers.
    pub bindings: RaraBindings,
    /// True to take timestamps, for the times in RaraFrameStats. Default: false.
    pub timing: vk::Bool32,
    /// True to let a frame take over what the one before has computed and it would compute again. The host must then
    /// submit every frame that it prepares, in order, or call rara_renderer_forget. Default: false.
    pub reuse: vk::Bool32,
    /// How many recorded frames may be unfinished at once, 1 or more. Default: 1.
    pub frames_in_flight: u32,
    /// Format of the target of rara_renderer_draw_depth, two channels or more; VK_FORMAT_UNDEFINED, the default, if that
    /// function is not called.
    pub expected_depth_format: vk::Format,
    /// Like render_pass, for that target.
    pub expected_depth_render_pass: vk::RenderPass,
    /// The subpass of expected_depth_render_pass to draw in.
    pub expected_depth_subpass: u32,
}

// SAFETY: repr(C), numbers, handles and a pointer, the size first.
unsafe impl Versioned for RaraRendererDesc {
    const NAME: &'static str = "RaraRendererDesc";
}

impl RaraRendererDesc {
    fn new(color_format: vk::Format) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            color_format,
            samples: vk::SampleCountFlags::TYPE_1,
            depth: std::ptr::null(),
            render_pass: vk::RenderPass::null(),
            subpass: 0,
            bindings: RARA_BINDINGS_ADDRESS,
            timing: vk::FALSE,
            reuse: vk::FALSE,
            frames_in_flight: 1,
            expected_depth_format: vk::Format::UNDEFINED,
            expected_depth_render_pass: vk::RenderPass::null(),
            expected_depth_subpass: 0,
        }
    }
}

/// # Safety
/// As for [`Target::render_pass`], unless it is null.
unsafe fn target(render_pass: vk::RenderPass, subpass: u32) -> Target {
    if render_pass == vk::RenderPass::null() {
        return Target::DYNAMIC;
    }
    // SAFETY: the caller's promise.
    unsafe { Target::render_pass(render_pass, subpass) }
}

/// # Safety
/// `desc` is null or points to one, whose depth is null or points to one, and whose render pass is as its field says.
unsafe fn renderer_desc(desc: *const RaraRendererDesc) -> Result<RendererDesc> {
    let default = RaraRendererDesc::new(vk::Format::UNDEFINED);
    // SAFETY: the caller's promise.
    let desc = unsafe { read(desc, default, "desc") }?;
    if desc.color_format == vk::Format::UNDEFINED {
        return invalid("desc->color_format is VK_FORMAT_UNDEFINED");
    }
    if desc.frames_in_flight == 0 {
        return invalid("desc->frames_in_flight is 0: a renderer needs at least one");
    }
    let depth = if desc.depth.is_null() {
        None
    } else {
        // SAFETY: the caller's promise.
        Some(unsafe { depth::depth_desc(desc.depth) }?)
    };
    let expects_depth = desc.expected_depth_format != vk::Format::UNDEFINED;
    let expected_depth = expects_depth.then(|| {
        let (pass, subpass) = (desc.expected_depth_render_pass, desc.expected_depth_subpass);
        // SAFETY: the caller's promise.
        let target = unsafe { target(pass, subpass) };
        ExpectedDepthDesc::new(desc.expected_depth_format).target(target)
    });
    let bindings = match desc.bindings {
        RARA_BINDINGS_ADDRESS => Bindings::Address,
        RARA_BINDINGS_BOUND => Bindings::Bound,
        other => return invalid(format!("desc->bindings {other} is no RaraBindings")),
    };
    // SAFETY: the caller's promise.
    let target = unsafe { target(desc.render_pass, desc.subpass) };
    // Statistics stay off: they need a device that rara has opened itself.
    Ok(RendererDesc::new(desc.color_format)
        .depth(depth)
        .samples(desc.samples)
        .expected_depth(expected_depth)
        .target(target)
        .bindings(bindings)
        .timing(desc.timing != 0)
        .reuse(desc.reuse != 0)
        .frames_in_flight(desc.frames_in_flight))
}

/// Calls a function with a renderer, or says that it is null.
///
/// # Safety
/// `renderer` is null, or alive and not used by another thread.
pub(crate) unsafe fn with(
    renderer: *mut RaraRenderer,
    act: impl FnOnce(&mut Renderer) -> Result<()>,
) -> RaraResult {
    guard(|| {
        // SAFETY: the caller's promise.
        let renderer = unsafe { exclusive(renderer, "renderer") }?;
        act(&mut renderer.0)
    })
}

/// One colour attachment of one sample in dynamic rendering, no timestamps, no reuse, one frame in flight. `desc_size` is
/// sizeof *desc.
///
/// # Safety
/// `desc` has room for `desc_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_desc_default(
    desc: *mut RaraRendererDesc,
    desc_size: usize,
    color_format: vk::Format,
) -> RaraResult {
    let default = RaraRendererDesc::new(color_format);
    // SAFETY: the caller's promise.
    guard(|| unsafe { write(desc, desc_size, &default, "desc") })
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
            let device = &shared(device, "device")?.0;
            Renderer::new(device, renderer_desc(desc)?).map(RaraRenderer)
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
            let other = &shared(other, "other")?.0;
            other.sharing(renderer_desc(desc)?).map(RaraRenderer)
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
    // SAFETY: the caller's promises.
    unsafe {
        with(renderer, |renderer| {
            renderer.set_depth_map(shared(map, "map")?.map()?)
        })
    }
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
        let seen = || Ok((Projection::Perspective, clip::clip(clip)?));
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
    seen: impl FnOnce() -> Result<(Projection, Clip)>,
    settings: *const RaraSettings,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        with(renderer, |renderer| {
            let scene = shared(scene, "scene")?;
            let camera = shared(camera, "camera")?.camera()?;
            let (projection, clip) = seen()?;
            let (camera, settings) = (camera.projection(projection), settings::settings(settings)?);
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
            let scene = shared(scene, "scene")?;
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
            let scene = shared(scene, "scene")?;
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
    unsafe { with(renderer, |renderer| renderer.draw(recording(cmd)?, [x, y])) }
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
    // SAFETY: the caller's promise.
    unsafe {
        with(renderer, |renderer| {
            renderer.forget();
            Ok(())
        })
    }
}

/// Frees a renderer's memory and pipelines; null is ignored. The host has waited for all of its frames.
///
/// # Safety
/// `renderer` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_destroy(renderer: *mut RaraRenderer) {
    // SAFETY: the caller's promise.
    unsafe { destroy(renderer) };
}
