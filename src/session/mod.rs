//! Programs without a loop of their own draw with a session: a device, a renderer and a scene, and the one loop that submits
//! a frame and reads its outcome. [`Headless`] keeps the picture.

use std::time::Instant;

use ash::vk;

use crate::passes::{SceneBuffers, SceneLayer, SplatColours};
use crate::renderer::{
    ColorSpace, ConfiguredFrame, FrameRequest, Kept, Renderer, RendererDesc, Submission,
};
use crate::stats::FrameStats;
use crate::trace::{self, Trace};
use rara_base::error::{Error, Result};
use rara_gpu::{Device, Drawer, PipelineFile};
use rara_scene::Scene;
use rara_scene::camera::Camera;
use rara_scene::precision::{ShFormat, TargetFormat};
use rara_scene::settings::{Settings, Show};

mod desc;
mod headless;
mod spans;
mod stored;
mod target;

pub use desc::HeadlessDesc;
pub use headless::Headless;
pub use stored::StoredPicture;

use target::{Target, vulkan_format};

#[cfg(test)]
mod tests;

/// A device, a renderer on it and a scene for it.
#[derive(Debug)]
struct Session {
    renderer: Renderer,
    scene: Option<SceneBuffers>,
    pipelines: Option<PipelineFile>,
    trace: Option<Trace>,
    // Last, so that everything above is freed before the device.
    device: Device,
}

impl Session {
    fn new(device: Device, desc: &HeadlessDesc, renderer: RendererDesc) -> Result<Self> {
        let pipelines = PipelineFile::open(&desc.pipeline_cache, &device);
        if let Some(hook) = &desc.on_compile {
            device.on_compile(hook.clone());
        }
        let renderer = Renderer::new(
            &device,
            RendererDesc {
                bindings: desc.bindings_on(&device),
                timing: true,
                reuse: true,
                ..renderer
            },
        )?;
        Ok(Self {
            renderer,
            scene: None,
            pipelines,
            trace: desc.trace.clone(),
            device,
        })
    }

    /// Makes it on the device of a host's renderer, which keeps its compiled pipelines itself.
    fn beside(renderer: &Renderer, format: vk::Format) -> Result<Self> {
        Ok(Self {
            renderer: renderer.beside(format)?,
            scene: None,
            pipelines: None,
            trace: None,
            device: renderer.device().clone(),
        })
    }

    /// Uploads a scene in place of the one before, which no frame in flight needs any more.
    fn load(&mut self, scene: Scene<'_>, format: ShFormat) -> Result<()> {
        // A scene that is refused leaves the one before it.
        scene.check()?;
        self.renderer.forget();
        // Free first: both together may not fit.
        self.scene = None;
        let upload = || SceneBuffers::upload(&self.device, scene, format);
        self.scene = Some(trace::span(self.trace.as_ref(), "upload", upload)?);
        Ok(())
    }

    /// Takes a scene of the device in place of the one before.
    fn show(&mut self, scene: SceneBuffers) -> Result<()> {
        scene.check(&self.device)?;
        self.renderer.forget();
        self.scene = Some(scene);
        Ok(())
    }

    fn layers(&self) -> &[SceneLayer] {
        self.scene.as_ref().map_or(&[], SceneBuffers::layers)
    }

    fn scene(&self) -> Result<&SceneBuffers> {
        let scene = self.scene.as_ref();
        scene.ok_or_else(|| Error::Invalid("there is no scene with layers; load one first".into()))
    }

    fn scene_mut(&mut self) -> Result<&mut SceneBuffers> {
        let scene = self.scene.as_mut();
        scene.ok_or_else(|| {
            Error::Invalid("there is no scene whose layers could change; load one first".into())
        })
    }

    /// Draws a frame into a target and waits for it; does nothing where the target has that picture already. All earlier
    /// frames have been waited for.
    fn draw(
        &mut self,
        target: &mut Target,
        camera: &Camera,
        kept: Kept<'_>,
        settings: &Settings,
        colours: SplatColours,
    ) -> Result<FrameStats> {
        let trace = self.trace.as_ref();
        let renderer = &mut self.renderer;
        let scene = loaded(&self.scene, "render")?;
        let is_linear =
            scene.is_linear() && colours == SplatColours::Scene && settings.show == Show::Colour;
        // Linear light needs more bits in the dark than what is stored.
        let wanted = match settings.precision.target {
            TargetFormat::Unorm8 if is_linear => TargetFormat::Half,
            wanted => wanted,
        };
        let format = target.set_format(&self.device, wanted)?;
        target.set_linear(is_linear);
        renderer.set_color_format(vulkan_format(format));
        renderer.set_color_space(match is_linear {
            true => ColorSpace::Linear,
            false => ColorSpace::Stored,
        });
        let request = FrameRequest {
            scene,
            camera,
            kept,
            settings,
            submission: Submission::Awaited,
            picture: target.of_tiles_on(settings.background),
            whole: None,
            colours,
        };
        let configure = |renderer: &mut Renderer, target: &mut Target| {
            let frame = trace::span(trace, "configure", || renderer.configure_frame(&request))?;
            match frame.picture() {
                Some(_) => target.free_image(),
                None => target.make_image(&self.device, camera)?,
            }
            Ok::<_, Error>(frame)
        };
        let frame = configure(renderer, target)?;
        let begin = Instant::now();
        if frame.changes_nothing() && target.holds(frame.picture().as_ref(), settings.background) {
            return Ok(FrameStats {
                wall_ms: ms_since(begin),
                ..renderer.unchanged_stats(&frame)
            });
        }
        let tiles = frame.picture();
        submit(&self.device, renderer, &request, (target, frame), trace)?;
        let wall_ms = ms_since(begin);
        let stats = renderer.newest().expect("it was prepared just now").stats();
        self.check_validation()?;
        match tiles {
            Some(tiles) => target.set_tiles(tiles, camera),
            None => target.set_held(settings.background),
        }
        Ok(FrameStats { wall_ms, ..stats })
    }

    /// Returns an error if the validation layer has said anything so far.
    fn check_validation(&self) -> Result<()> {
        Error::validated(self.device.validation_messages())
    }

    /// Puts the validation layer's earlier messages before an error.
    fn explain(&self, error: Error) -> Error {
        error.after(self.device.validation_messages())
    }
}

/// Keeps the compiled pipelines for the next run.
impl Drop for Session {
    fn drop(&mut self) {
        if let Some(pipelines) = &mut self.pipelines {
            pipelines.keep(&self.device);
        }
    }
}

/// Records a frame, submits it and waits for it.
fn submit(
    device: &Device,
    renderer: &mut Renderer,
    request: &FrameRequest<'_>,
    (target, frame): (&mut Target, ConfiguredFrame),
    trace: Option<&Trace>,
) -> Result<()> {
    let clear = target.clear_colour(request.settings.background);
    let image = target.drawn_into();
    let recording = Instant::now();
    let (mut recorded, mut is_prepared) = (recording, false);
    let submitted = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording, all earlier frames were waited for, and scene, image and renderer outlive the wait
        // for this one; the rendering scope is opened and closed here around the draw, on an attachment of the renderer's
        // format.
        unsafe {
            let frame = renderer.prepare(cmd, request.scene, None, frame)?;
            is_prepared = true;
            if let Some(image) = image {
                image.begin_rendering(cmd, clear);
                Drawer::new(device, cmd, None).viewport(image.extent().into());
                renderer.draw(cmd, [0.0, 0.0], &frame)?;
                image.end_rendering(cmd);
            }
        }
        recorded = Instant::now();
        Ok(())
    });
    if let Some(trace) = trace {
        trace.cpu("record", recording, recorded);
        trace.cpu("submit and wait", recorded, Instant::now());
        spans::add(trace, device, renderer.newest(), recorded);
    }
    match submitted {
        Err(_) if is_prepared => renderer.abandon(), // its results are missing
        Err(_) => renderer.forget(),
        Ok(()) => {}
    }
    submitted
}

/// The scene, which is wanted in order to `render` or to `show` it.
fn loaded<'a>(scene: &'a Option<SceneBuffers>, wanted: &str) -> Result<&'a SceneBuffers> {
    scene
        .as_ref()
        .ok_or_else(|| Error::Invalid(format!("there is no scene to {wanted}; load one first")))
}

fn ms_since(begin: Instant) -> f64 {
    begin.elapsed().as_secs_f64() * 1e3
}
