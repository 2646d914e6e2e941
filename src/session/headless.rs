//! Turns scenes into pictures without a window.

use super::stored::{PictureBytes, SpareMemory, StoredPicture};
use super::target::{Target, blendable_on, vulkan_format};
use super::{HeadlessDesc, Session};
use crate::passes::{SceneBuffers, SceneLayer, SplatColours};
use crate::renderer::{Kept, Renderer, RendererDesc};
use crate::stats::FrameStats;
use crate::trace;
use rara_base::error::{Error, Result};
use rara_gpu::{Device, DeviceDesc, PipelineFile};
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::picture::Picture;
use rara_scene::precision::{ShFormat, TargetFormat};
use rara_scene::settings::Settings;
use rara_scene::{LayerState, Scene};

/// A renderer that owns its device and draws into an offscreen picture, of 32-bit floats unless the settings say
/// otherwise.
#[derive(Debug)]
pub struct Headless {
    target: Target,
    /// Bytes of compiled pipelines that were there at the start.
    kept_pipeline_bytes: u64,
    spare_memory: SpareMemory,
    // Last, so that everything above is freed before its device.
    session: Session,
}

impl Headless {
    /// Opens the device.
    pub fn new(desc: &HeadlessDesc) -> Result<Self> {
        let selector = desc.device.clone();
        let open = || {
            let device = DeviceDesc::default()
                .selector(selector)
                .validation(desc.validation)
                .statistics(desc.statistics)
                .shape(desc.shape);
            Device::headless(&device)
        };
        Self::on(trace::span(desc.trace.as_ref(), "open", open)?, desc)
    }

    /// Makes it on the device of a host's renderer, whose compiled pipelines it shares and whose
    /// [placement](Renderer::set_placement) it takes: for what a host wants in its own memory beside its frames, as
    /// [`channels`](Self::channels). [`show`](Self::show) gives it the host's scene. What it draws it submits to the host's queue and waits for; nobody else uses the queue
    /// meanwhile. Of a device that was adopted, the validation layer's messages stay the host's.
    ///
    /// # Errors
    /// The errors of [`Renderer::new`].
    pub fn beside(renderer: &Renderer) -> Result<Self> {
        let format = blendable_on(renderer.device(), TargetFormat::default())?;
        Ok(Self {
            target: Target::of_tiles(),
            kept_pipeline_bytes: 0,
            spare_memory: SpareMemory::default(),
            session: Session::beside(renderer, vulkan_format(format))?,
        })
    }

    fn on(device: Device, desc: &HeadlessDesc) -> Result<Self> {
        let format = blendable_on(&device, TargetFormat::default())?;
        let renderer = RendererDesc {
            statistics: desc.statistics,
            ..RendererDesc::new(vulkan_format(format))
        };
        let session = Session::new(device, desc, renderer)?;
        let held_bytes = session.pipelines.as_ref().map(PipelineFile::held_bytes);
        Ok(Self {
            target: Target::of_tiles(),
            kept_pipeline_bytes: held_bytes.unwrap_or(0),
            spare_memory: SpareMemory::default(),
            session,
        })
    }

    /// The device's name, for people.
    pub fn device_name(&self) -> &str {
        &self.device().info().name
    }

    /// The driver's name and version, for people.
    pub fn driver(&self) -> &str {
        &self.device().info().driver
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.session.device
    }

    /// Device memory in use, bytes.
    pub fn device_bytes(&self) -> u64 {
        self.device().device_bytes()
    }

    /// Device memory that the scene takes, bytes; 0 without one.
    pub fn scene_bytes(&self) -> u64 {
        self.session.scene.as_ref().map_or(0, SceneBuffers::bytes)
    }

    /// Bytes of compiled pipelines that an earlier run had kept; 0 if none had, or they could not be used.
    pub fn kept_pipeline_bytes(&self) -> u64 {
        self.kept_pipeline_bytes
    }

    /// Uploads a scene, Gaussians or [layers](Scene) of them, in place of the one before. Its spherical harmonics stay as
    /// they are: 192 bytes a Gaussian at degree 3. [`load_as`](Self::load_as) with
    /// [`Precision::sh`](crate::Precision::sh) of a preset takes 68.
    pub fn load<'a>(&mut self, scene: impl Into<Scene<'a>>) -> Result<()> {
        self.load_as(scene, ShFormat::Float)
    }

    /// Uploads a scene in place of the one before, its spherical harmonics stored as `format` says.
    pub fn load_as<'a>(&mut self, scene: impl Into<Scene<'a>>, format: ShFormat) -> Result<()> {
        self.target.forget();
        self.session.load(scene.into(), format)
    }

    /// Draws a scene that is on the device, in place of the one before, and uploads nothing: a clone of the host's, which shares
    /// its memory, with states and clips of the layers as they are.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a scene of another device; the one before is then left.
    pub fn show(&mut self, scene: SceneBuffers) -> Result<()> {
        self.session.show(scene)?;
        self.target.forget();
        Ok(())
    }

    /// The layers of the scene; none without one.
    pub fn layers(&self) -> &[SceneLayer] {
        self.session.layers()
    }

    /// Returns the number of the first layer of a name in the loaded scene: see [`SceneBuffers::layer_index`].
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn layer_index(&self, name: &str) -> Result<usize> {
        self.session.scene()?.layer_index(name)
    }

    /// Sets how a layer of the loaded scene is shown: see [`SceneBuffers::set_layer_state`].
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn set_layer_state(&mut self, index: usize, state: LayerState) -> Result<()> {
        self.session.scene_mut()?.set_layer_state(index, state)
    }

    /// Sets the clip of a layer of the loaded scene: see [`SceneBuffers::set_layer_clip`].
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn set_layer_clip(&mut self, index: usize, clip: Option<Clip>) -> Result<()> {
        self.session.scene_mut()?.set_layer_clip(index, clip)
    }

    /// Forgets what earlier frames have computed: the next one computes everything. Without it a frame takes over results of
    /// the one before that it would compute again to the same bytes; where nothing has changed it does nothing at all.
    pub fn forget(&mut self) {
        self.session.renderer.forget();
        self.target.forget();
    }

    /// Renders one frame of the scene, cut by a clip, or of a prepared [cut](crate::Cut) of it; the picture stays on the device.
    pub fn render<'a>(
        &mut self,
        camera: &Camera,
        kept: impl Into<Kept<'a>>,
        settings: &Settings,
    ) -> Result<FrameStats> {
        self.render_in(SplatColours::Scene, camera, kept.into(), settings)
    }

    /// The same of splats in other colours.
    fn render_in(
        &mut self,
        colours: SplatColours,
        camera: &Camera,
        kept: Kept<'_>,
        settings: &Settings,
    ) -> Result<FrameStats> {
        let trace = self.session.trace.clone();
        let (session, target) = (&mut self.session, &mut self.target);
        let draw = || session.draw(target, camera, kept, settings, colours);
        let drawn = trace::span(trace.as_ref(), "render", draw);
        drawn.map_err(|error| self.session.explain(error))
    }

    /// Reads the picture of the last frame back.
    pub fn picture(&mut self) -> Result<Picture> {
        self.stored(|stored, _| stored.decode())
    }

    /// Copies the picture of the last frame from the device and leaves it as it is stored there, for another thread to decode
    /// while the next frame is drawn.
    pub fn read_back(&mut self) -> Result<StoredPicture> {
        self.stored(StoredPicture::new)
    }

    fn stored<R>(&mut self, act: impl FnOnce(PictureBytes<'_>, &SpareMemory) -> R) -> Result<R> {
        let read_back = || {
            let act = |stored: PictureBytes<'_>| act(stored, &self.spare_memory);
            let result = self.target.stored(&self.session.device, act)?;
            self.session.check_validation()?;
            Ok(result)
        };
        let read = trace::span(self.session.trace.as_ref(), "readback", read_back);
        read.map_err(|error| self.session.explain(error))
    }

    /// Frees everything. The error holds the validation layer's messages, as about things left alive.
    pub fn close(self) -> Result<()> {
        let device = self.device().clone();
        drop(self);
        Error::validated(device.close())
    }
}

mod aov;
mod depth;
mod pick;
mod working;

#[cfg(test)]
mod tests;
