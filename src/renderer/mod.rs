//! The renderer an engine embeds: it records into the host's command buffer and never submits or waits.
//! `tools/examples/embed.rs` is a whole host.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ash::vk;

use crate::passes::{EyePlan, PreviousFrame, Sight};
use crate::stats::RasterChoice;
use rara_base::error::{Error, Result};
use rara_gpu::Device;
use rara_scene::depth::DepthMap;
use rara_scene::placement::Placement;

mod choose;
mod configure;
mod cut;
mod desc;
mod editor;
mod estimate;
mod frame;
mod frames;
mod limits;
mod memory;
mod notes;
mod outcome;
mod pair_room;
mod pick;
mod record;
mod request;
mod reserve;
mod shared;
mod stats;
#[cfg(test)]
mod tests;
mod working;

pub use cut::Cut;
pub use desc::{ColorSpace, DepthDesc, ExpectedDepthDesc, MotionDesc, RendererDesc};
pub use editor::LayerEditor;
pub use frame::{ConfiguredFrame, PreparedFrame};
pub(crate) use frames::RecordedFrame;
pub use limits::FrameLimits;
pub use outcome::Outcome;
pub(crate) use outcome::Submission;
pub use pick::{Pick, PickTicket, Picker, Picks};
pub(crate) use request::FrameRequest;
pub use request::Kept;

use cut::CutState;
use estimate::PairEstimate;
use frames::FramesInFlight;
use memory::Memory;
use pair_room::PairRoom;
use shared::SharedPipelines;

/// Draws a scene into the host's rendering scope.
///
/// A frame is three calls: [`configure`](Self::configure) allocates and compiles what the frame needs and has not
/// been needed before, and returns the frame; [`prepare`](Self::prepare) takes it and records the compute stages outside any
/// rendering scope; [`draw`](Self::draw) records the splats inside one. The host submits both in this order, to the device's
/// queue.
///
/// **Frames in flight.** Before it configures frame `n`, the host has waited for frame `n - frames_in_flight` (each
/// `prepare` is a frame, also where two of them are views of one picture). Frames share their working memory: each
/// begins with a barrier behind what earlier ones may still do, so that none can overwrite what the one before still
/// reads. Memory that a frame outgrows is freed `frames_in_flight` frames later. Before dropping the renderer, the host
/// waits for all of its frames, or gives it to [`Device::drop_after`].
///
/// **Frames that overlap.** A frame is recorded with what it was configured with, whatever is configured in between: a host
/// may configure the next frame while it records this one. Frames are prepared in the order in which they are configured. One
/// that is configured while another waits to be prepared takes nothing over from it, whatever [`RendererDesc::reuse`] says.
/// Where the next frame is configured before this one's slot is free, `frames_in_flight` is one more than the host's slots.
///
/// **Synchronisation.** The commands of `prepare` begin with a global barrier, from all dispatches and copies that are
/// earlier in the queue to its own. It names the shader stages of draws too, the host's own ones included, where one of this
/// renderer's may be unfinished: with one frame in flight it never does. They end with one that makes what they wrote visible to the shaders and indirect
/// arguments of `draw`, and the counts to the host. The host needs no barrier between the two, and none at all for the
/// buffers of the renderer and the scene. `draw` reads those in the vertex or mesh and the fragment stage; it reads and
/// writes the colour attachment (`COLOR_ATTACHMENT_OUTPUT`) and reads the depth attachment (`EARLY_FRAGMENT_TESTS`,
/// `LATE_FRAGMENT_TESTS`), whose layout may be read-only. For these the host waits as for any draw of its own.
/// [`prepare`](Self::prepare) says what the host's depth needs.
///
/// **Two queues.** With [`RendererDesc::compute_family`] the commands of `prepare`, and those of a [`Cut`], a [`Picker`] and a
/// [`LayerEditor`] of the renderer, go to a queue of that family, and the draws to the device's. No barrier names the stages
/// of a draw then, and the host submits with semaphores: the draws wait for their frame's `prepare`, at `DRAW_INDIRECT` and
/// the shader stages of a draw, and `prepare` waits for the draws of the frame before, at `COMPUTE_SHADER`, `DRAW_INDIRECT` and
/// `ALL_TRANSFER`; `ALL_COMMANDS` is right for both. Two renderers that take turns need no more than their own frames'.
///
/// **What recording leaves behind.** `prepare` binds a compute pipeline, `draw` a graphics pipeline; both write push
/// constants. `draw` sets the viewport. The host binds its own pipelines again, pushes its own constants, and sets all
/// dynamic state of its pipelines again but the scissor: binding a pipeline of rara's, in which the rest is fixed,
/// undoes it. Except with [`Bindings::Address`](crate::gpu::Bindings::Address) both push descriptor set 0 too, by a layout
/// of their own, so that the host binds all of its sets again. No image, no layout, no query and no vertex buffer is touched. Of
/// the host's dynamic state `draw` reads one thing, the scissor, which `vkCmdSetScissor` sets and
/// `vkCmdSetScissorWithCount` does not. The host's viewport may be any, upside down or not yet set.
///
/// **What lives how long.** The scene's buffers, and the image of the host's depth, live until the frame has executed; a
/// render pass of [`RendererDesc::target`] until no renderer that shares pipelines with this one is left; a host's device
/// and instance longer than all.
///
/// **Errors while recording.** [`prepare`](Self::prepare) and the draws return [`Error::Invalid`] for frames of another
/// renderer or in another order; then nothing was recorded. They neither submit nor wait, take no lock, and allocate nothing
/// once a frame like it has been recorded.
///
/// **Several views.** Views one after the other, each with a scope of its own (`prepare`, `draw`, `prepare`, `draw`), need
/// one renderer, whose memory they share; each counts as a frame in flight. Views in one scope need a renderer each:
/// [`sharing`](Self::sharing) makes one that compiles nothing twice. Scenes are shared in any case.
///
/// **Several scenes.** Each is prepared and drawn for itself, where [`set_placement`](Self::set_placement) puts it, by a
/// renderer of its own: one that goes from scene to scene allocates its working memory anew where their sizes differ. They
/// are composited in the order in which they are drawn, the farthest first: where scenes reach into each other the last one
/// drawn is before all of the others. Where that has to be right, draw one scene of several [layers](crate::Scene).
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    /// The description that it was created from, with the changes for the next frame.
    desc: RendererDesc,
    /// The placement of the next frame's scene in the world of camera, clip and depths.
    placement: Placement,
    pipelines: SharedPipelines,
    /// The cut of frames that are configured without one.
    cut: CutState,
    memory: Memory<EyePlan>,
    pairs: PairRoom,
    estimate: PairEstimate,
    frames: FramesInFlight,
    /// The results that the last prepared frame has left in the memory.
    previous: Option<PreviousFrame>,
    /// No other renderer of this process has it.
    id: u64,
    /// Shared with the frames that are configured and not prepared, as long as nothing is forgotten.
    pending: Arc<()>,
    /// Where the layers of the last prepared frame have the camera, where motion is drawn.
    seen: Option<Sight>,
    /// The label around its commands; none without one.
    name: Option<Box<str>>,
    /// How splats become pixels, as the log was told last.
    noted: RasterChoice,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(0);

impl Renderer {
    /// A renderer on a device. Pipelines and buffers come with the first frame that needs them.
    ///
    /// # Errors
    /// [`Error::Device`] where the device cannot draw into such attachments, and
    /// [`Error::Invalid`] where such attachments cannot exist.
    pub fn new(device: &Device, desc: RendererDesc) -> Result<Self> {
        Self::with(device, desc, SharedPipelines::default())
    }

    /// Another renderer on the same device that shares this one's compiled pipelines: one for each view that is drawn in the
    /// same scope. Working memory is its own.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn sharing(&self, desc: RendererDesc) -> Result<Self> {
        Self::with(&self.device, desc, self.pipelines.sharing())
    }

    /// Another renderer that draws expected depths too, into attachments of this format, shares this one's pipelines and has
    /// its placement.
    pub(crate) fn with_expected_depth(&self, format: vk::Format) -> Result<Self> {
        self.alike(RendererDesc {
            expected_depth: Some(ExpectedDepthDesc::new(format)),
            motion: None,
            timing: false,
            statistics: false,
            reuse: false,
            ..self.desc
        })
    }

    /// Another renderer for pictures of this format alone, which shares this one's pipelines and has its placement.
    pub(crate) fn beside(&self, format: vk::Format) -> Result<Self> {
        self.alike(RendererDesc {
            bindings: self.desc.bindings,
            reuse: true,
            ..RendererDesc::new(format)
        })
    }

    /// Another renderer for what this one draws, where it draws it.
    fn alike(&self, desc: RendererDesc) -> Result<Self> {
        let mut made = self.sharing(desc)?;
        made.placement = self.placement;
        Ok(made)
    }

    pub(crate) fn device(&self) -> &Device {
        &self.device
    }

    fn with(device: &Device, desc: RendererDesc, pipelines: SharedPipelines) -> Result<Self> {
        desc.check(device)?;
        let taken = desc.bindings.or_other(device.support());
        if taken != desc.bindings {
            log::info!(
                "buffers are reached by Bindings::{taken:?}: the device lacks what Bindings::{:?} needs",
                desc.bindings
            );
        }
        let frames =
            FramesInFlight::new(device, desc.frames_in_flight, desc.timing, desc.statistics)?;
        Ok(Self {
            device: device.clone(),
            desc,
            placement: Placement::IDENTITY,
            pipelines,
            cut: CutState::default(),
            memory: Memory::default(),
            pairs: PairRoom::default(),
            estimate: PairEstimate::default(),
            frames,
            previous: None,
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            pending: Arc::default(),
            seen: None,
            name: None,
            noted: RasterChoice::default(),
        })
    }

    /// Places the scene in the world, from the next [`configure`](Self::configure) on: camera, clip, the depth map and
    /// expected depths are the world's. A layer's own clip stands in the scene and is not: give it what
    /// [`Clip::in_scene`](crate::Clip::in_scene) makes of one in the world. Without a call, the scene's space is the world.
    pub fn set_placement(&mut self, placement: Placement) {
        self.placement = placement;
    }

    /// Names the renderer: its commands are under a debug label of that name, as far as 63 bytes go, which tells the eyes of a
    /// frame apart. An empty name takes the label away.
    pub fn set_name(&mut self, name: &str) {
        self.name = (!name.is_empty()).then(|| name.into());
    }

    /// Changes what the host's depth buffer holds for a depth, from the next [`configure`](Self::configure) on, for hosts
    /// whose near and far planes move.
    ///
    /// # Errors
    /// [`Error::Invalid`] without [`RendererDesc::depth`].
    pub fn set_depth_map(&mut self, map: DepthMap) -> Result<()> {
        match &mut self.desc.depth {
            Some(depth) => depth.map = map,
            None => {
                return out_of_order(
                    "set_depth_map needs a depth attachment: set RendererDesc::depth",
                );
            }
        }
        Ok(())
    }

    /// Changes the format of the attachment that the next [`configure`](Self::configure) is for.
    pub fn set_color_format(&mut self, format: vk::Format) {
        self.desc.color_format = format;
    }

    /// Changes the meaning of the numbers of the attachment that the next [`configure`](Self::configure) is for.
    pub(crate) fn set_color_space(&mut self, space: ColorSpace) {
        self.desc.color_space = space;
    }

    /// Forgets what earlier frames have computed: the next one computes everything. [`configure`](Self::configure) comes
    /// after it.
    pub fn forget(&mut self) {
        self.previous = None;
        self.cut.found = None;
        self.seen = None;
        self.pending = Arc::default(); // frames that are configured may count on it
    }

    /// Forgets the frame that was prepared last and never submitted, and what it would have computed.
    pub(crate) fn abandon(&mut self) {
        if let Some(newest) = self.frames.newest_mut() {
            newest.decision = None;
        }
        self.forget();
    }

    /// Leaves room for only so many pairs of tile and splat, as on a small device.
    #[cfg(test)]
    pub(crate) fn limit_pairs(&mut self, most: u32) {
        self.pairs = PairRoom::limited(most);
    }

    /// The sides that view and clip have found for each block.
    #[cfg(test)]
    pub(crate) fn block_sides(&self) -> Vec<u32> {
        let sides = self
            .working_buffer("block_sides")
            .expect("a frame was configured");
        bytemuck::pod_collect_to_vec(&sides)
    }
}

fn out_of_order<T>(what: &str) -> Result<T> {
    Err(Error::Invalid(format!("Renderer::{what}")))
}
