//! Room for what will come, made before the first frame, and what is given back when it was not needed.

use glam::DVec3;

use super::choose;
use super::frame::FrameCut;
use super::frames::FramesInFlight;
use super::limits::FrameLimits;
use super::pair_room::PairRoom;
use super::{PreparedFrame, Renderer, configure};
use crate::passes::{
    CutPlan, EyeFacts, EyePlan, SceneBuffers, SceneFacts, SceneLayer, Sizes, Work,
};
use rara_base::error::Result;
use rara_base::limits;
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::settings::Settings;
use rara_scene::{Gaussians, Layer, Numbers};

impl Renderer {
    /// Compiles the pipelines and allocates the working memory of all frames within limits: none of them then compiles or
    /// allocates device memory, whatever their cameras, clips and modes, and whichever scenes they show. Attachments are
    /// those of the [`RendererDesc`](super::RendererDesc) and of
    /// [`set_color_format`](Self::set_color_format); `reuse` and `expected_depth` are reserved for where they are set.
    /// Frames beyond the limits are configured as without them, and what was reserved stays.
    ///
    /// It takes as long as the driver compiles: a fraction of a second to some seconds. It submits nothing, so that any
    /// thread may call it, as while a scene loads. Another renderer that [shares](Self::sharing) this one's pipelines may
    /// reserve for it while this one draws: their memory is each one's own. [`configure`](Self::configure) comes after it.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for limits that no frame can have,
    /// [`Error::Budget`](crate::Error::Budget) and [`Error::Memory`](crate::Error::Memory) where there is no room; of a
    /// budget's it is said before anything is allocated or compiled.
    pub fn reserve(&mut self, limits: &FrameLimits) -> Result<()> {
        limits.check()?;
        self.forget();
        let pairs = self.reserved_pairs(limits);
        let mut all: Option<(EyePlan, Sizes<EyePlan>, Sizes<CutPlan>)> = None;
        self.for_each_plan(limits, pairs, &mut |plan| {
            let mut of_eye = Sizes::new(plan);
            let held = all.as_ref().map(|(_, sizes, _)| sizes);
            if plan.is_tiled() && !held.is_some_and(|sizes| sizes.hold_tiles_of(&of_eye)) {
                of_eye = of_lower_pictures(plan)?;
            }
            let (of_eye, of_cut) = (of_eye.reserved(), Sizes::new(&plan.cut).reserved());
            all = Some(match all.take() {
                Some((first, eye, cut)) => (first, eye.or(&of_eye), cut.or(&of_cut)),
                None => (plan.clone(), of_eye, of_cut),
            });
            Ok(())
        })?;
        let Some((plan, of_eye, of_cut)) = all else {
            return Ok(());
        };
        let largest = of_eye.largest().max(of_cut.largest());
        // A thread of its own waits for nothing.
        let frames = (self.frames.prepared(), self.frames.finished_at_least());
        self.grow(&plan, Some(of_cut), Some(of_eye), frames)?;
        self.pairs = pairs;
        self.compile(limits, pairs, largest)
    }

    /// Gives back the working memory, also what was [reserved](Self::reserve), but for what a frame like `keep` needs: for
    /// that [`configure`](Self::configure) then allocates nothing. The host has waited for all of its frames, as before
    /// dropping the renderer; what a frame that it holds needs goes with that.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory) or [`Error::Budget`](crate::Error::Budget) where there is no memory for smaller
    /// buffers in place of the larger ones; there are none then, and the next [`configure`](Self::configure) allocates them.
    pub fn trim(&mut self, keep: Option<&PreparedFrame>) -> Result<()> {
        let plan = keep.map(|frame| frame.state.decision.plan.clone());
        self.previous = None;
        self.cut.found = None;
        let mut pairs = PairRoom::default();
        let plan = plan.map(|mut plan| {
            let needed = self.frames.newest().map_or(0, |frame| frame.pairs());
            pairs.make(
                plan.cut.data.scene.gaussian_count,
                plan.data.tiles.tile_count,
                needed,
            );
            if plan.is_tiled() {
                pairs.expect(self.estimate.last());
            }
            plan.data.room.pair_capacity = pairs.room();
            plan
        });
        self.pairs = pairs;
        self.frames.release_cuts();
        // A frame of a host's cut needs nothing of the renderer's own.
        let is_own = |keep: &PreparedFrame| matches!(keep.state.cut, FrameCut::Own(_));
        let of_cut = plan.as_ref().filter(|_| keep.is_some_and(is_own));
        let device = &self.device;
        self.cut.memory.trim(device, of_cut.map(|plan| &plan.cut))?;
        self.memory.trim(device, plan.as_ref())
    }

    /// Bytes of device memory that its working memory takes, with what frames in flight still use. Buffers that frames in
    /// flight and the next one share count once. Scenes have their own ([`SceneBuffers::bytes`]), and
    /// [`Device::device_bytes`](crate::gpu::Device::device_bytes) is the sum of all.
    pub fn bytes(&self) -> u64 {
        self.cut.memory.bytes() + self.memory.bytes() + self.frames.bytes()
    }

    /// The room for pairs that limits ask for.
    fn reserved_pairs(&self, limits: &FrameLimits) -> PairRoom {
        if let Some(pairs) = limits.pairs {
            return PairRoom::fixed(pairs);
        }
        let had = self.pairs;
        let mut pairs = match had.is_fixed() {
            true => PairRoom::default(),
            false => had,
        };
        pairs.make(limits.gaussians, tiles(limits.size), 0);
        pairs
    }

    /// Compiles the pipelines of all frames within limits, whose largest buffer has so many bytes. The lock that renderers
    /// share is taken for one kind of frame at a time.
    fn compile(&mut self, limits: &FrameLimits, pairs: PairRoom, largest: u64) -> Result<()> {
        // A scene may be of either light.
        let targets = [false, true].map(|draws_linear| self.targets(draws_linear));
        let of_memory = self.bindings_of(largest)?;
        let scene = SceneBuffers::largest_of(limits.gaussians, limits.sh_format);
        let of_scene = self.bindings_of(largest.max(scene))?;
        let mut pipelines = std::mem::take(&mut self.pipelines);
        let compiled = self.for_each_plan(limits, pairs, &mut |plan| {
            for targets in targets {
                let needs = |need: &mut dyn FnMut(_)| plan.pipelines(targets, need);
                pipelines.ensure(&self.device, of_memory, &needs)?;
                pipelines.ensure(&self.device, of_scene, &needs)?;
            }
            Ok(())
        });
        self.pipelines = pipelines;
        compiled
    }

    /// Calls a function with a plan of each kind of frame within limits, the largest of its kind.
    fn for_each_plan(
        &self,
        limits: &FrameLimits,
        pairs: PairRoom,
        act: &mut dyn FnMut(&EyePlan) -> Result<()>,
    ) -> Result<()> {
        let nothing = Gaussians::default();
        let layer = SceneLayer::new(&Layer::new("", &nothing), 0, Numbers::of_whole(0));
        let layers = [layer.clone(), layer];
        let clips = limits.clips(self.device.shape())?;
        for settings in &limits.settings {
            for size in pictures(limits.size) {
                for clip in &clips {
                    for count in 1..=limits.layers.min(2) {
                        let layers = &layers[..count as usize];
                        let mut plan =
                            self.plan_of(limits, pairs, (layers, clip, settings, size))?;
                        act(&plan)?;
                        for work in self.further_work(&plan) {
                            plan.work = work;
                            act(&plan)?;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn plan_of(
        &self,
        limits: &FrameLimits,
        pairs: PairRoom,
        (layers, clip, settings, size): (&[SceneLayer], &Clip, &Settings, (u32, u32)),
    ) -> Result<EyePlan> {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 50.0, size)?;
        let (raster, _) = self.choose_raster(settings, tiles(size), &self.targets(false))?;
        let facts = SceneFacts {
            layers,
            gaussians: limits.gaussians,
            // Each layer begins with a block of its own.
            blocks: limits.gaussians.div_ceil(limits::BLOCK_SIZE) + limits.layers,
            reordered: true,
            sh_degree: 0,
            sh_format: limits.sh_format,
            shape: self.device.shape(),
        };
        let eye = EyeFacts {
            pair_capacity: pairs.room(),
            ..self.facts(limits.gaussians, raster, self.depth_map())
        };
        let mut cut = CutPlan::new(facts, None, clip, settings)?;
        cut.data.scene.layer_count = limits.layers;
        EyePlan::new(facts, cut, eye, &camera, settings)
    }

    /// The parts of a frame that may be computed in place of the whole.
    fn further_work(&self, plan: &EyePlan) -> Vec<Work> {
        if !self.desc.reuse || !plan.cut.clips() || plan.occluders.is_some() {
            return Vec::new();
        }
        let both = [true, false];
        let work = both
            .iter()
            .flat_map(|base| both.iter().map(|fresh| (*base, *fresh)));
        work.map(|(base, fresh)| Work::Reclip { base, fresh })
            .collect()
    }
}

/// The sizes of a plan and of the same for lower pictures, for which CPU drivers divide the rows into more parts.
fn of_lower_pictures(plan: &EyePlan) -> Result<Sizes<EyePlan>> {
    let [width, height] = plan.size().map(|side| side as u32);
    let mut sizes = Sizes::new(plan);
    for rows in 1..height.div_ceil(limits::TILE_HEIGHT) {
        let lower = plan.sized(width, rows * limits::TILE_HEIGHT);
        sizes = sizes.or(&Sizes::new(&lower));
    }
    Ok(sizes)
}

/// The pictures whose frames differ: the largest, the smallest, and where tiles do not take the largest, the widest and the
/// highest that they take.
fn pictures((width, height): (u32, u32)) -> Vec<(u32, u32)> {
    let mut pictures = vec![(width, height), (1, 1)];
    if tiles((width, height)) > choose::MOST_TILES {
        let [columns, rows] = [
            width.div_ceil(limits::TILE_WIDTH),
            height.div_ceil(limits::TILE_HEIGHT),
        ];
        let (low, narrow) = (choose::MOST_TILES / columns, choose::MOST_TILES / rows);
        pictures.push((width, low * limits::TILE_HEIGHT));
        pictures.push((narrow * limits::TILE_WIDTH, height));
    }
    pictures
}

fn tiles((width, height): (u32, u32)) -> u32 {
    configure::tiles_of(width, height)
}

impl FramesInFlight {
    fn bytes(&self) -> u64 {
        self.slots().iter().map(|slot| slot.counts.size()).sum()
    }
}
