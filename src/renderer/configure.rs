//! Decides, allocates and compiles what a frame needs, before anything is recorded.

use std::sync::Arc;

use ash::vk;

use super::choose;
use super::desc::{ColorSpace, DepthDesc};
use super::frame::{FrameCut, FrameState};
use super::frames::Decision;
use super::request::{FrameRequest, Kept};
use super::{ConfiguredFrame, Renderer, out_of_order};
use crate::passes::{
    CutPlan, EyeFacts, EyePlan, Occluders, PreviousFrame, SceneBuffers, Shapes, Sight, Sizes,
    SplatColours, Targets, TilePixels, TileWork, Work,
};
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::Bindings;
use rara_scene::camera::Camera;
use rara_scene::depth::DepthMap;
use rara_scene::settings::{Raster, Settings};

impl Renderer {
    /// Decides what a frame needs, and allocates and compiles the missing parts. The camera's picture is the
    /// viewport that [`draw`](Self::draw) sets. [`Settings::background`] is the host's business and ignored here.
    ///
    /// A frame that is given a clip cuts the scene for itself. One that is given a [`Cut`](super::Cut) of the scene shows
    /// that, and its [`prepare`](Self::prepare) comes after [`Cut::prepare`](super::Cut::prepare).
    ///
    /// Where a frame needs more memory than the one before, old and new exist side by side while frames are in flight, or as
    /// long as the host holds a frame that needs the old; else the old goes first.
    ///
    /// # Errors
    /// [`Error::Invalid`] for what no frame can show, [`Error::Memory`] and [`Error::Budget`] where there is no room for it,
    /// and [`Error::Device`] where the driver fails. [`Error::Invalid`] also for a cut that is not configured or is another
    /// scene's, and for a cut with a camera that has near or far planes, which would cut as well.
    pub fn configure<'a>(
        &mut self,
        scene: &'a SceneBuffers,
        camera: &'a Camera,
        kept: impl Into<Kept<'a>>,
        settings: &'a Settings,
    ) -> Result<ConfiguredFrame> {
        let kept = kept.into();
        self.configure_frame(&FrameRequest::in_flight(scene, camera, kept, settings))
    }

    /// As [`configure`](Self::configure), for a frame that is submitted as the request says.
    pub(crate) fn configure_frame(
        &mut self,
        request: &FrameRequest<'_>,
    ) -> Result<ConfiguredFrame> {
        let mut decision = self.decide_with_memory(request)?;
        self.take_over(request.kept, decision.scene, &mut decision.plan)?;
        let (targets, plan) = (decision.targets, &decision.plan);
        let buffers = self.memory.buffers().clone();
        let (cut, awaits) = match request.kept {
            Kept::Clip(_) => (FrameCut::Own(self.cut.memory.buffers().clone()), None),
            Kept::Cut(cut) => {
                let cut = cut.configured_with(request.scene)?;
                (FrameCut::Seen(cut.seen.clone()), Some(cut.awaited.clone()))
            }
        };
        // An earlier frame may have made the buffers larger than this one needs.
        let of_cut = cut.buffers().sizes().largest();
        let largest = buffers.sizes().largest().max(of_cut);
        let bindings = self.bindings_of(largest.max(request.scene.largest()))?;
        let needs = |need: &mut dyn FnMut(_)| plan.pipelines(targets, need);
        decision.is_first_use = self.pipelines.ensure(&self.device, bindings, &needs)?;
        let shapes = self.desc.motion.map(|_| Shapes::new(request.scene));
        let frame = ConfiguredFrame {
            state: FrameState {
                shapes,
                decision,
                cut,
                buffers,
                pipelines: self.pipelines.get(bindings).clone(),
                renderer: self.id,
            },
            prepared: self.frames.prepared(),
            pending: self.pending.clone(),
            _awaits: awaits,
        };
        self.note_frame(&frame);
        Ok(frame)
    }

    /// True when [`configure`](Self::configure) would have to compile shaders for such a frame, which may take seconds, so that a
    /// host can say so before.
    ///
    /// # Errors
    /// The errors of [`configure`](Self::configure), but those of memory.
    pub fn compiles<'a>(
        &mut self,
        scene: &'a SceneBuffers,
        camera: &'a Camera,
        kept: impl Into<Kept<'a>>,
        settings: &'a Settings,
    ) -> Result<bool> {
        let request = &FrameRequest::in_flight(scene, camera, kept.into(), settings);
        let mut plan = self.decide(request)?.plan;
        if self.memory.fits(&plan) && self.cut.memory.fits(&plan.cut) {
            self.take_over(request.kept, request.scene.id, &mut plan)?;
        }
        let held = self.memory.allocated().map(|held| held.sizes().largest());
        let of_cut = self.cut.memory.allocated();
        let held = held.max(of_cut.map(|held| held.sizes().largest()));
        let needed = largest(&plan).max(held.unwrap_or(0));
        let bindings = self.bindings_of(needed.max(request.scene.largest()))?;
        let targets = self.targets(request.draws_linear());
        let needs = |need: &mut dyn FnMut(_)| plan.pipelines(targets, need);
        Ok(!self.pipelines.has_all(bindings, &needs))
    }

    /// Decides what a frame computes. It has no memory yet, so that it takes nothing over.
    fn decide(&mut self, request: &FrameRequest<'_>) -> Result<Decision> {
        let request = &FrameRequest {
            camera: &request.camera.in_scene(&self.placement),
            ..*request
        };
        request.scene.check(&self.device)?;
        // Of a cut the layers are as they were when it was configured.
        let scene = match request.kept {
            Kept::Clip(_) => request.scene,
            Kept::Cut(cut) => &cut.configured_with(request.scene)?.scene,
        };
        let finished = self.frames.finished(request.submission);
        self.memory.free_finished(finished);
        self.cut.memory.free_finished(finished);
        let tiles = tiles_of(request.camera.width, request.camera.height);
        let targets = self.targets(request.draws_linear());
        self.make_room(request, tiles);
        let (raster, reason) = self.choose_raster(request.settings, tiles, &targets)?;
        let leaves_picture = raster == Raster::Tiles && scene.count > 0;
        let picture = request
            .picture
            .filter(|_| leaves_picture)
            .and_then(TilePixels::from_target);
        let depth_map = self.depth_map();
        if let Some(map) = &depth_map {
            map.check(request.camera.projection)?;
        }
        let facts = scene.facts(self.device.shape());
        let eye = EyeFacts {
            picture,
            pair_capacity: self.pairs.room(),
            whole: request.whole,
            colours: request.colours,
            ..self.facts(scene.count, raster, depth_map)
        };
        let (camera, settings) = (request.camera, request.settings);
        let cut = match request.kept {
            Kept::Clip(clip) => {
                let clip = clip.in_scene(&self.placement);
                CutPlan::new(facts, Some(camera), &clip, settings)?
            }
            Kept::Cut(_) if camera.clips() => {
                return out_of_order(
                    "configure was given a cut and a camera whose near or far plane cuts too: put the planes into the clip of \
                     the cut, or give the renderer the clip",
                );
            }
            Kept::Cut(cut) => cut.configured_with(request.scene)?.plan.clone(),
        };
        Ok(Decision {
            scene: scene.id,
            sight: self.desc.motion.map(|_| Sight::new(scene, camera, &cut)),
            plan: EyePlan::new(facts, cut, eye, camera, settings)?,
            reason,
            targets,
            depth_map,
            unit: self.placement.scale(),
            is_first_use: false,
        })
    }

    /// Decides what a frame computes, and makes the memory for it. Where the device has none for its lists of tiles, it
    /// has shorter ones.
    fn decide_with_memory(&mut self, request: &FrameRequest<'_>) -> Result<Decision> {
        loop {
            let decision = self.decide(request)?;
            let Err(error) = self.make_memory(request, &decision.plan) else {
                return Ok(decision);
            };
            let budget = self.device.memory_budget();
            self.pairs.retry(error, budget, decision.plan.is_tiled())?;
        }
    }

    /// Makes the memory of a plan where it does not fit into what there is.
    fn make_memory(&mut self, request: &FrameRequest<'_>, plan: &EyePlan) -> Result<()> {
        let frames = (
            self.frames.prepared(),
            self.frames.finished(request.submission),
        );
        let owns_cut = matches!(request.kept, Kept::Clip(_));
        let of_cut = (owns_cut && !self.cut.memory.fits(&plan.cut)).then(|| Sizes::new(&plan.cut));
        let of_eye = (!self.memory.fits(plan)).then(|| Sizes::new(plan));
        match (&of_cut, &of_eye) {
            (None, None) => Ok(()),
            _ => self.grow(plan, of_cut, of_eye, frames),
        }
    }

    /// Makes room for cuts and frames of these sizes. Where the budget has none for both, the buffers are as they were.
    pub(super) fn grow(
        &mut self,
        plan: &EyePlan,
        of_cut: Option<Sizes<CutPlan>>,
        of_eye: Option<Sizes<EyePlan>>,
        frames: (u64, u64),
    ) -> Result<()> {
        let cut = of_cut
            .as_ref()
            .map_or([0; 2], |sizes| self.cut.memory.change(sizes, frames));
        let eye = of_eye
            .as_ref()
            .map_or([0; 2], |sizes| self.memory.change(sizes, frames));
        let [missing, goes] = [0, 1].map(|at| cut[at] + eye[at]);
        self.device
            .check_budget("a frame's working memory", missing, goes)?;
        if let Some(sizes) = of_cut {
            self.cut.found = None;
            let cut = (&plan.cut, sizes);
            self.cut.memory.reserve(&self.device, cut, frames)?;
        }
        if let Some(sizes) = of_eye {
            if let Some(previous) = &mut self.previous {
                previous.holds = false;
            }
            self.memory.reserve(&self.device, (plan, sizes), frames)?;
        }
        Ok(())
    }

    /// How splats become pixels in a picture of so many tiles, and why in that way.
    pub(super) fn choose_raster(
        &self,
        settings: &Settings,
        tiles: u32,
        targets: &Targets,
    ) -> Result<(Raster, &'static str)> {
        let targets = choose::Targets {
            tiles,
            hidden: self.desc.hides_from_tiles(),
            beside: self.draws_beside(),
            converted: targets.convert(settings.show),
            multisampled: self.desc.samples != vk::SampleCountFlags::TYPE_1,
        };
        let device = &self.device;
        choose::raster(settings, device.support(), device.shape(), targets)
    }

    /// True when only tiles draw what the host gets beside colours and expected depths, or where it gets them.
    fn draws_beside(&self) -> bool {
        let depth = self.desc.depth;
        let finds_depth = |depth: DepthDesc| depth.write_alpha.is_some() || depth.soft;
        let is_view = self.desc.target.view().is_some();
        self.desc.motion.is_some() || depth.is_some_and(finds_depth) || is_view
    }

    /// The map from a depth in the scene's units to the host's depth buffer.
    pub(super) fn depth_map(&self) -> Option<DepthMap> {
        let depth = self.desc.depth?;
        Some(depth.map.in_scene(&self.placement))
    }

    /// The targets of frames whose splats are drawn in linear light, or as stored.
    pub(super) fn targets(&self, draws_linear: bool) -> Targets {
        Targets {
            colour: self.desc.attachments(),
            expected_depth: self.desc.expected_depth_attachments(),
            motion: self.desc.motion_attachments(),
            linear: self.desc.color_space == ColorSpace::Linear,
            draws_linear,
        }
    }

    /// The arguments of an eye's plan for so many Gaussians, as far as they follow from device and description.
    pub(super) fn facts<'a>(
        &self,
        gaussians: u32,
        raster: Raster,
        depth_map: Option<DepthMap>,
    ) -> EyeFacts<'a> {
        let shape = self.device.shape();
        let readable = self.desc.depth.filter(|depth| depth.readable);
        EyeFacts {
            sort_runs: choose::runs(shape, gaussians),
            span_runs: choose::runs(shape, gaussians),
            raster,
            tile_work: TileWork::suiting(shape, self.device.support().subgroup_size),
            picture: None,
            pair_capacity: 0,
            occluders: readable.zip(depth_map).map(|(depth, map)| Occluders {
                soft: depth.soft,
                sampled: depth.sampled,
                ..Occluders::new(depth.format, map)
            }),
            expects_depth: self.desc.expected_depth.is_some(),
            write_alpha: readable.and_then(|depth| depth.write_alpha),
            draws_motion: self.desc.motion.is_some(),
            whole: None,
            colours: SplatColours::Scene,
        }
    }

    /// Makes room for as many pairs of tile and splat as the frame before has shown to be needed, and as this one is expected
    /// to have.
    fn make_room(&mut self, request: &FrameRequest<'_>, tiles: u32) {
        let needed = self.frames.awaited_pairs(request.submission);
        self.pairs.review(self.device.memory_budget());
        self.pairs.make(request.scene.count, tiles, needed);
        let has_lists = matches!(request.settings.raster, Raster::Auto | Raster::Tiles);
        if has_lists && !self.pairs.is_fixed() {
            let whole = request.whole.unwrap_or(request.camera);
            let expected = self.estimate.update(request.scene, request.camera, whole);
            self.pairs.expect(expected);
        }
    }

    /// Finds the part of a plan that has to be computed after the frame before it.
    fn take_over(&mut self, kept: Kept<'_>, scene: u64, plan: &mut EyePlan) -> Result<()> {
        // A frame that is yet to be prepared leaves other results.
        let is_next = Arc::strong_count(&self.pending) == 1;
        let finds_sides = plan.cut.clips() && !(is_next && self.cut.has_found(scene, &plan.cut));
        // The host's depth may change with each frame.
        let previous = self.previous.as_ref();
        let previous = previous.filter(|_| is_next && plan.occluders.is_none());
        plan.work = PreviousFrame::work(previous, scene, plan);
        if matches!(kept, Kept::Cut(_)) {
            // What other eyes see too does not move over one of them.
            plan.cut.finds_sides = false;
            if matches!(plan.work, Work::Reclip { .. }) {
                plan.work = Work::Whole;
            }
            return Ok(());
        }
        if matches!(plan.work, Work::Reclip { .. }) {
            let prepared = self.frames.prepared();
            match self.memory.extend(&self.device, plan, prepared) {
                Ok(()) => {}
                // A whole frame needs less memory than a reclipped one.
                Err(Error::Memory(_) | Error::Budget(_)) => {
                    self.previous = None;
                    plan.work = Work::Whole;
                }
                Err(error) => return Err(error),
            }
        }
        plan.cut.finds_sides = finds_sides && plan.work == Work::Whole;
        Ok(())
    }

    /// How buffers are reached, the largest of which has so many bytes.
    pub(super) fn bindings_of(&self, largest: u64) -> Result<Bindings> {
        choose::bindings(self.device.support(), self.desc.bindings, largest)
    }
}

/// The largest buffer of a plan, bytes.
fn largest(plan: &EyePlan) -> u64 {
    let [of_eye, of_cut] = [Sizes::new(plan).largest(), Sizes::new(&plan.cut).largest()];
    of_eye.max(of_cut)
}

pub(super) fn tiles_of(width: u32, height: u32) -> u32 {
    let columns = width.div_ceil(limits::TILE_WIDTH);
    columns.saturating_mul(height.div_ceil(limits::TILE_HEIGHT))
}
