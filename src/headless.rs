//! Device, renderer, target and readback in one: scenes in, pictures out, no window.

use std::time::Instant;

use ash::vk;

use crate::camera::Camera;
use crate::clip::Clip;
use crate::error::{Error, Result};
use crate::gpu::{
    Bindings, Buffer, BufferDesc, Device, DeviceDesc, Drawer, Image, ImageDesc, Location,
    PipelineCache, PipelineFile,
};
use crate::passes::SceneBuffers;
use crate::picture::Picture;
use crate::precision::{ShFormat, TargetFormat};
use crate::renderer::{Renderer, RendererDesc};
use crate::scene::Gaussians;
use crate::settings::Settings;
use crate::stats::FrameStats;
use crate::trace::{self, Trace};

mod spans;

/// What a headless renderer is created with.
#[derive(Debug, Clone, Default)]
pub struct HeadlessDesc {
    /// Device number or part of its name; `None` is the best device.
    pub device: Option<String>,
    /// Load the Khronos validation layer with synchronisation checks; any message becomes [`Error::Validation`].
    pub validation: bool,
    /// How buffers are reached; `None` is [what suits the device](Bindings::suiting), and bound under validation, whose
    /// synchronisation checks cannot watch an address.
    pub bindings: Option<Bindings>,
    /// Where compiled pipelines are kept from one run to the next.
    pub pipeline_cache: PipelineCache,
    /// Where to note what takes how long on the processor and on the device.
    pub trace: Option<Trace>,
    /// Count what the stages do, where the device can.
    pub statistics: bool,
}

impl HeadlessDesc {
    /// How buffers are reached.
    pub(crate) fn bindings_on(&self, device: &Device) -> Bindings {
        self.bindings.unwrap_or(if self.validation {
            Bindings::Bound
        } else {
            Bindings::suiting(device)
        })
    }
}

/// A renderer that owns its device and draws into an offscreen picture, of 32-bit floats unless the settings say
/// otherwise.
#[derive(Debug)]
pub struct Headless {
    renderer: Renderer,
    scene: Option<SceneBuffers>,
    target: Option<Target>,
    /// What the target holds: the frame's background, if it is the renderer's last frame.
    drawn: Option<Option<[u32; 3]>>,
    pipelines: Option<PipelineFile>,
    trace: Option<Trace>,
    /// Bytes of compiled pipelines that were there at the start.
    kept_pipeline_bytes: u64,
    // Last, so that everything above is freed before the device.
    device: Device,
}

#[derive(Debug)]
struct Target {
    image: Image,
    format: TargetFormat,
    readback: Option<Buffer>,
}

impl Headless {
    /// Opens the device.
    pub fn new(desc: &HeadlessDesc) -> Result<Self> {
        let selector = desc.device.clone();
        let open = || {
            Device::headless(&DeviceDesc {
                selector,
                validation: desc.validation,
                statistics: desc.statistics,
                application_name: "rara".into(),
            })
        };
        Self::on(trace::span(desc.trace.as_ref(), "open", open)?, desc)
    }

    /// On a device that is open.
    fn on(device: Device, desc: &HeadlessDesc) -> Result<Self> {
        let pipelines = PipelineFile::open(&desc.pipeline_cache, &device);
        let kept_pipeline_bytes = pipelines.as_ref().map_or(0, PipelineFile::held_bytes);
        let renderer = Renderer::new(
            &device,
            RendererDesc {
                bindings: desc.bindings_on(&device),
                timing: true,
                statistics: desc.statistics,
                reuse: true,
                ..RendererDesc::new(TargetFormat::default().vulkan())
            },
        )?;
        Ok(Self {
            renderer,
            scene: None,
            target: None,
            drawn: None,
            pipelines,
            trace: desc.trace.clone(),
            kept_pipeline_bytes,
            device,
        })
    }

    /// The device's name, for people.
    pub fn device_name(&self) -> &str {
        &self.device.info().name
    }

    /// The driver's name and version, for people.
    pub fn driver(&self) -> &str {
        &self.device.info().driver
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Device memory in use, bytes.
    pub fn device_bytes(&self) -> u64 {
        self.device.device_bytes()
    }

    /// Device memory that the scene takes, bytes; 0 without one.
    pub fn scene_bytes(&self) -> u64 {
        self.scene.as_ref().map_or(0, SceneBuffers::bytes)
    }

    /// Bytes of compiled pipelines that an earlier run had kept; 0 if none had, or what it had could not be used.
    pub fn kept_pipeline_bytes(&self) -> u64 {
        self.kept_pipeline_bytes
    }

    /// Uploads a scene in place of the one before, its spherical harmonics as they are: 192 bytes a Gaussian at degree
    /// 3. [`load_as`](Self::load_as) with [`Precision::sh`](crate::Precision::sh) of a preset takes 68.
    pub fn load(&mut self, scene: &Gaussians) -> Result<()> {
        self.load_as(scene, ShFormat::Float)
    }

    /// Uploads a scene in place of the one before, its spherical harmonics stored as `format` says.
    pub fn load_as(&mut self, scene: &Gaussians, format: ShFormat) -> Result<()> {
        self.drawn = None;
        // Free first: both together may not fit.
        self.scene = None;
        let upload = || SceneBuffers::upload(&self.device, scene, format);
        self.scene = Some(trace::span(self.trace.as_ref(), "upload", upload)?);
        Ok(())
    }

    /// Forgets what earlier frames have computed: the next one computes everything. Without it a frame takes over what
    /// the one before has found out and this one would find out again, to the same bytes; where nothing has changed it
    /// does nothing at all.
    pub fn forget(&mut self) {
        self.renderer.forget();
        self.drawn = None;
    }

    /// Renders one frame of the scene; the picture stays on the device.
    pub fn render(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<FrameStats> {
        let trace = self.trace.clone();
        let drawn = trace::span(trace.as_ref(), "render", || {
            self.render_frame(camera, clip, settings)
        });
        drawn.map_err(|error| error.after(self.device.validation_messages()))
    }

    fn render_frame(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<FrameStats> {
        let trace = self.trace.as_ref();
        let scene = self
            .scene
            .as_ref()
            .ok_or_else(|| Error::Invalid("there is no scene to render; load one first".into()))?;
        let format = settings.precision.target;
        self.renderer.set_color_format(format.vulkan());
        self.renderer.set_redraws(true);
        trace::span(trace, "configure", || {
            self.renderer.configure(scene, camera, clip, settings)
        })?;
        let extent = vk::Extent2D {
            width: camera.width,
            height: camera.height,
        };
        if self
            .target
            .as_ref()
            .is_none_or(|target| target.image.extent() != extent || target.format != format)
        {
            self.target = None;
            self.drawn = None;
            check_blending(&self.device, format)?;
            let image = self.device.create_image(&ImageDesc {
                name: "target",
                width: camera.width,
                height: camera.height,
                format: format.vulkan(),
            })?;
            self.target = Some(Target {
                image,
                format,
                readback: None,
            });
        }
        let Some(target) = &self.target else {
            unreachable!("created above")
        };
        let clear = settings
            .background
            .map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
        let begin = Instant::now();
        let background = settings.background.map(|rgb| rgb.map(f32::to_bits));
        if self.renderer.changes_nothing() && self.drawn == Some(background) {
            let mut skipped = self.renderer.skipped();
            skipped.push("splat");
            return Ok(FrameStats {
                counts: self.renderer.counts(),
                passes: Vec::new(),
                gpu_ms: 0.0,
                wall_ms: begin.elapsed().as_secs_f64() * 1e3,
                skipped,
                raster: self.renderer.raster(),
                statistics: Vec::new(),
            });
        }
        self.drawn = None;
        let mut quads = false;
        loop {
            let recording = Instant::now();
            let mut recorded = recording;
            let submitted = self.device.submit_and_wait(|cmd| {
                // SAFETY: `cmd` is recording and `scene`, the target and the renderer outlive the wait for it; the
                // rendering scope is opened and closed here around the draw, on an attachment of the renderer's format.
                unsafe {
                    self.renderer.prepare(cmd, scene)?;
                    target.image.begin_rendering(cmd, clear);
                    let area = vk::Rect2D {
                        offset: vk::Offset2D::default(),
                        extent,
                    };
                    Drawer::new(&self.device, cmd, None).viewport(area);
                    self.renderer.draw(cmd, [0.0, 0.0])?;
                    target.image.end_rendering(cmd);
                }
                recorded = Instant::now();
                Ok(())
            });
            if let Some(trace) = trace {
                trace.cpu("record", recording, recorded);
                trace.cpu("submit and wait", recorded, Instant::now());
                spans::add(trace, &self.device, &self.renderer, recorded);
            }
            if submitted.is_err() {
                self.renderer.forget(); // what it would have computed is not there
            }
            submitted?;
            // A first frame finds out how much room the tiles need, and nothing is drawn of it.
            let room = self.renderer.pair_room();
            if !self.renderer.fell_back() {
                break;
            }
            if quads {
                break; // they are the picture
            }
            trace::span(trace, "configure", || {
                self.renderer.configure(scene, camera, clip, settings)
            })?;
            if self.renderer.pair_room() <= room {
                // There is no more to be had.
                quads = true;
                self.renderer.set_redraws(false);
                self.renderer.forget(); // nothing was drawn of it
                self.renderer.configure(scene, camera, clip, settings)?;
            }
        }
        let wall_ms = begin.elapsed().as_secs_f64() * 1e3;
        self.check_validation()?;
        self.drawn = Some(background);
        let passes = self.renderer.pass_times();
        let gpu_ms = passes.iter().fold(0.0, |sum, pass| sum + pass.ms); // `sum` of nothing is -0
        let skipped = self.renderer.skipped();
        Ok(FrameStats {
            counts: self.renderer.counts(),
            passes,
            gpu_ms,
            wall_ms,
            skipped,
            raster: self.renderer.raster(),
            statistics: self.renderer.pass_statistics(),
        })
    }

    /// Reads the picture of the last frame back.
    pub fn picture(&mut self) -> Result<Picture> {
        let trace = self.trace.clone();
        let read = trace::span(trace.as_ref(), "readback", || self.read_back());
        read.map_err(|error| error.after(self.device.validation_messages()))
    }

    fn read_back(&mut self) -> Result<Picture> {
        let target = self
            .target
            .as_mut()
            .ok_or_else(|| Error::Invalid("nothing has been rendered yet".into()))?;
        let extent = target.image.extent();
        let size = u64::from(extent.width) * u64::from(extent.height) * target.format.pixel_bytes();
        let readback = match target.readback.take() {
            Some(buffer) => buffer,
            None => self.device.create_buffer(&BufferDesc {
                name: "readback",
                size,
                location: Location::Readback,
            })?,
        };
        self.device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording; the image was left ready to be copied from by the frame's end_rendering, and
            // image and buffer outlive the wait.
            unsafe { target.image.copy_to(cmd, &readback) };
            Ok(())
        })?;
        let pixels = target.format.decode(&readback.mapped()[..size as usize]);
        target.readback = Some(readback);
        self.check_validation()?;
        Ok(Picture {
            width: extent.width,
            height: extent.height,
            pixels,
        })
    }

    fn check_validation(&self) -> Result<()> {
        Error::validated(self.device.validation_messages())
    }

    /// Frees everything. The error is what the validation layer says of it, as of things left alive.
    pub fn close(self) -> Result<()> {
        let device = self.device.clone();
        drop(self);
        Error::validated(device.close())
    }
}

/// What was compiled is kept for the next run.
impl Drop for Headless {
    fn drop(&mut self) {
        if let Some(pipelines) = &mut self.pipelines {
            pipelines.keep(&self.device);
        }
    }
}

/// Vulkan promises blending into every format here but 32-bit floats.
pub(crate) fn check_blending(device: &Device, format: TargetFormat) -> Result<()> {
    let features = device.format_features(format.vulkan());
    let blends = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    if features.contains(blends) {
        return Ok(());
    }
    Err(Error::Device(format!(
        "this device cannot blend into pictures of {} bits a channel; choose another target format",
        2 * format.pixel_bytes()
    )))
}

#[cfg(test)]
mod faults;
#[cfg(test)]
mod tests;
