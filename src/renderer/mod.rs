//! The renderer an engine embeds: it records into the host's command buffer and never submits or waits.
//! `tools/examples/embed.rs` is a whole host.

use std::sync::{Arc, Mutex};

use ash::vk;

use crate::depth::DepthMap;
use crate::error::{Error, Result};
use crate::gpu::{
    Bindings, Buffer, BufferDesc, DepthImage, Device, Drawer, Location, Recorder, Timer,
};
use crate::passes::{
    self, Buffers, Frame, Kept, PairRoom, Pipelines, Plan, SceneBuffers, Work, tiles,
};
use crate::placement::Placement;
use crate::types::FrameCounts;

mod configure;
mod desc;
#[cfg(test)]
mod faults;
mod tell;
#[cfg(test)]
mod tests;

pub use desc::{DepthDesc, ExpectedDepthDesc, RendererDesc};

/// Draws a scene into the host's rendering scope.
///
/// A frame is three calls: [`configure`](Self::configure) allocates and compiles what the frame needs and has not
/// been needed before; [`prepare`](Self::prepare) records the compute stages outside any rendering scope;
/// [`draw`](Self::draw) records the splats inside one. The host submits both in this order, to the device's queue.
///
/// **Frames in flight.** Before it configures frame `n`, the host has waited for frame `n - frames_in_flight` (each
/// `prepare` is a frame, also where two of them are views of one picture). Frames share their working memory: each
/// begins with a barrier behind everything earlier in the queue, so that none can overwrite what the one before still
/// reads. Memory that a frame outgrows is freed `frames_in_flight` frames later. Before dropping the renderer, the host
/// waits for all of its frames.
///
/// **Synchronisation.** What `prepare` records begins with a global barrier, from all draws, dispatches and copies that
/// are earlier in the queue to its own, and ends with one that makes what it wrote visible to the shaders and indirect
/// arguments of `draw` and, of the counts, to the host: the host needs none between the two, nor for the buffers of the
/// renderer and the scene at all. `draw` reads those in the vertex or mesh and the fragment stage; it reads and writes the
/// colour attachment (`COLOR_ATTACHMENT_OUTPUT`) and reads the depth attachment (`EARLY_FRAGMENT_TESTS`,
/// `LATE_FRAGMENT_TESTS`), whose layout may be read-only. For these the host waits as for any draw of its own. Of
/// [`prepare_behind`](Self::prepare_behind) see there.
///
/// **What recording leaves behind.** `prepare` binds a compute pipeline, `draw` a graphics pipeline; both write push
/// constants. The host binds its own pipelines again, pushes its own constants, and sets again what its pipelines have
/// of dynamic state, all but viewport and scissor: a pipeline of rara's has the rest of it fixed, which is what binding it
/// leaves behind. With [`Bindings::Bound`] both push descriptor set 0 too, by a layout of their own, so that the host
/// binds all of its sets again. No image, no layout, no query and no vertex buffer is touched. Of dynamic state `draw`
/// needs viewport and scissor: the viewport of positive height, its depths from 0 to 1.
///
/// **What lives how long.** The scene's buffers, and the image of `prepare_behind`, until the frame has executed; a
/// render pass of [`RendererDesc::target`] until no renderer that shares pipelines with this one is left; a host's device
/// and instance longer than all.
///
/// **Errors while recording.** [`prepare`](Self::prepare) and the draws return [`Error::Invalid`] where calls come in an
/// order that makes no sense; then nothing was recorded. They neither submit nor wait, take no lock, and allocate nothing
/// once a frame like it has been recorded.
///
/// **Several views.** Views one after the other, each with a scope of its own (`prepare`, `draw`, `prepare`, `draw`), need
/// one renderer, whose memory they share; each counts as a frame in flight. Views in one scope need a renderer each:
/// [`sharing`](Self::sharing) makes one that compiles nothing twice. Scenes are shared in any case.
///
/// **Several scenes.** Each is prepared and drawn for itself, where [`set_placement`](Self::set_placement) puts it, by a
/// renderer of its own: one that goes from scene to scene gets its working memory anew where their sizes differ. They are
/// composited in the order in which they are drawn, the farthest first: where scenes reach into each other the last one
/// drawn is before all of the others. What has to be right there is one scene:
/// [`Gaussians::append`](crate::Gaussians::append).
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    /// As the configured frame has it, and as the next one will.
    desc: RendererDesc,
    next_desc: RendererDesc,
    /// Where the scene stands in the world of camera, clip and depths; of the next frame too.
    placement: Placement,
    next_placement: Placement,
    shared: SharedPipelines,
    /// What of the shared pipelines this renderer has seen, so that recording takes no lock.
    pipelines: [Option<Arc<Pipelines>>; 2],
    buffers: Option<Buffers>,
    /// What frames in flight may still use, with the number of frames prepared when it was replaced.
    retired: Vec<(u64, Buffers)>,
    /// One for each frame in flight.
    slots: Box<[Slot]>,
    /// Frames prepared so far.
    prepared: u64,
    plan: Option<Plan>,
    /// The configured scene's number.
    scene: u64,
    /// What the last prepared frame has left in the buffers.
    kept: Option<Kept>,
    bindings: Bindings,
    pairs: PairRoom,
    /// Whether a frame without room for its pairs is drawn once more, instead of as quads.
    redraws: bool,
    /// Why the configured frame's rasteriser was chosen.
    reason: &'static str,
    /// Whether the configured frame has been prepared.
    ready: bool,
}

/// For addresses and for bound buffers. Only `configure` locks them, and only where something is missing; it puts more
/// pipelines in and takes none out, so that frames in flight keep theirs.
type SharedPipelines = Arc<Mutex<[Option<Arc<Pipelines>>; 2]>>;

/// What a frame tells about itself, kept until its slot's next frame.
#[derive(Debug)]
struct Slot {
    timer: Option<Timer>,
    counts: Buffer,
    /// There was nothing to record, so that nothing was counted.
    empty: bool,
}

impl Slot {
    fn new(device: &Device, timing: bool, statistics: bool) -> Result<Self> {
        let mut counts = device.create_buffer(&BufferDesc {
            name: "counts_readback",
            size: size_of::<FrameCounts>() as u64,
            location: Location::Readback,
        })?;
        // The stages of a frame, with room for several draws; what comes beyond has no times.
        let timer = || match (Timer::new(device, 16), statistics) {
            (Ok(timer), true) => timer.with_statistics(),
            (timer, _) => timer,
        };
        counts.mapped_mut().fill(0); // what a frame that is never submitted would tell
        Ok(Self {
            timer: timing.then(timer).transpose()?,
            counts,
            empty: true,
        })
    }
}

impl Renderer {
    /// A renderer on a device. Pipelines and buffers come with the first frame that needs them.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) where the device cannot draw into such attachments, and
    /// [`Error::Invalid`](crate::Error::Invalid) where there can be none such.
    pub fn new(device: &Device, desc: RendererDesc) -> Result<Self> {
        Self::with(device, desc, SharedPipelines::default())
    }

    /// Another renderer on the same device that shares this one's compiled pipelines: one for each view that is drawn in the
    /// same scope. Working memory is its own.
    ///
    /// # Errors
    /// As of [`new`](Self::new).
    pub fn sharing(&self, desc: RendererDesc) -> Result<Self> {
        Self::with(&self.device, desc, self.shared.clone())
    }

    fn with(device: &Device, desc: RendererDesc, shared: SharedPipelines) -> Result<Self> {
        desc.check(device)?;
        let slots =
            (0..desc.frames_in_flight).map(|_| Slot::new(device, desc.timing, desc.statistics));
        Ok(Self {
            device: device.clone(),
            desc,
            next_desc: desc,
            placement: Placement::IDENTITY,
            next_placement: Placement::IDENTITY,
            shared,
            pipelines: [None, None],
            buffers: None,
            retired: Vec::new(),
            slots: slots.collect::<Result<_>>()?,
            prepared: 0,
            plan: None,
            scene: 0,
            kept: None,
            bindings: desc.bindings,
            pairs: PairRoom::default(),
            redraws: false,
            reason: "",
            ready: false,
        })
    }

    /// Where the scene stands in the world, from the next [`configure`](Self::configure) on: camera, clip, the depth map
    /// and expected depths are the world's. Without it, where it was made.
    pub fn set_placement(&mut self, placement: Placement) {
        self.next_placement = placement;
    }

    /// Changes what the host's depth buffer holds for a depth, from the next [`configure`](Self::configure) on: where its
    /// near and far planes move.
    ///
    /// # Errors
    /// [`Error::Invalid`] without [`RendererDesc::depth`].
    pub fn set_depth_map(&mut self, map: DepthMap) -> Result<()> {
        match &mut self.next_desc.depth {
            Some(depth) => depth.map = map,
            None => {
                return out_of_order("set_depth_map needs a depth attachment in its RendererDesc");
            }
        }
        Ok(())
    }

    /// Changes the format of the attachment that the next [`configure`](Self::configure) is for.
    pub fn set_color_format(&mut self, format: vk::Format) {
        self.next_desc.color_format = format;
    }

    /// Forgets what earlier frames have computed: the next one computes everything. [`configure`](Self::configure) comes
    /// after it.
    pub fn forget(&mut self) {
        self.kept = None;
        // What is configured may count on it.
        self.plan = None;
        self.ready = false;
    }

    /// Whether the configured frame's pixels are those of the last prepared one.
    pub(crate) fn changes_nothing(&self) -> bool {
        self.plan
            .as_ref()
            .is_some_and(|plan| plan.work == Work::Draw || plan.gaussians() == 0)
    }

    /// As on a device with room for so few pairs of tile and splat.
    #[cfg(test)]
    pub(crate) fn limit_pairs(&mut self, most: u32) {
        self.pairs = PairRoom::limited(most);
    }

    /// What view and clip have said of each block.
    #[cfg(test)]
    pub(crate) fn block_sides(&self) -> Vec<u32> {
        let buffers = self.buffers.as_ref().expect("a frame was drawn");
        let bytes = self
            .device
            .download(&buffers.block_sides)
            .expect("reads back");
        bytemuck::pod_collect_to_vec(&bytes)
    }

    /// Pairs of tile and splat that the configured frame has room for.
    pub(crate) fn pair_room(&self) -> u32 {
        self.pairs.room()
    }

    /// Whether whoever submits draws a frame without room for its pairs once more: then nothing is drawn of it, which
    /// spares the quads. For the next [`configure`](Self::configure) on.
    pub(crate) fn set_redraws(&mut self, redraws: bool) {
        self.redraws = redraws;
    }

    /// Records the stages up to the draw, outside any rendering scope.
    ///
    /// # Safety
    /// `cmd` is in the recording state, outside a rendering scope, on a queue family with compute and graphics, and
    /// will be submitted to the device's queue, or never. `scene` is the one given to [`configure`](Self::configure)
    /// and lives until the commands have executed. The host has waited for the frames that [`Renderer`] says.
    ///
    /// # Errors
    /// [`Error::Invalid`] without a successful [`configure`](Self::configure) before it, with another scene, and where
    /// [`DepthDesc::readable`] promises the host's depth. Nothing is recorded then.
    pub unsafe fn prepare(&mut self, cmd: vk::CommandBuffer, scene: &SceneBuffers) -> Result<()> {
        if self.desc.depth.is_some_and(|depth| depth.readable) {
            return out_of_order("prepare was promised the host's depth: prepare_behind takes it");
        }
        // SAFETY: the caller's promises are those asked for.
        unsafe { self.prepare_with(cmd, scene, None) }
    }

    /// As [`prepare`](Self::prepare), for a renderer whose [`DepthDesc::readable`] says so: with what the host has drawn
    /// already, so that tiles leave out the splats behind it. The same picture as that of quads, which test each sample
    /// against the attachment itself. Tiles of such a frame are computed anew even where [`RendererDesc::reuse`] is set.
    ///
    /// The part of the image under the viewport is copied, at `COPY` by `TRANSFER_READ`: the host's barrier before makes
    /// its depths visible to that, its barrier after waits for it before the image changes layout or contents.
    ///
    /// # Safety
    /// As for [`prepare`](Self::prepare); and `depth` is as its description says, visible to the copy, and lives until
    /// the commands have executed.
    ///
    /// # Errors
    /// As of [`prepare`](Self::prepare), and where [`DepthDesc::readable`] is not set.
    pub unsafe fn prepare_behind(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: &DepthImage,
    ) -> Result<()> {
        if !self.desc.depth.is_some_and(|depth| depth.readable) {
            return out_of_order("prepare_behind needs DepthDesc::readable");
        }
        // SAFETY: the caller's promises are those asked for.
        unsafe { self.prepare_with(cmd, scene, Some(depth)) }
    }

    /// # Safety
    /// As for [`prepare`](Self::prepare) or, with `depth`, [`prepare_behind`](Self::prepare_behind).
    unsafe fn prepare_with(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: Option<&DepthImage>,
    ) -> Result<()> {
        let (Some(pipelines), Some(buffers), Some(plan)) = (
            &self.pipelines[self.bindings as usize],
            &self.buffers,
            &self.plan,
        ) else {
            return out_of_order("prepare needs a successful configure() before it");
        };
        if self.scene != scene.id {
            return out_of_order("prepare was given another scene than configure()");
        }
        let at = (self.prepared % self.slots.len() as u64) as usize;
        let slot = &mut self.slots[at];
        slot.empty = plan.gaussians() == 0;
        self.prepared += 1;
        self.ready = true;
        if slot.empty {
            return Ok(());
        }
        // SAFETY: the caller promises that `cmd` is recording, outside a rendering scope.
        let mut recorder = unsafe { Recorder::begin(&self.device, cmd, slot.timer.as_mut()) };
        let occluders = depth.zip(plan.occluders).zip(buffers.tiles.as_ref()).map(
            |((depth, occluders), tiles)| {
                // SAFETY: the caller promises the image, its layout and that its depths are visible.
                unsafe { recorder.copy_depth(depth, &tiles.occluders, occluders.size) }
            },
        );
        let copied = occluders.unwrap_or_default();
        let frame = Frame {
            plan,
            pipelines,
            scene,
            buffers,
            copied,
        };
        passes::record(&frame, &mut recorder, &slot.counts);
        if plan.work != Work::Draw {
            let before = self.kept.take();
            let keeps = self.desc.reuse && plan.occluders.is_none();
            self.kept = keeps.then(|| Kept::after(before, scene.id, plan));
        }
        Ok(())
    }

    /// Records the splats, or the picture that the tiles have made of them, inside the host's rendering scope, blended
    /// `over` what is there: premultiplied colours, the same for all samples of a pixel. `origin` is the viewport's upper left corner in the
    /// attachment, whole px; the viewport has the camera's size. May be recorded more than once for a prepared frame.
    ///
    /// # Safety
    /// `cmd` is inside a rendering scope with the attachments of the [`RendererDesc`] and no others, one layer and no view
    /// mask; viewport and scissor are set; [`prepare`](Self::prepare) was recorded for the same frame before it.
    ///
    /// # Errors
    /// [`Error::Invalid`] without a prepared frame; nothing is recorded then.
    pub unsafe fn draw(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) -> Result<()> {
        let (Some(pipelines), Some(buffers), Some(plan), true) = (
            &self.pipelines[self.bindings as usize],
            &self.buffers,
            &self.plan,
            self.ready,
        ) else {
            return out_of_order("draw needs a successful configure() and prepare() before it");
        };
        if plan.gaussians() == 0 {
            return Ok(());
        }
        let at = ((self.prepared - 1) % self.slots.len() as u64) as usize;
        let map = self.depth_map();
        let timer = self.slots[at].timer.as_mut();
        let attachments = self.desc.attachments();
        let tiled = buffers.tiles.as_ref().filter(|_| plan.is_tiled());
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, timer) };
        drawer.pass("splat", |drawer| {
            let frame = (plan, buffers);
            passes::splat::record(drawer, pipelines, frame, attachments, origin, map);
            if let Some(t) = tiled {
                tiles::record_composite(drawer, pipelines, (buffers, t), attachments, origin);
            }
        });
        Ok(())
    }

    /// Records the splats' depths inside a rendering scope of their own, with the attachments of
    /// [`RendererDesc::expected_depth`] and, if there is one, the same depth attachment: blended `over` what is there,
    /// red is the sum of the depths, each times what its splat adds to the pixel's alpha, green that alpha. Where the host
    /// has cleared both to 0, red / green is the pixel's expected depth along the view axis, world units; further
    /// scenes over it keep that meaning. A splat's depth in a pixel is the mean of what the clip leaves of the Gaussian on
    /// the pixel's line of sight, to first order of perspective; of several planes the strictest that keeps the far side
    /// counts, and the strictest that keeps the near one. Drawn as quads however the colours are. `origin` as of
    /// [`draw`](Self::draw).
    ///
    /// # Safety
    /// As of [`draw`](Self::draw), in such a scope.
    ///
    /// # Errors
    /// [`Error::Invalid`] without a prepared frame, and without [`RendererDesc::expected_depth`].
    pub unsafe fn draw_depth(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) -> Result<()> {
        let Some(attachments) = self.desc.expected_depth() else {
            return out_of_order("draw_depth needs RendererDesc::expected_depth");
        };
        let (Some(pipelines), Some(buffers), Some(plan), true) = (
            &self.pipelines[self.bindings as usize],
            &self.buffers,
            &self.plan,
            self.ready,
        ) else {
            return out_of_order(
                "draw_depth needs a successful configure() and prepare() before it",
            );
        };
        let Some(depths) = buffers.depth.as_ref().filter(|_| plan.gaussians() > 0) else {
            return Ok(());
        };
        let (map, unit) = (self.depth_map(), self.placement.scale());
        let at = ((self.prepared - 1) % self.slots.len() as u64) as usize;
        let timer = self.slots[at].timer.as_mut();
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, timer) };
        drawer.pass("splat_depth", |drawer| {
            let frame = (plan, buffers, depths);
            let map = (map, unit);
            passes::depth::record_draw(drawer, pipelines, frame, attachments, origin, map);
        });
        Ok(())
    }

    /// What the host's depth buffer holds for a depth in the scene's units.
    fn depth_map(&self) -> Option<DepthMap> {
        let depth = self.desc.depth?;
        Some(depth.map.in_scene(&self.placement))
    }
}

fn out_of_order<T>(what: &str) -> Result<T> {
    Err(Error::Invalid(format!("Renderer::{what}")))
}
