//! A cut is what a clip keeps of a scene. It has memory of its own.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ash::vk;

use super::choose;
use super::memory::Memory;
use super::shared::SharedPipelines;
use super::{Renderer, out_of_order};
use crate::passes::{
    self, Buffers, CutPlan, CutResources, FoundSides, Pipelines, SceneBuffers, Sizes,
};
use rara_base::error::{Error, Result};
use rara_gpu::{Bindings, Device, Draws, Recorder};
use rara_scene::clip::Clip;
use rara_scene::placement::Placement;
use rara_scene::settings::Settings;

/// A cut is what a clip keeps of a scene. It is found once for any number of eyes: [`Renderer`]s, each with a size, targets
/// and formats of its own, and [`Picker`](super::Picker)s.
///
/// [`configure`](Self::configure) says which clip cuts which scene, and [`prepare`](Self::prepare) records the commands that
/// find what is kept. From then on every renderer of the device may be given the cut in place of a clip, by
/// [`Renderer::configure`]. For a single view a clip is enough: the renderer then has a cut of its own.
///
/// ```no_run
/// # use rara::{Camera, Clip, Cut, Renderer, Result, SceneBuffers, Settings, ash::vk};
/// # fn frame(eyes: &mut [Renderer; 2], cut: &mut Cut, scene: &SceneBuffers, clip: &Clip, cameras: &[Camera; 2],
/// #     cmd: vk::CommandBuffer) -> Result<()> {
/// let settings = Settings::default();
/// cut.configure(scene, clip, &settings)?; // `cut` is made once, by Cut::new(&eyes[0])
/// // SAFETY: `cmd` is recording outside a rendering scope, and the host has waited for the frames that `Renderer` says.
/// unsafe { cut.prepare(cmd)? };
/// for (eye, camera) in eyes.iter_mut().zip(cameras) {
///     let frame = eye.configure(scene, camera, &*cut, &settings)?;
///     // SAFETY: the same.
///     let frame = unsafe { eye.prepare(cmd, scene, None, frame)? };
///     // ... a rendering scope of this eye's target begins ...
///     // SAFETY: inside that scope.
///     unsafe { eye.draw(cmd, [0.0, 0.0], &frame)? };
/// }
/// # Ok(())
/// # }
/// ```
///
/// **What belongs to the cut, and what to the eye.** The cut has [`Settings::mode`], [`Settings::trace_all`], where the mode
/// is `rara` also `sigma`, and the layers' own clips and states as they were when it was configured. The eye has all else, such
/// as how cut splats are weighted. A camera's own near and far planes ([`Camera::clip_near`](crate::Camera)) would cut as
/// well, so that the camera of an eye that is given a cut has none.
///
/// **Moving.** A cut that is configured as before and has been prepared costs nothing. One that has moved is found anew, and
/// each eye then computes a whole frame. A renderer's own cut costs less where the eye stands still
/// ([`RendererDesc::reuse`](super::RendererDesc)).
///
/// **What lives how long.** The commands of [`prepare`](Self::prepare) come before those of the eyes in the queue. Memory that
/// the cut has outgrown lives until `prepare` has recorded something as many more times as the renderer given to
/// [`new`](Self::new) has frames in flight, and as long as a frame that shows the cut may be unfinished. The cut itself lives
/// until its last commands have executed.
#[derive(Debug)]
pub struct Cut {
    device: Device,
    bindings: Bindings,
    draws: Draws,
    placement: Placement,
    pipelines: SharedPipelines,
    state: CutState,
    /// What it was configured with last, and before that what frames wait for that were configured earlier and are not prepared.
    configured: VecDeque<ConfiguredCut>,
    /// The version of the cut whose commands were recorded last; 0 before any.
    recorded: Arc<AtomicU64>,
    frames_in_flight: u64,
    /// How many times commands were recorded.
    prepared: u64,
}

/// A cut that can be recorded and seen.
#[derive(Debug)]
pub(crate) struct ConfiguredCut {
    pub(super) scene: SceneBuffers,
    pub(super) plan: CutPlan,
    pub(super) seen: SeenCut,
    pipelines: Arc<Pipelines>,
    /// Shared with the frames that show it and are not prepared.
    pub(super) awaited: Arc<()>,
}

/// What the frame of an eye holds of a host's cut.
#[derive(Debug, Clone)]
pub(super) struct SeenCut {
    pub(super) buffers: Arc<Buffers<CutPlan>>,
    version: u64,
    recorded: Arc<AtomicU64>,
}

impl SeenCut {
    /// True when the cut's memory holds what the frame is to show.
    pub(super) fn is_recorded(&self) -> bool {
        self.recorded.load(Ordering::Relaxed) == self.version
    }
}

impl Cut {
    /// A cut for a renderer and all others of its device. It shares the renderer's compiled pipelines, and has its
    /// [placement](Renderer::set_placement) of this moment.
    pub fn new(renderer: &Renderer) -> Self {
        Self {
            device: renderer.device.clone(),
            bindings: renderer.desc.bindings,
            draws: renderer.desc.draws(),
            placement: renderer.placement,
            pipelines: renderer.pipelines.sharing(),
            state: CutState::default(),
            configured: VecDeque::new(),
            recorded: Arc::default(),
            frames_in_flight: renderer.desc.frames_in_flight.into(),
            prepared: 0,
        }
    }

    /// Places the scene in the world, from the next [`configure`](Self::configure) on, as [`Renderer::set_placement`] does: the
    /// clip is the world's.
    pub fn set_placement(&mut self, placement: Placement) {
        self.placement = placement;
    }

    /// Decides what is cut, and allocates and compiles what that needs and has not been needed before. A frame that was
    /// configured before this call shows the cut as it was then, also where both are prepared after it.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a clip that cuts nothing finite and for a scene of another device, [`Error::Memory`] and
    /// [`Error::Budget`] where there is no room; the cut is then as it was.
    pub fn configure(
        &mut self,
        scene: &SceneBuffers,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<()> {
        scene.check(&self.device)?;
        let clip = clip.in_scene(&self.placement);
        let mut plan = CutPlan::new(scene.facts(self.device.shape()), None, &clip, settings)?;
        if let Some(had) = self.configured.back_mut()
            && had.scene.id == scene.id
            && had.plan.is_like(&plan)
        {
            had.scene = scene.clone(); // layers may stand elsewhere
            return Ok(());
        }
        let memory = &mut self.state.memory;
        let finished = self.prepared.saturating_sub(self.frames_in_flight);
        memory.free_finished(finished);
        if !memory.fits(&plan) {
            let (sizes, frames) = (Sizes::new(&plan), (self.prepared, finished));
            let [missing, goes] = memory.change(&sizes, frames);
            self.device.check_budget("a cut's memory", missing, goes)?;
            self.state.found = None;
            memory.reserve(&self.device, (&plan, sizes), frames)?;
        }
        self.drop_unawaited();
        // What is recorded before it leaves other sides.
        let is_next = self.configured.iter().all(|had| had.seen.is_recorded());
        plan.finds_sides &= !(is_next && self.state.has_found(scene.id, &plan));
        let buffers = self.state.memory.buffers().clone();
        let largest = buffers.sizes().largest().max(scene.largest());
        let bindings = choose::bindings(self.device.support(), self.bindings, largest)?;
        let needs = |need: &mut dyn FnMut(_)| plan.pipelines(need);
        self.pipelines.ensure(&self.device, bindings, &needs)?;
        let version = self.configured.back().map_or(0, |had| had.seen.version) + 1;
        let recorded = self.recorded.clone();
        self.configured.push_back(ConfiguredCut {
            scene: scene.clone(),
            plan,
            seen: SeenCut {
                buffers,
                version,
                recorded,
            },
            pipelines: self.pipelines.get(bindings).clone(),
            awaited: Arc::default(),
        });
        Ok(())
    }

    /// Records the commands that find what is kept, outside any rendering scope. As long as frames wait to be prepared that
    /// were configured before the cut was configured anew, they are those of the cut as it was for the oldest of these. Where
    /// they have been recorded already, this records nothing. They begin with the barrier of [`Renderer::prepare`], and the
    /// eyes' commands wait for them.
    ///
    /// # Safety
    /// `cmd` is in the recording state, outside a rendering scope, and will be submitted to the queue of the eyes' own commands
    /// of [`Renderer::prepare`], before those. The scene lives until the commands have executed. The host has waited for
    /// the frames that [`Renderer`] says.
    ///
    /// # Errors
    /// [`Error::Invalid`] before the cut is configured. Nothing is recorded then.
    pub unsafe fn prepare(&mut self, cmd: vk::CommandBuffer) -> Result<()> {
        self.drop_unawaited();
        let Some(configured) = self.configured.front() else {
            return Err(Error::Invalid(UNCONFIGURED.into()));
        };
        let ConfiguredCut {
            scene,
            plan,
            seen,
            pipelines,
            ..
        } = configured;
        if seen.is_recorded() {
            return Ok(());
        }
        if plan.gaussians() > 0 {
            // SAFETY: the caller promises that `cmd` is recording, outside a rendering scope.
            let mut recorder = unsafe { Recorder::begin(&self.device, cmd, self.draws, None) };
            let resources = CutResources {
                pipelines,
                scene,
                buffers: &seen.buffers,
            };
            passes::record_cut(plan, &mut recorder, resources);
            self.prepared += 1;
            let kept = (&seen.buffers, self.prepared);
            self.state.keep(scene.id, plan, kept);
        }
        self.recorded.store(seen.version, Ordering::Relaxed);
        Ok(())
    }

    /// Forgets what was recorded, as is needed after commands that were never submitted: the next
    /// [`prepare`](Self::prepare) records everything.
    pub fn forget(&mut self) {
        self.state.found = None;
        self.recorded.store(0, Ordering::Relaxed);
        for configured in &mut self.configured {
            configured.plan.finds_sides = configured.plan.clips();
        }
    }

    /// Forgets what was configured before and no frame waits for any more.
    fn drop_unawaited(&mut self) {
        while self.configured.len() > 1 && Arc::strong_count(&self.configured[0].awaited) == 1 {
            self.configured.pop_front();
        }
    }

    /// Bytes of device memory that the cut takes, including what frames in flight still use of it.
    pub fn bytes(&self) -> u64 {
        self.state.memory.bytes()
    }

    /// The cut as it was configured, if it is of this scene.
    pub(super) fn configured_with(&self, scene: &SceneBuffers) -> Result<&ConfiguredCut> {
        let Some(configured) = self.configured.back() else {
            return Err(Error::Invalid(UNCONFIGURED.into()));
        };
        match configured.scene.id == scene.id {
            true => Ok(configured),
            false => out_of_order("configure was given another scene than that of its cut"),
        }
    }
}

const UNCONFIGURED: &str = "this cut is not configured: Cut::configure says what is cut by what";

/// The memory of a cut, and what it holds.
#[derive(Debug, Default)]
pub(super) struct CutState {
    pub(super) memory: Memory<CutPlan>,
    /// The sides that recorded commands leave in the memory.
    pub(super) found: Option<FoundSides>,
}

impl CutState {
    /// Keeps what the commands of a plan leave in the buffers that it was recorded with, after so many prepared frames.
    pub(super) fn keep(
        &mut self,
        scene: u64,
        plan: &CutPlan,
        (buffers, prepared): (&Arc<Buffers<CutPlan>>, u64),
    ) {
        let is_replaced = self.memory.keep_replaced(buffers, prepared);
        if plan.finds_sides && !is_replaced {
            self.found = Some(FoundSides::of(scene, plan));
        }
    }

    /// True when the memory holds the sides of a plan.
    pub(super) fn has_found(&self, scene: u64, plan: &CutPlan) -> bool {
        let found = self.found.as_ref();
        found.is_some_and(|found| found.are_of(scene, plan))
    }
}
