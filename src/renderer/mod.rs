//! The renderer an engine embeds: it records into the host's command buffer and never submits or waits.
//! `tools/examples/embed.rs` is a whole host.

use ash::vk;

use crate::camera::Camera;
use crate::clip::Clip;
use crate::error::{Error, Result};
use crate::gpu::{
    Bindings, Buffer, BufferDesc, Device, Drawer, Location, Recorder, Support, Timer,
};
use crate::limits;
use crate::passes::{
    self, Buffers, Context, Kept, PairRoom, Plan, SceneBuffers, SceneFacts, Stages, Work,
};
use crate::settings::{Raster, Settings};
use crate::types::FrameCounts;

mod tell;

/// What a renderer is created with: [`RendererDesc::new`] for the usual, fields changed where a host wants otherwise.
#[derive(Debug, Clone, Copy)]
pub struct RendererDesc {
    /// Format of the colour attachment that [`Renderer::draw`] draws into. It must be blendable; splats are trained to
    /// be blended as stored, so sRGB formats, which blend in linear light, give another picture.
    pub color_format: vk::Format,
    /// Whether buffers are reached by address (fast) or bound (the validation layer can watch them). With
    /// [`Bindings::Bound`] a frame whose buffers exceed the device's binding size still uses addresses.
    pub bindings: Bindings,
    /// Whether to take timestamps around the stages.
    pub timing: bool,
    /// Whether to count what the stages do, too, where the device was opened for it; only with `timing`.
    pub statistics: bool,
    /// Whether a frame takes over what the one before has computed and this one would compute again, to the same bytes.
    /// The host then submits every frame that it prepares, in order, or calls [`Renderer::forget`].
    pub reuse: bool,
    /// How many recorded frames may be unfinished at once, 1 or more; [`Renderer`] says what the host promises.
    pub frames_in_flight: u32,
}

impl RendererDesc {
    /// Buffers by address, no timestamps, nothing reused, one frame in flight.
    pub const fn new(color_format: vk::Format) -> Self {
        Self {
            color_format,
            bindings: Bindings::Address,
            timing: false,
            statistics: false,
            reuse: false,
            frames_in_flight: 1,
        }
    }
}

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
/// **What recording leaves behind.** `prepare` binds a compute pipeline, `draw` a graphics pipeline; both write push
/// constants and, with [`Bindings::Bound`], push descriptor set 0. The host binds its own again. Nothing else is touched:
/// no image, no layout, no dynamic state.
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    desc: RendererDesc,
    /// For addresses and for bound buffers; never replaced, so frames in flight keep their pipelines.
    stages: [Option<Stages>; 2],
    buffers: Option<Buffers>,
    /// What frames in flight may still use, with the number of frames prepared when it was replaced.
    retired: Vec<(u64, Buffers)>,
    /// One for each frame in flight.
    slots: Box<[Slot]>,
    /// Frames prepared so far.
    prepared: u64,
    plan: Option<Plan>,
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
        // The stages of a frame, with room for several draws.
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
    pub fn new(device: &Device, desc: RendererDesc) -> Result<Self> {
        assert!(
            desc.frames_in_flight > 0,
            "a renderer needs at least one frame in flight"
        );
        let wanted = vk::FormatFeatureFlags::COLOR_ATTACHMENT
            | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        if !device.format_features(desc.color_format).contains(wanted) {
            return Err(Error::Device(format!(
                "{} cannot blend into {:?}; every device can into R8G8B8A8_UNORM and R16G16B16A16_SFLOAT",
                device.info().name,
                desc.color_format
            )));
        }
        let slots =
            (0..desc.frames_in_flight).map(|_| Slot::new(device, desc.timing, desc.statistics));
        Ok(Self {
            device: device.clone(),
            desc,
            stages: [None, None],
            buffers: None,
            retired: Vec::new(),
            slots: slots.collect::<Result<_>>()?,
            prepared: 0,
            plan: None,
            kept: None,
            bindings: desc.bindings,
            pairs: PairRoom::default(),
            redraws: false,
            reason: "",
            ready: false,
        })
    }

    /// Changes the format of the attachment that the next [`configure`](Self::configure) is for.
    pub fn set_color_format(&mut self, format: vk::Format) {
        if self.desc.color_format != format {
            self.desc.color_format = format;
            self.plan = None; // what is configured would draw into the old one
        }
    }

    /// Forgets what earlier frames have computed: the next one computes everything. [`configure`](Self::configure) comes
    /// after it.
    pub fn forget(&mut self) {
        self.kept = None;
        // What is configured may count on it.
        self.plan = None;
        self.ready = false;
    }

    /// Decides what the next frame needs, and allocates and compiles what is missing. The camera's picture is the
    /// viewport of [`draw`](Self::draw). [`Settings::background`] is the host's business and ignored here.
    ///
    /// Where a frame needs more memory than the one before, old and new exist side by side while frames are in flight;
    /// with one frame in flight the old goes first. After an error nothing can be recorded until a call succeeds.
    pub fn configure(
        &mut self,
        scene: &SceneBuffers,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<()> {
        self.plan = None;
        self.ready = false;
        self.free_finished();
        let columns = camera.width.div_ceil(limits::TILE_WIDTH);
        let tiles = columns.saturating_mul(camera.height.div_ceil(limits::TILE_HEIGHT));
        let needed = self.frame_counts().map_or(0, |counts| counts.pairs);
        self.pairs.make(scene.count, tiles, needed);
        let support = self.device.support();
        let is_cpu = self.device.info().kind == vk::PhysicalDeviceType::CPU;
        let sort_runs = sort_runs(is_cpu, scene.count);
        let (raster, reason) = choose(settings.raster, support, is_cpu, tiles)?;
        self.reason = reason;
        let facts = SceneFacts {
            gaussians: scene.count,
            sh_degree: scene.sh_degree,
            sh_format: scene.sh_format,
            bounds: scene.bounds,
            sort_runs,
            raster,
            tile_rows: if is_cpu { limits::TILE_HEIGHT } else { 1 },
            pair_capacity: self.pairs.room(),
            redrawn: self.redraws,
        };
        let mut plan = Plan::new(facts, camera, clip, settings)?;
        let largest = Buffers::largest(&plan).max(scene.largest());
        self.bindings = match self.desc.bindings {
            Bindings::Bound
                if support.push_descriptor && largest <= support.max_storage_buffer_range =>
            {
                Bindings::Bound
            }
            Bindings::Bound | Bindings::Address => Bindings::Address,
        };
        if self
            .buffers
            .as_ref()
            .is_none_or(|buffers| !buffers.fit(&plan))
        {
            // Free first: both together may not fit.
            let outgrown = self.buffers.take();
            if let Some(kept) = &mut self.kept {
                kept.holds = false;
            }
            self.retired.extend(outgrown.map(|b| (self.prepared, b)));
            self.free_finished();
            match Buffers::new(&self.device, &plan) {
                Ok(buffers) => self.buffers = Some(buffers),
                Err(Error::Memory(_)) if plan.raster == Raster::Tiles => {
                    return self.configure_without_tiles(scene, camera, clip, settings);
                }
                Err(error) => return Err(error),
            }
        }
        plan.work = Kept::work(self.kept.as_ref(), scene.id, &plan);
        if let (Work::Sweep { .. }, Some(buffers)) = (plan.work, &mut self.buffers) {
            match buffers.ensure_sweep(&self.device) {
                Ok(()) => {}
                // A frame of its own needs less.
                Err(Error::Memory(_)) => {
                    self.kept = None;
                    plan.work = Kept::work(None, scene.id, &plan);
                }
                Err(error) => return Err(error),
            }
        }
        let context = Context {
            device: &self.device,
            bindings: self.bindings,
            color_format: self.desc.color_format,
        };
        let stages = &mut self.stages[self.bindings as usize];
        let stages = match stages {
            Some(stages) => stages,
            None => stages.insert(Stages::new(&context)?),
        };
        stages.ensure(&context, &plan)?;
        self.plan = Some(plan);
        Ok(())
    }

    /// The same frame as quads, on a device that has no memory for so many tiles and their lists.
    fn configure_without_tiles(
        &mut self,
        scene: &SceneBuffers,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<()> {
        self.pairs.refuse();
        let quads = Settings {
            raster: Raster::Quad,
            ..*settings
        };
        self.configure(scene, camera, clip, &quads)?;
        self.reason = "the device has no memory for the tiles' lists";
        Ok(())
    }

    /// Whether the configured frame's pixels are those of the last prepared one.
    pub(crate) fn changes_nothing(&self) -> bool {
        self.plan
            .as_ref()
            .is_some_and(|plan| plan.work == Work::Draw)
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

    /// Frees what only frames used that the host has waited for.
    fn free_finished(&mut self) {
        let finished = (self.prepared + 1).saturating_sub(self.slots.len() as u64);
        self.retired.retain(|(prepared, _)| *prepared > finished);
    }

    /// Records the stages up to the draw, outside any rendering scope.
    ///
    /// # Safety
    /// `cmd` is in the recording state, outside a rendering scope, on a queue family with compute and graphics, and
    /// will be submitted to the device's queue, or never. `scene` is the one given to [`configure`](Self::configure)
    /// and lives until the commands have executed. The host has waited for the frames that [`Renderer`] says.
    pub unsafe fn prepare(&mut self, cmd: vk::CommandBuffer, scene: &SceneBuffers) {
        let (Some(stages), Some(buffers), Some(plan)) = (
            &self.stages[self.bindings as usize],
            &self.buffers,
            &self.plan,
        ) else {
            panic!("Renderer::prepare needs a successful configure() before it");
        };
        assert!(
            plan.gaussians == scene.count
                && plan.sh_format == scene.sh_format
                && plan.data.sh_coefficients == (scene.sh_degree + 1).pow(2),
            "Renderer::prepare was given another scene than configure()"
        );
        let at = (self.prepared % self.slots.len() as u64) as usize;
        let slot = &mut self.slots[at];
        slot.empty = plan.gaussians == 0;
        self.prepared += 1;
        self.ready = true;
        if slot.empty {
            return;
        }
        // SAFETY: the caller promises that `cmd` is recording, outside a rendering scope.
        let mut recorder = unsafe { Recorder::begin(&self.device, cmd, slot.timer.as_mut()) };
        passes::record(&mut recorder, stages, scene, buffers, plan, &slot.counts);
        if plan.work != Work::Draw {
            let before = self.kept.take();
            self.kept = self.desc.reuse.then(|| Kept::after(before, scene.id, plan));
        }
    }

    /// Records the splats, or the picture that the tiles have made of them, inside the host's rendering scope, blended
    /// `over` what is there: premultiplied colours, one sample a pixel. `origin` is the viewport's upper left corner in the
    /// attachment, whole px; the viewport has the camera's size. May be recorded more than once for a prepared frame.
    ///
    /// # Safety
    /// `cmd` is inside a rendering scope whose only attachment is a colour one of the format given at creation, with one
    /// layer and no view mask; viewport and scissor are set; [`prepare`](Self::prepare) was recorded for the same frame
    /// before it.
    pub unsafe fn draw(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) {
        let (Some(stages), Some(buffers), Some(plan), true) = (
            &self.stages[self.bindings as usize],
            &self.buffers,
            &self.plan,
            self.ready,
        ) else {
            panic!("Renderer::draw needs a successful configure() and prepare() before it");
        };
        if plan.gaussians == 0 {
            return;
        }
        let at = ((self.prepared - 1) % self.slots.len() as u64) as usize;
        let timer = self.slots[at].timer.as_mut();
        let splat = stages.splat(plan, self.desc.color_format);
        let composite = stages.composite.get(&self.desc.color_format);
        let tiles = composite.zip(buffers.tiles.as_ref());
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, timer) };
        drawer.pass("splat", |drawer| {
            splat.record(drawer, buffers, plan, origin);
            if let Some((composite, t)) = tiles.filter(|_| plan.raster == Raster::Tiles) {
                composite.record(drawer, buffers, t, origin);
            }
        });
    }
}

/// How splats become pixels on a device, and why in that way.
fn choose(
    wanted: Raster,
    support: &Support,
    is_cpu: bool,
    tiles: u32,
) -> Result<(Raster, &'static str)> {
    Ok(match wanted {
        Raster::Auto if u64::from(tiles) * TILE_BYTES > MOST_PICTURE => {
            let reason = "the tiles' picture would take more than 1 GiB";
            (Raster::Quad, reason)
        }
        // See the README's measurements.
        Raster::Auto if is_cpu => (Raster::Tiles, "a CPU driver charges for each drawn splat"),
        Raster::Auto if support.mesh_shader => (Raster::Mesh, "a GPU with mesh shaders"),
        Raster::Auto => (Raster::Quad, "a GPU without mesh shaders"),
        Raster::Mesh if !support.mesh_shader => {
            return Err(Error::Device(
                "this device has no mesh shaders (VK_EXT_mesh_shader); use --raster quad".into(),
            ));
        }
        chosen => (chosen, "asked for"),
    })
}

/// What a tile's pixels take, and the most that a picture of them may: what every device can allocate at once.
const TILE_BYTES: u64 = (limits::TILE_WIDTH * limits::TILE_HEIGHT) as u64 * 16;
const MOST_PICTURE: u64 = 1 << 30;
/// Runs of the sort: each costs a histogram, so few where there is little to sort and on CPU drivers; but at least the
/// lanes of all cores there, and on GPUs enough invocations to hide the latency of their scattered writes.
fn sort_runs(is_cpu: bool, gaussians: u32) -> u32 {
    match (is_cpu, gaussians) {
        (true, ..32_768) => 128,
        (true, _) => 256,
        (false, _) => 2048,
    }
}
