//! The description of a renderer to be created.

use rara::ash::vk;
use rara::gpu::{Bindings, Target};
use rara::{ColorSpace, ExpectedDepthDesc, MotionDesc, RendererDesc, Result};

use crate::boundary::{RaraResult, Versioned, exclusive, guard, invalid, read, versioned, write};
use crate::depth::{self, RaraDepthDesc};
use crate::device::RaraDevice;
use crate::handles::alive;

/// How shaders reach buffers.
pub type RaraBindings = u32;
/// Buffers are read by address, which is fast. The default.
pub const RARA_BINDINGS_ADDRESS: RaraBindings = 0;
/// Buffers are bound, so that the validation layer can watch them. Needs VK_KHR_push_descriptor; without it buffers are
/// reached by address.
pub const RARA_BINDINGS_BOUND: RaraBindings = 1;
/// The constants of the frame bound and all else by address, for CPU drivers, which compile it fastest: Mesa's lavapipe takes about
/// a third more time for a first frame's shaders by addresses alone and twice the time for bound buffers, and then draws as fast in
/// each way. Needs what the other two need; without either the other one takes its place.
pub const RARA_BINDINGS_MIXED: RaraBindings = 2;

/// The way that suits a device: RARA_BINDINGS_MIXED for CPU drivers that can bind, else RARA_BINDINGS_ADDRESS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_bindings_suiting(
    device: *const RaraDevice,
    bindings: *mut RaraBindings,
) -> RaraResult {
    guard(|| {
        let device = alive(device, "device")?;
        *exclusive(bindings, "bindings")? = match Bindings::suiting(&device.0) {
            Bindings::Address => RARA_BINDINGS_ADDRESS,
            Bindings::Bound => RARA_BINDINGS_BOUND,
            Bindings::Mixed => RARA_BINDINGS_MIXED,
        };
        Ok(())
    })
}

/// The encoding of the colours in the colour attachment.
pub type RaraColorSpace = u32;
/// The attachment has colours as a display stores them (sRGB-encoded), as splats are trained. Splats are blended over its
/// pixels without a conversion. The default.
pub const RARA_COLOR_SPACE_STORED: RaraColorSpace = 0;
/// The attachment has linear light, as in a host that lights in HDR. Splats are blended as stored; the resulting picture is
/// converted to linear light once and blended over the host's pixels. Only tiles do so: another raster is refused, and so is a
/// depth that is not readable.
pub const RARA_COLOR_SPACE_LINEAR: RaraColorSpace = 1;

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
    /// True to take timestamps, for the times in RaraFrameStats and for rara_renderer_pass_spans. Default: false.
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
    /// The encoding of the colours in the colour attachment.
    pub color_space: RaraColorSpace,
    /// True to count also what the stages do, for rara_renderer_pass_statistics: with timing, and where RaraAdoptDesc has
    /// pipeline_statistics. No query of the host's for such statistics is active around the recorded calls then. Default: false.
    pub statistics: vk::Bool32,
    /// Format of the target of rara_renderer_draw_motion, two float channels or more; VK_FORMAT_UNDEFINED, the default, if that
    /// function is not called. The third is for the layer's number, which 16 bits hold exactly up to 2048.
    pub motion_format: vk::Format,
    /// The alpha, from 0 to 1, from which a pixel of splats gets their motion. Default: 0.5.
    pub motion_least_alpha: f32,
    /// Like render_pass, for that target.
    pub motion_render_pass: vk::RenderPass,
    /// The subpass of motion_render_pass to draw in.
    pub motion_subpass: u32,
    /// The queue family of the command buffers that rara_renderer_prepare records into, where they are submitted to another
    /// queue than the draws, as one without graphics: one of `shared_families` of RaraAdoptDesc, or the device's own. The host
    /// then orders the two by semaphores, as RaraRenderer says. Default: VK_QUEUE_FAMILY_IGNORED, where both are submitted to
    /// the device's queue.
    pub compute_family: u32,
    /// The view mask of the scopes that are drawn into, `VkRenderingInfo::viewMask` or that of the subpasses, where the device has
    /// the feature `multiview` enabled. Only tiles draw so. Default: 0, for scopes without one.
    pub view_mask: u32,
    /// The view of that mask that is drawn into, as an eye's into its layer of the images; the others are left alone.
    pub view: u32,
}

versioned!(RaraRendererDesc);

impl RaraRendererDesc {
    fn new(color_format: vk::Format) -> Self {
        Self {
            color_format,
            samples: vk::SampleCountFlags::TYPE_1,
            frames_in_flight: 1,
            motion_least_alpha: MotionDesc::new(color_format).least_alpha,
            compute_family: vk::QUEUE_FAMILY_IGNORED,
            ..Versioned::BLANK
        }
    }
}

/// # Safety
/// As for [`Target::render_pass`], unless it is null.
unsafe fn target(desc: &RaraRendererDesc, render_pass: vk::RenderPass, subpass: u32) -> Target {
    let target = match render_pass == vk::RenderPass::null() {
        true => Target::DYNAMIC,
        false => Target::render_pass(render_pass, subpass),
    };
    target.in_view(desc.view_mask, desc.view)
}

/// # Safety
/// `desc` is null or points to one, whose depth is null or points to one, and whose render pass is as its field says.
pub(crate) unsafe fn renderer_desc(desc: *const RaraRendererDesc) -> Result<RendererDesc> {
    let default = RaraRendererDesc::new(vk::Format::UNDEFINED);
    let desc = read(desc, default, "desc")?;
    if desc.color_format == vk::Format::UNDEFINED {
        return invalid("desc->color_format is VK_FORMAT_UNDEFINED");
    }
    if desc.frames_in_flight == 0 {
        return invalid("desc->frames_in_flight is 0: a renderer needs at least one");
    }
    let depth = if desc.depth.is_null() {
        None
    } else {
        Some(depth::depth_desc(desc.depth)?)
    };
    let expects_depth = desc.expected_depth_format != vk::Format::UNDEFINED;
    let expected_depth = expects_depth.then(|| {
        let (pass, subpass) = (desc.expected_depth_render_pass, desc.expected_depth_subpass);
        let target = target(&desc, pass, subpass);
        ExpectedDepthDesc::new(desc.expected_depth_format).target(target)
    });
    let draws_motion = desc.motion_format != vk::Format::UNDEFINED;
    let motion = draws_motion.then(|| {
        let target = target(&desc, desc.motion_render_pass, desc.motion_subpass);
        let motion = MotionDesc::new(desc.motion_format).target(target);
        motion.least_alpha(desc.motion_least_alpha)
    });
    let bindings = match desc.bindings {
        RARA_BINDINGS_ADDRESS => Bindings::Address,
        RARA_BINDINGS_BOUND => Bindings::Bound,
        RARA_BINDINGS_MIXED => Bindings::Mixed,
        other => return invalid(format!("desc->bindings {other} is no RaraBindings")),
    };
    let color_space = match desc.color_space {
        RARA_COLOR_SPACE_STORED => ColorSpace::Stored,
        RARA_COLOR_SPACE_LINEAR => ColorSpace::Linear,
        other => return invalid(format!("desc->color_space {other} is no RaraColorSpace")),
    };
    let target = target(&desc, desc.render_pass, desc.subpass);
    let is_elsewhere = desc.compute_family != vk::QUEUE_FAMILY_IGNORED;
    let compute_family = is_elsewhere.then_some(desc.compute_family);
    Ok(RendererDesc::new(desc.color_format)
        .color_space(color_space)
        .depth(depth)
        .samples(desc.samples)
        .expected_depth(expected_depth)
        .motion(motion)
        .target(target)
        .bindings(bindings)
        .timing(desc.timing != 0)
        .statistics(desc.statistics != 0)
        .reuse(desc.reuse != 0)
        .frames_in_flight(desc.frames_in_flight)
        .compute_family(compute_family))
}

/// One colour attachment of one sample in dynamic rendering, no timestamps, no statistics, no reuse, one frame in flight.
/// `desc_size` is sizeof *desc.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_desc_default(
    desc: *mut RaraRendererDesc,
    desc_size: usize,
    color_format: vk::Format,
) -> RaraResult {
    let default = RaraRendererDesc::new(color_format);
    guard(|| write(desc, desc_size, &default, "desc"))
}
