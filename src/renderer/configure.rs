//! Decides, allocates and compiles what a frame needs, before anything is recorded.

use std::sync::Arc;

use ash::vk;

use super::choose;
use super::desc::ColorSpace;
use super::frame::FrameState;
use super::frames::{Decision, RecordedFrame};
use super::outcome::Submission;
use super::pair_room::Retry;
use super::request::FrameRequest;
use super::{ConfiguredFrame, Renderer};
use crate::passes::{
    Occluders, Plan, PreviousFrame, SceneBuffers, SceneFacts, SceneLayer, SplatColours, Targets,
    TilePixels, TileWork, Work,
};
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::Bindings;
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::depth::DepthMap;
use rara_scene::precision::ShFormat;
use rara_scene::settings::{Raster, Settings};

impl Renderer {
    /// Decides what a frame needs, and allocates and compiles the missing parts. The camera's picture is the
    /// viewport that [`draw`](Self::draw) sets. [`Settings::background`] is the host's business and ignored here.
    ///
    /// Where a frame needs more memory than the one before, old and new exist side by side while frames are in flight, or as
    /// long as the host holds a frame that needs the old; else the old goes first.
    ///
    /// # Errors
    /// [`Error::Invalid`] for what no frame can show, [`Error::Memory`] and [`Error::Budget`] where there is no room for it,
    /// and [`Error::Device`] where the driver fails.
    pub fn configure(
        &mut self,
        scene: &SceneBuffers,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<ConfiguredFrame> {
        self.configure_frame(&FrameRequest::in_flight(scene, camera, clip, settings))
    }

    /// As [`configure`](Self::configure), for a frame that is submitted as the request says.
    pub(crate) fn configure_frame(
        &mut self,
        request: &FrameRequest<'_>,
    ) -> Result<ConfiguredFrame> {
        let mut decision = self.decide_with_memory(request)?;
        let work = self.work(decision.scene, &decision.plan)?;
        decision.plan.work = work;
        let (targets, plan) = (decision.targets, &decision.plan);
        let buffers = self.memory.buffers().clone();
        // An earlier frame may have made the buffers larger than this one needs.
        let bindings = self.bindings_of(buffers.sizes().largest().max(request.scene.largest()));
        let pipelines = &mut self.pipelines;
        decision.is_first_use = pipelines.ensure(&self.device, bindings, targets, plan)?;
        let frame = ConfiguredFrame {
            state: FrameState {
                decision,
                buffers,
                pipelines: pipelines.get(bindings).clone(),
                renderer: self.id,
            },
            prepared: self.frames.prepared(),
            pending: self.pending.clone(),
        };
        self.note_frame(&frame);
        Ok(frame)
    }

    /// True when the frame of a request needs a pipeline that no renderer has made yet, which may take seconds.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    pub(crate) fn compiles(&mut self, request: &FrameRequest<'_>) -> Result<bool> {
        let mut plan = self.decide(request)?.plan;
        if self.memory.fits(&plan) {
            plan.work = self.work(request.scene.id, &plan)?;
        }
        let held = self.memory.allocated().map(|held| held.sizes().largest());
        let needed = plan.sizes().largest().max(held.unwrap_or(0));
        let bindings = self.bindings_of(needed.max(request.scene.largest()));
        let targets = self.targets(request.draws_linear());
        Ok(!self.pipelines.has_all(bindings, targets, &plan))
    }

    /// Decides what a frame computes. It has no memory yet, so that it takes nothing over.
    fn decide(&mut self, request: &FrameRequest<'_>) -> Result<Decision> {
        let request = &FrameRequest {
            camera: &request.camera.in_scene(&self.placement),
            clip: &request.clip.in_scene(&self.placement),
            ..*request
        };
        let scene = request.scene;
        if !scene.is_on(&self.device) {
            return Err(Error::Invalid(
                "the scene was uploaded to another device than the renderer's".into(),
            ));
        }
        self.memory
            .free_finished(self.frames.finished(request.submission));
        let tiles = tiles_of(request.camera.width, request.camera.height);
        // Where no quads can take the tiles' place, nothing does.
        let targets = self.targets(request.draws_linear());
        let needs_tiles = needs_tiles(request.settings, &targets);
        let redrawn = self.make_room(request, tiles) || needs_tiles;
        let (raster, reason) = self.choose_raster(request.settings, tiles, &targets)?;
        // Quads, which have to be drawn, take the tiles' place only in a frame that is not redrawn.
        let leaves_picture = raster == Raster::Tiles && redrawn && scene.count > 0;
        let picture = request
            .picture
            .filter(|_| leaves_picture)
            .and_then(TilePixels::from_target);
        let depth_map = self.depth_map();
        if let Some(map) = &depth_map {
            map.check(request.camera.projection)?;
        }
        let facts = SceneFacts {
            blocks: scene.block_count(),
            reordered: scene.reordered,
            sh_degree: scene.sh_degree,
            sh_format: scene.sh_format,
            picture,
            pair_capacity: self.memory.pairs.room(),
            redrawn,
            whole: request.whole,
            colours: request.colours,
            ..self.facts(scene.layers(), scene.count, raster, depth_map)
        };
        Ok(Decision {
            scene: scene.id,
            plan: Plan::new(facts, request.camera, request.clip, request.settings)?,
            reason,
            targets,
            depth_map,
            unit: self.placement.scale(),
            submission: request.submission,
            redrawn,
            needs_tiles,
            is_first_use: false,
        })
    }

    /// Decides what a frame computes, and makes the memory for it. Where the device has none for its lists of tiles, it
    /// has shorter ones or is drawn as quads.
    fn decide_with_memory(&mut self, request: &FrameRequest<'_>) -> Result<Decision> {
        let mut settings = *request.settings;
        loop {
            let mut decision = self.decide(&FrameRequest {
                settings: &settings,
                ..*request
            })?;
            if settings.raster != request.settings.raster {
                decision.reason = "the device has no memory for the tiles' lists";
            }
            let plan = &decision.plan;
            if self.memory.fits(plan) {
                return Ok(decision);
            }
            if let Some(previous) = &mut self.previous {
                previous.holds = false;
            }
            let frames = (
                self.frames.prepared(),
                self.frames.finished(request.submission),
            );
            let memory = &mut self.memory;
            let Err(error) = memory.replace(&self.device, plan, frames) else {
                return Ok(decision);
            };
            let (has_lists, can_be_quads) = (plan.is_tiled(), !decision.needs_tiles);
            let budget = self.device.memory_budget();
            match memory.pairs.retry(error, budget, has_lists, can_be_quads)? {
                Retry::Smaller => {}
                Retry::Quads => settings.raster = Raster::Quad,
            }
        }
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
            hidden: self.desc.depth.is_some_and(|depth| !depth.readable),
            converted: targets.convert(settings.show),
            multisampled: self.desc.samples != vk::SampleCountFlags::TYPE_1,
        };
        let device = &self.device;
        choose::raster(settings, device.support(), device.shape(), targets)
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
            linear: self.desc.color_space == ColorSpace::Linear,
            draws_linear,
        }
    }

    /// A plan's arguments for so many Gaussians of these layers, as far as they follow from device and description.
    pub(super) fn facts<'a>(
        &self,
        layers: &'a [SceneLayer],
        gaussians: u32,
        raster: Raster,
        depth_map: Option<DepthMap>,
    ) -> SceneFacts<'a> {
        let shape = self.device.shape();
        let readable = self.desc.depth.filter(|depth| depth.readable);
        SceneFacts {
            layers,
            gaussians,
            blocks: 0,
            reordered: true,
            sh_degree: 0,
            sh_format: ShFormat::default(),
            shape,
            sort_runs: choose::runs(shape, gaussians),
            span_runs: choose::runs(shape, gaussians),
            raster,
            tile_work: TileWork::suiting(shape, self.device.support().subgroup_size),
            picture: None,
            pair_capacity: 0,
            redrawn: false,
            occluders: readable
                .zip(depth_map)
                .map(|(depth, map)| Occluders::new(depth.format, map)),
            expects_depth: self.desc.expected_depth.is_some(),
            whole: None,
            colours: SplatColours::Scene,
        }
    }

    /// Makes room for as many pairs of tile and splat as the frame before has shown to be needed, and as this one is expected
    /// to have. Returns whether nothing is to be drawn of the next frame where that is not enough.
    fn make_room(&mut self, request: &FrameRequest<'_>, tiles: u32) -> bool {
        let undrawn = |frame: &RecordedFrame| {
            let redrawn = frame.decision.as_ref().is_some_and(|had| had.redrawn);
            redrawn && frame.fell_back()
        };
        if self.previous.is_some() && self.frames.newest().is_some_and(undrawn) {
            self.previous = None; // the frame before was not drawn
        }
        let (fell_back, needed) = self.frames.awaited(request.submission);
        let budget = self.device.memory_budget();
        let has_grown = self.memory.make_room(request, tiles, needed, budget);
        // Where no more room can be made, quads are drawn at once.
        request.submission == Submission::Awaited && (!fell_back || has_grown)
    }

    /// The part of a plan that has to be computed after the frame before it.
    fn work(&mut self, scene: u64, plan: &Plan) -> Result<Work> {
        // The host's depth may change with each frame, and a frame that is yet to be prepared leaves other results.
        let is_next = Arc::strong_count(&self.pending) == 1;
        let previous = self.previous.as_ref();
        let previous = previous.filter(|_| is_next && plan.occluders.is_none());
        let work = PreviousFrame::work(previous, scene, plan);
        if !matches!(work, Work::Reclip { .. }) {
            return Ok(work);
        }
        let reclipped = Plan {
            work,
            ..plan.clone()
        };
        let prepared = self.frames.prepared();
        match self.memory.extend(&self.device, &reclipped, prepared) {
            Ok(()) => Ok(work),
            // A whole frame needs less memory than a reclipped one.
            Err(Error::Memory(_) | Error::Budget(_)) => {
                self.previous = None;
                Ok(PreviousFrame::work(None, scene, plan))
            }
            Err(error) => Err(error),
        }
    }

    /// How buffers are reached: as wanted, unless the device cannot bind buffers as large as this one.
    pub(super) fn bindings_of(&self, largest: u64) -> Bindings {
        let support = self.device.support();
        let binds = support.push_descriptor && largest <= support.max_storage_buffer_range;
        match self.desc.bindings {
            Bindings::Bound if binds => Bindings::Bound,
            // The constants are small.
            Bindings::Mixed if support.push_descriptor => Bindings::Mixed,
            _ => Bindings::Address,
        }
    }
}

/// True where only tiles make what settings ask for, so that no quads can take their place.
pub(super) fn needs_tiles(settings: &Settings, targets: &Targets) -> bool {
    settings.show.needs_tiles() || targets.convert(settings.show)
}

pub(super) fn tiles_of(width: u32, height: u32) -> u32 {
    let columns = width.div_ceil(limits::TILE_WIDTH);
    columns.saturating_mul(height.div_ceil(limits::TILE_HEIGHT))
}
