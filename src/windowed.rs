//! Device, renderer and swapchain in one: scenes in, pictures in a window out. Whose window it is does not matter: any
//! crate's that speaks `raw-window-handle`.

use std::collections::VecDeque;
use std::sync::Arc;

use ash::vk;
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use crate::camera::Camera;
use crate::clip::Clip;
use crate::error::{Error, Result};
use crate::gpu::{
    BufferDesc, Device, DeviceDesc, Drawer, FRAMES, ImageDesc, InFlight, Location, PipelineFile,
    Surface, Swapchain, Window,
};
use crate::headless::{HeadlessDesc, check_blending};
use crate::passes::SceneBuffers;
use crate::picture::Picture;
use crate::precision::ShFormat;
use crate::renderer::{Renderer, RendererDesc};
use crate::scene::Gaussians;
use crate::settings::Settings;
use crate::stats::{Counts, PassTime, RasterChoice};

/// A renderer that owns its device and draws into somebody's window, two frames in flight. Colours are blended as they
/// are stored, on black where the settings name no background.
///
/// The window is the host's: its events, its size. Nothing is drawn unless asked for. A frame takes over from the one
/// before what stays the same, so that one in which nothing has changed costs next to nothing.
pub struct Windowed {
    // Dropped in this order, after waiting for the frames.
    frames: InFlight,
    swapchain: Swapchain,
    renderer: Renderer,
    scene: Option<SceneBuffers>,
    pipelines: Option<PipelineFile>,
    /// For each unread frame of the renderer, the oldest first: what it left out, if it computed anything.
    unread: VecDeque<Option<Vec<&'static str>>>,
    told: Option<Told>,
    /// The room for pairs of tile and splat for which a frame was drawn again.
    room: Option<u32>,
    /// A frame has failed between its image and the window.
    broken: bool,
    device: Device,
}

/// What the last frame that is known to be drawn, and that computed anything, tells about itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Told {
    /// How many Gaussians ended where.
    pub counts: Counts,
    /// GPU time of each stage, in order.
    pub passes: Vec<PassTime>,
    /// The stages that it did not need.
    pub skipped: Vec<&'static str>,
    /// How splats became pixels, and why in that way.
    pub raster: RasterChoice,
}

/// What became of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// It is shown, and all that can be told about it is known.
    Settled,
    /// It is shown. Draw once more when there is nothing else to do: its numbers are not known yet, or it ran out of
    /// room for tiles and was drawn in a slower way.
    Unsettled,
    /// It is not shown, as the window was not ready for it. Draw it again.
    Missed,
}

impl Windowed {
    /// Opens the device that is meant, among those that can draw into the window. The window is kept until this is
    /// dropped.
    pub fn new<W>(desc: &HeadlessDesc, window: Arc<W>) -> Result<Self>
    where
        W: HasWindowHandle + HasDisplayHandle + 'static,
    {
        let open = DeviceDesc {
            selector: desc.device.clone(),
            validation: desc.validation,
            application_name: "rara".into(),
            statistics: false,
        };
        let window: Arc<dyn Window> = window;
        let (device, surface) = Surface::open(&open, window)?;
        let swapchain = Swapchain::new(&device, surface)?;
        let pipelines = PipelineFile::open(&desc.pipeline_cache, &device);
        let renderer = Renderer::new(
            &device,
            RendererDesc {
                bindings: desc.bindings_on(&device),
                timing: true,
                reuse: true,
                frames_in_flight: FRAMES as u32,
                ..RendererDesc::new(swapchain.format())
            },
        )?;
        Ok(Self {
            frames: InFlight::new(&device)?,
            swapchain,
            renderer,
            scene: None,
            pipelines,
            unread: VecDeque::new(),
            told: None,
            room: None,
            broken: false,
            device,
        })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The format of the window's pictures.
    pub fn format(&self) -> vk::Format {
        self.swapchain.format()
    }

    /// Uploads a scene in place of the one before, its spherical harmonics stored as `format` says.
    pub fn load_as(&mut self, scene: &Gaussians, format: ShFormat) -> Result<()> {
        self.frames.wait_for_all()?;
        self.renderer.forget();
        // Free first: both together may not fit.
        self.scene = None;
        self.scene = Some(SceneBuffers::upload(&self.device, scene, format)?);
        Ok(())
    }

    /// Makes the window's images fit a window of this many pixels. The size that the next frame's camera needs, which
    /// may be another one while the window changes; `None` if there is nothing to draw into, as when it is minimised.
    pub fn fit(&mut self, window: (u32, u32)) -> Result<Option<(u32, u32)>> {
        let extent = self.swapchain.fit(window)?;
        Ok(extent.map(|extent| (extent.width, extent.height)))
    }

    /// Draws a frame and shows it. The camera's picture has the size that [`fit`](Self::fit) gave. After an error on the way
    /// to the window there are no more frames: a new `Windowed` for the same window is the way on.
    pub fn show(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> Result<Shown> {
        self.unbroken()?;
        self.frames.wait()?;
        self.read();
        let Self {
            renderer,
            swapchain,
            frames,
            ..
        } = self;
        let scene = loaded(&self.scene)?;
        renderer.configure(scene, camera, clip, settings)?;
        let computes = !renderer.changes_nothing();
        // SAFETY: the semaphore's last frame was waited for, and with it the wait for the semaphore.
        let Some(image) = (unsafe { swapchain.acquire(frames.acquired()) })? else {
            return Ok(Shown::Missed);
        };
        let [r, g, b] = settings.background.unwrap_or_default();
        // SAFETY: the frame before the last was waited for, and its image acquired; scene, renderer and swapchain live
        // until all frames were waited for. The rendering scope is opened and closed here around the draw, on an
        // attachment of the renderer's format, and the submission waits for its image.
        let shown = unsafe {
            let submitted = frames.submit(swapchain.drawn(image), |cmd| {
                renderer.prepare(cmd, scene)?;
                swapchain.begin_rendering(cmd, image, [r, g, b, 1.0]);
                renderer.draw(cmd, [0.0, 0.0])?;
                swapchain.end_rendering(cmd, image);
                Ok(())
            });
            submitted.and_then(|()| swapchain.present(image))
        };
        // The image stays acquired, and a semaphore signalled that nobody waits for.
        self.broken = shown.is_err();
        shown.map_err(|error| error.after(self.device.validation_messages()))?;
        let skipped = computes.then(|| renderer.skipped());
        self.unread.push_back(skipped);
        self.check_validation()?;
        if computes {
            return Ok(Shown::Unsettled);
        }
        // Nothing has changed: time to hear of the frame before.
        self.frames.wait()?;
        self.read();
        if self.renderer.fell_back() {
            // The next frame may have the room; if it has no more than this one, there is no more to be had.
            let room = self.renderer.pair_room();
            if self.room.replace(room) != Some(room) {
                return Ok(Shown::Unsettled);
            }
        } else {
            self.room = None;
        }
        Ok(Shown::Settled)
    }

    /// Draws a frame beside the window, as [`Headless`](crate::Headless) would, in any size and without the window's
    /// rounding.
    pub fn picture(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Picture> {
        let format = settings.precision.target;
        check_blending(&self.device, format)?;
        self.unbroken()?;
        self.frames.wait_for_all()?;
        self.read();
        let target = self.device.create_image(&ImageDesc {
            name: "screenshot",
            width: camera.width,
            height: camera.height,
            format: format.vulkan(),
        })?;
        let size = u64::from(camera.width) * u64::from(camera.height) * format.pixel_bytes();
        let readback = self.device.create_buffer(&BufferDesc {
            name: "screenshot_readback",
            size,
            location: Location::Readback,
        })?;
        let clear = settings
            .background
            .map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
        let scene = loaded(&self.scene)?;
        let renderer = &mut self.renderer;
        renderer.set_color_format(format.vulkan());
        let drawn = renderer
            .configure(scene, camera, clip, settings)
            .and_then(|()| {
                self.device.submit_and_wait(|cmd| {
                    // SAFETY: `cmd` is recording, all earlier frames were waited for, and everything outlives the wait
                    // for this one; the rendering scope is opened and closed here around the draw, on an attachment
                    // of the renderer's format.
                    unsafe {
                        renderer.prepare(cmd, scene)?;
                        target.begin_rendering(cmd, clear);
                        Drawer::new(&self.device, cmd, None).viewport(target.extent().into());
                        renderer.draw(cmd, [0.0, 0.0])?;
                        target.end_rendering(cmd);
                        target.copy_to(cmd, &readback);
                    }
                    Ok(())
                })
            });
        if drawn.is_err() {
            renderer.forget(); // what it would have computed is not there
        }
        renderer.set_color_format(self.swapchain.format());
        drawn.map_err(|error| error.after(self.device.validation_messages()))?;
        self.unread.push_back(None);
        self.check_validation()?;
        Ok(Picture {
            width: camera.width,
            height: camera.height,
            pixels: format.decode(&readback.mapped()[..size as usize]),
        })
    }

    /// What is known of the last frames; `None` before the first.
    pub fn told(&self) -> Option<&Told> {
        self.told.as_ref()
    }

    /// Frees everything, the window too if nobody else has it. The error is what the validation layer says of it.
    pub fn close(self) -> Result<()> {
        let device = self.device.clone();
        drop(self);
        Error::validated(device.close())
    }

    fn unbroken(&self) -> Result<()> {
        if self.broken {
            let what = "a frame has failed on its way to the window; open it anew";
            return Err(Error::Invalid(what.into()));
        }
        Ok(())
    }

    /// Notes what the oldest frame tells, which has been waited for.
    fn read(&mut self) {
        while self.unread.len() > FRAMES {
            self.unread.pop_front();
        }
        if self.unread.len() < FRAMES {
            return;
        }
        // Taken, so that it is read once.
        if let Some(skipped) = self.unread[0].take() {
            self.told = Some(Told {
                counts: self.renderer.counts(),
                passes: self.renderer.pass_times(),
                skipped,
                raster: self.renderer.raster(),
            });
        }
    }

    fn check_validation(&self) -> Result<()> {
        Error::validated(self.device.validation_messages())
    }
}

fn loaded(scene: &Option<SceneBuffers>) -> Result<&SceneBuffers> {
    scene
        .as_ref()
        .ok_or_else(|| Error::Invalid("there is no scene to show; load one first".into()))
}

impl std::fmt::Debug for Windowed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Windowed")
            .field("device", &self.device)
            .field("format", &self.swapchain.format())
            .field("scene", &self.scene)
            .finish_non_exhaustive()
    }
}

/// What was compiled is kept for the next run.
impl Drop for Windowed {
    fn drop(&mut self) {
        if let Some(pipelines) = &mut self.pipelines {
            pipelines.keep(&self.device);
        }
    }
}
