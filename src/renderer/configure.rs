//! What a frame needs, decided, allocated and compiled before anything is recorded.

use std::sync::{Arc, PoisonError};

use ash::vk;

use super::Renderer;
use crate::camera::Camera;
use crate::clip::Clip;
use crate::error::{Error, Result};
use crate::gpu::{Bindings, Support};
use crate::limits;
use crate::passes::{
    Buffers, Kept, Occluders, Pipelines, Plan, SceneBuffers, SceneFacts, Targets, TileWork, Work,
};
use crate::placement::Placement;
use crate::settings::{Raster, Settings};

impl Renderer {
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
        (self.desc, self.placement) = (self.next_desc, self.next_placement);
        if self.placement == Placement::IDENTITY {
            return self.configure_in_scene(scene, camera, clip, settings);
        }
        let (camera, clip) = (
            camera.in_scene(&self.placement),
            clip.in_scene(&self.placement),
        );
        self.configure_in_scene(scene, &camera, &clip, settings)
    }

    fn configure_in_scene(
        &mut self,
        scene: &SceneBuffers,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<()> {
        self.plan = None;
        self.ready = false;
        if !scene.is_on(&self.device) {
            return Err(Error::Invalid(
                "the scene was uploaded to another device than the renderer's".into(),
            ));
        }
        self.scene = scene.id;
        self.free_finished();
        let columns = camera.width.div_ceil(limits::TILE_WIDTH);
        let tiles = columns.saturating_mul(camera.height.div_ceil(limits::TILE_HEIGHT));
        let needed = self.frame_counts().map_or(0, |counts| counts.pairs);
        self.pairs.make(scene.count, tiles, needed);
        let support = self.device.support();
        let is_cpu = self.device.info().kind == vk::PhysicalDeviceType::CPU;
        let sort_runs = sort_runs(is_cpu, scene.count);
        let hidden = self.desc.depth.filter(|depth| !depth.readable);
        let (raster, reason) = choose(settings.raster, support, is_cpu, tiles, hidden.is_some())?;
        self.reason = reason;
        let facts = SceneFacts {
            gaussians: scene.count,
            sh_degree: scene.sh_degree,
            sh_format: scene.sh_format,
            bounds: scene.bounds,
            sort_runs,
            raster,
            tile_work: TileWork::suiting(is_cpu, support.subgroup_size),
            pair_capacity: self.pairs.room(),
            redrawn: self.redraws,
            occluders: self
                .desc
                .depth
                .and_then(|depth| Occluders::of(&depth, &self.placement)),
            expects_depth: self.desc.expected_depth.is_some(),
        };
        let mut plan = Plan::new(facts, camera, clip, settings)?;
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
                Err(Error::Memory(_)) if plan.way.raster == Raster::Tiles => {
                    return self.configure_without_tiles(scene, camera, clip, settings);
                }
                Err(error) => return Err(error),
            }
        }
        // The host's depth may be another in each frame.
        let kept = self.kept.as_ref().filter(|_| plan.occluders.is_none());
        plan.work = Kept::work(kept, scene.id, &plan);
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
        // Of what there is, which an earlier frame may have made larger than this one needs.
        let largest = self.buffers.as_ref().map_or(0, Buffers::largest);
        let largest = largest.max(scene.largest());
        let support = self.device.support();
        self.bindings = match self.desc.bindings {
            Bindings::Bound
                if support.push_descriptor && largest <= support.max_storage_buffer_range =>
            {
                Bindings::Bound
            }
            Bindings::Bound | Bindings::Address => Bindings::Address,
        };
        self.ensure_pipelines(&plan)?;
        self.plan = Some(plan);
        Ok(())
    }

    /// Makes the pipelines that a plan needs and nobody has needed before.
    fn ensure_pipelines(&mut self, plan: &Plan) -> Result<()> {
        let targets = Targets {
            colour: self.desc.attachments(),
            expected_depth: self.desc.expected_depth(),
        };
        let at = self.bindings as usize;
        let has_all = |pipelines: &Pipelines| {
            let mut all = true;
            plan.pipelines(targets, &mut |key| all &= pipelines.has(&key));
            all
        };
        if self.pipelines[at].as_deref().is_some_and(has_all) {
            return Ok(());
        }
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let shared = shared[at].get_or_insert_with(|| Arc::new(Pipelines::new(self.bindings)));
        if !has_all(shared) {
            // A copy for all who come, while others record with what they have.
            let pipelines = Arc::make_mut(shared);
            let mut made = Ok(());
            plan.pipelines(targets, &mut |key| {
                if made.is_ok() {
                    made = pipelines.ensure(&self.device, key);
                }
            });
            made?;
        }
        self.pipelines[at] = Some(shared.clone());
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
        self.configure_in_scene(scene, camera, clip, &quads)?;
        self.reason = "the device has no memory for the tiles' lists";
        Ok(())
    }

    /// Frees what only frames used that the host has waited for.
    fn free_finished(&mut self) {
        let finished = (self.prepared + 1).saturating_sub(self.slots.len() as u64);
        self.retired.retain(|(prepared, _)| *prepared > finished);
    }
}

/// How splats become pixels on a device, and why in that way. `hidden` is what tiles cannot see: the host's depth.
fn choose(
    wanted: Raster,
    support: &Support,
    is_cpu: bool,
    tiles: u32,
    hidden: bool,
) -> Result<(Raster, &'static str)> {
    let tiled = wanted == Raster::Tiles || (wanted == Raster::Auto && is_cpu);
    Ok(match wanted {
        Raster::Auto | Raster::Tiles if hidden && tiled => {
            let reason = "tiles need the host's depth before its scope (DepthDesc::readable)";
            (Raster::Quad, reason)
        }
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
