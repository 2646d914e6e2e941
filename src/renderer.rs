//! The renderer an engine embeds: it records into the host's command buffer and never submits or waits.

use ash::vk;

use crate::camera::Camera;
use crate::clip::Clip;
use crate::error::{Error, Result};
use crate::gpu::{Bindings, Device, Drawer, Recorder, Timer};
use crate::passes::{self, Buffers, Context, Plan, SceneBuffers, SceneFacts, Stages};
use crate::settings::{Raster, Settings};
use crate::stats::{Counts, PassTime};
use crate::types::FrameCounts;

/// What a renderer is created with.
#[derive(Debug, Clone, Copy)]
pub struct RendererDesc {
    /// Format of the colour attachment that [`Renderer::draw`] draws into.
    pub color_format: vk::Format,
    /// Whether buffers are reached by address (fast) or bound (the validation layer can watch them). With
    /// [`Bindings::Bound`] a frame whose buffers exceed the device's binding size still uses addresses.
    pub bindings: Bindings,
    /// Whether to take timestamps around the stages.
    pub timing: bool,
}

/// Draws a scene into the host's rendering scope.
///
/// A frame is three calls: [`configure`](Self::configure) allocates and compiles what the frame needs and has not
/// been needed before; [`prepare`](Self::prepare) records the compute stages outside any rendering scope;
/// [`draw`](Self::draw) records the splats inside one. The host submits both in this order, to one queue, and may not
/// call `configure` while a frame recorded before is still executing.
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    desc: RendererDesc,
    stages: Option<(Bindings, Stages)>,
    buffers: Option<Buffers>,
    timer: Option<Timer>,
    plan: Option<Plan>,
    mesh: bool,
}

impl Renderer {
    /// A renderer on a device. Pipelines and buffers come with the first frame that needs them.
    pub fn new(device: &Device, desc: RendererDesc) -> Result<Self> {
        let timer = if desc.timing {
            Some(Timer::new(device, 16)?)
        } else {
            None
        };
        Ok(Self {
            device: device.clone(),
            desc,
            stages: None,
            buffers: None,
            timer,
            plan: None,
            mesh: false,
        })
    }

    /// Changes the format of the attachment that the next [`configure`](Self::configure) is for.
    pub fn set_color_format(&mut self, format: vk::Format) {
        if self.desc.color_format != format {
            self.desc.color_format = format;
            self.plan = None; // what is configured would draw into the old one
        }
    }

    /// Decides what the next frame needs, and allocates and compiles what is missing.
    pub fn configure(
        &mut self,
        scene: &SceneBuffers,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<()> {
        let support = self.device.support();
        let is_cpu = self.device.info().kind == vk::PhysicalDeviceType::CPU;
        let sort_runs = if is_cpu { SORT_RUNS_CPU } else { SORT_RUNS_GPU };
        let facts = SceneFacts {
            gaussians: scene.count,
            sh_degree: scene.sh_degree,
            sh_format: scene.sh_format,
            bounds: scene.bounds,
            sort_runs,
        };
        let plan = Plan::new(facts, camera, clip, settings)?;
        self.mesh = match settings.raster {
            // On CPU drivers a mesh shader costs several times a quad's vertices; see the README's measurements.
            Raster::Auto => support.mesh_shader && !is_cpu,
            Raster::Mesh if !support.mesh_shader => {
                return Err(Error::Device(
                    "this device has no mesh shaders (VK_EXT_mesh_shader); use --raster quad"
                        .into(),
                ));
            }
            Raster::Mesh => true,
            Raster::Quad => false,
        };
        let largest = Buffers::largest(&plan).max(scene.largest());
        let bindings = match self.desc.bindings {
            Bindings::Bound
                if support.push_descriptor && largest <= support.max_storage_buffer_range =>
            {
                Bindings::Bound
            }
            Bindings::Bound | Bindings::Address => Bindings::Address,
        };
        let context = Context {
            device: &self.device,
            bindings,
            color_format: self.desc.color_format,
        };
        if self
            .stages
            .as_ref()
            .is_none_or(|(have, _)| *have != bindings)
        {
            self.stages = Some((bindings, Stages::new(&context)?));
        }
        if let Some((_, stages)) = &mut self.stages {
            stages.ensure(&context, &plan, self.mesh)?;
        }
        if self
            .buffers
            .as_ref()
            .is_none_or(|buffers| !buffers.fit(&plan))
        {
            // Free first: both together may not fit.
            self.buffers = None;
            self.buffers = Some(Buffers::new(&self.device, &plan)?);
        }
        self.plan = Some(plan);
        Ok(())
    }

    /// Records the stages up to the draw, outside any rendering scope.
    ///
    /// # Safety
    /// `cmd` is in the recording state, outside a rendering scope, on a queue family with compute and graphics, and
    /// `scene` is the one given to [`configure`](Self::configure) and lives until the commands have executed.
    pub unsafe fn prepare(&mut self, cmd: vk::CommandBuffer, scene: &SceneBuffers) {
        let (Some((_, stages)), Some(buffers), Some(plan)) =
            (&self.stages, &self.buffers, &self.plan)
        else {
            panic!("Renderer::prepare needs a successful configure() before it");
        };
        if plan.gaussians == 0 {
            return;
        }
        // SAFETY: the caller promises that `cmd` is recording, outside a rendering scope.
        let mut recorder = unsafe { Recorder::begin(&self.device, cmd, self.timer.as_mut()) };
        passes::record(&mut recorder, stages, scene, buffers, plan);
    }

    /// Records the splats inside the host's rendering scope, blended `over` what is there. The viewport and scissor are
    /// the host's; `origin` is the viewport's upper left corner in the attachment, px.
    ///
    /// # Safety
    /// `cmd` is inside a rendering scope whose only colour attachment has the format given at creation, viewport and
    /// scissor are set, and [`prepare`](Self::prepare) was recorded for the same frame before it.
    pub unsafe fn draw(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) {
        let (Some((_, stages)), Some(buffers), Some(plan)) =
            (&self.stages, &self.buffers, &self.plan)
        else {
            panic!("Renderer::draw needs a successful configure() and prepare() before it");
        };
        if plan.gaussians == 0 {
            return;
        }
        let splat = stages.splat(plan, self.mesh, self.desc.color_format);
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, self.timer.as_mut()) };
        drawer.pass("splat", |drawer| {
            splat.record(drawer, buffers, plan.sorted(), origin);
        });
    }

    /// The stages that the configured frame does not need.
    pub fn skipped(&self) -> Vec<&'static str> {
        self.plan.as_ref().map(Plan::skipped).unwrap_or_default()
    }

    /// How many Gaussians ended where, once the frame has executed.
    pub fn counts(&self) -> Counts {
        let (Some(buffers), Some(plan)) = (&self.buffers, &self.plan) else {
            return Counts::default();
        };
        if plan.gaussians == 0 {
            return Counts::default();
        }
        let counts: FrameCounts = bytemuck::pod_read_unaligned(
            &buffers.counts_readback.mapped()[..size_of::<FrameCounts>()],
        );
        let FrameCounts {
            visible,
            cutoff,
            invisible,
            culled,
            ..
        } = counts;
        Counts {
            visible,
            cutoff,
            invisible,
            culled,
            drawn: visible + cutoff,
        }
    }

    /// GPU time of each stage, once the frame has executed; empty without timing.
    pub fn pass_times(&self) -> Vec<PassTime> {
        let times = self
            .timer
            .as_ref()
            .and_then(Timer::read)
            .unwrap_or_default();
        times
            .into_iter()
            .map(|(name, ms)| PassTime { name, ms })
            .collect()
    }
}

/// Runs of the sort on CPU drivers: few, because each costs a histogram; at least the lanes of all cores.
const SORT_RUNS_CPU: u32 = 256;
/// Runs of the sort on GPUs: enough invocations to hide the latency of their scattered writes.
const SORT_RUNS_GPU: u32 = 2048;
