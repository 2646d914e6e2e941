//! Shows scenes in a window, which may be any crate's that speaks `raw-window-handle`.

use std::sync::Arc;
use std::thread::{self, JoinHandle};

use rara::ash::vk;
use rara::gpu::{Device, DeviceDesc};
use rara::{
    Camera, Clip, Error, FrameLimits, FrameStats, Headless, HeadlessDesc, LayerState, Lines,
    Outcome, Picture, Renderer, RendererDesc, Result, Scene, SceneBuffers, SceneLayer, Settings,
    ShFormat, Trace,
};
use rara_gpu::{Attachments, Drawer, PipelineFile};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use crate::in_flight::{FRAMES, InFlight};
use crate::lines::Line;
use crate::panels::{self, Panel, Panels, WrittenPanels};
use crate::surface::{Surface, Window};
use crate::swapchain::{Ground, Swapchain};

/// A renderer that owns its device and draws into a host's window, with two frames in flight. Colours are blended as they
/// are stored, on black where the settings name no background.
///
/// The window's events and its size are the host's business. Nothing is drawn unless asked for. A frame takes over what
/// stays the same from the one before, so that one in which nothing has changed costs next to nothing.
pub struct Windowed {
    // Dropped in this order, after waiting for the frames.
    frames: InFlight,
    swapchain: Swapchain,
    /// What the next frames show over their pictures, and its way there.
    lines: Vec<Line>,
    overlay: Lines,
    panels: Panels,
    renderer: Renderer,
    desc: RendererDesc,
    /// The thread that compiles shaders for the first frames, until one of them is drawn.
    compiling: Option<JoinHandle<()>>,
    scene: Option<SceneBuffers>,
    pipelines: Option<PipelineFile>,
    trace: Option<Trace>,
    /// The statistics of the last frame that was waited for and has computed anything.
    stats: Option<FrameStats>,
    /// True when a frame has failed between its image and the window.
    broken: bool,
    // Last, so that everything above is freed before the device.
    device: Device,
}

/// The need to show a frame once more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Redraw {
    /// The frame is shown, and its statistics are known.
    NotNeeded,
    /// The frame is shown. Show it once more when there is nothing else to do: its statistics are not known yet, or there was
    /// not enough memory for its tiles and it was drawn in a slower way.
    WhenIdle,
    /// The frame is not shown, because the window was not ready. Show it again.
    Now,
}

impl Windowed {
    /// Opens the device that is meant, among those that can draw into the window. The window is kept until this is
    /// dropped.
    pub fn new<W>(desc: &HeadlessDesc, window: Arc<W>) -> Result<Self>
    where
        W: HasWindowHandle + HasDisplayHandle + 'static,
    {
        let open = DeviceDesc::default()
            .selector(desc.device.clone())
            .validation(desc.validation)
            .shape(desc.shape);
        let window: Arc<dyn Window> = window;
        let (device, surface) = Surface::open(&open, window)?;
        let swapchain = Swapchain::new(&device, surface)?;
        let pipelines = PipelineFile::open(&desc.pipeline_cache, &device);
        if let Some(hook) = &desc.on_compile {
            device.on_compile(hook.clone());
        }
        let bindings = desc.bindings_on(&device);
        let of_frames = RendererDesc::new(swapchain.format())
            .bindings(bindings)
            .timing(true)
            .reuse(true)
            .frames_in_flight(FRAMES as u32);
        Ok(Self {
            frames: InFlight::new(&device)?,
            swapchain,
            lines: Vec::new(),
            overlay: Lines::new(bindings, FRAMES),
            panels: Panels::default(),
            renderer: Renderer::new(&device, of_frames)?,
            desc: of_frames,
            compiling: None,
            scene: None,
            pipelines,
            trace: desc.trace.clone(),
            stats: None,
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

    /// Begins to compile, on a thread of its own, the shaders of all frames within limits, as while a scene is read. Frames
    /// [compile](Self::compiles) until it is done; a shader that cannot be compiled is said by the frame that needs it.
    pub fn compile_ahead(&mut self, limits: FrameLimits) -> Result<()> {
        self.await_compiled();
        let mut sharing = self.renderer.sharing(self.desc)?;
        let work = move || drop(sharing.reserve(&limits));
        let named = thread::Builder::new().name("compiling".into());
        self.compiling = named.spawn(work).ok();
        Ok(())
    }

    /// Waits for the thread that compiles ahead, whose panic is said by itself.
    fn await_compiled(&mut self) {
        drop(self.compiling.take().map(JoinHandle::join));
    }

    /// Uploads a scene in place of the one before, its spherical harmonics stored as `format` says.
    pub fn load_as<'a>(&mut self, scene: impl Into<Scene<'a>>, format: ShFormat) -> Result<()> {
        let scene = scene.into();
        self.frames.wait_for_all()?;
        // A scene that is refused leaves the one before it.
        scene.check()?;
        self.renderer.forget();
        // Free first: both together may not fit.
        self.scene = None;
        let upload = || SceneBuffers::upload(&self.device, scene, format);
        self.scene = Some(match &self.trace {
            Some(trace) => trace.span("upload", upload),
            None => upload(),
        }?);
        Ok(())
    }

    /// The layers of the scene; none without one.
    pub fn layers(&self) -> &[SceneLayer] {
        self.scene.as_ref().map_or(&[], SceneBuffers::layers)
    }

    /// Returns the number of the first layer of a name in the loaded scene: see
    /// [`SceneBuffers::layer_index`].
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn layer_index(&self, name: &str) -> Result<usize> {
        loaded(self.scene.as_ref())?.layer_index(name)
    }

    /// Sets how a layer of the loaded scene is shown: see
    /// [`SceneBuffers::set_layer_state`].
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn set_layer_state(&mut self, index: usize, state: LayerState) -> Result<()> {
        loaded(self.scene.as_mut())?.set_layer_state(index, state)
    }

    /// Sets the clip of a layer of the loaded scene: see [`SceneBuffers::set_layer_clip`].
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn set_layer_clip(&mut self, index: usize, clip: Option<Clip>) -> Result<()> {
        loaded(self.scene.as_mut())?.set_layer_clip(index, clip)
    }

    /// Draws these lines over the window's next pictures, in place of those before. They stand in the world: each frame's
    /// camera sees them where they are, the part behind it left out. [`picture`](Self::picture) does not have them.
    pub fn set_lines(&mut self, lines: Vec<Line>) {
        self.lines = lines;
    }

    /// Shows these panels over the window's next pictures and their lines, in place of those before. Of panels that overlap the
    /// first is shown, and one whose picture has not as many pixels as its size says is left out.
    /// [`picture`](Self::picture) does not have them, and neither has a window that does not
    /// [show panels](Self::shows_panels).
    pub fn set_panels(&mut self, panels: &[Panel]) {
        self.panels.set(panels, self.swapchain.format());
    }

    /// Shows a picture in the scene's place in the window's next frames that have its size, under their lines and panels, or with
    /// `None` the scene again. Its alpha does not count, and a window that does not [show panels](Self::shows_panels) does not show
    /// it. What a frame [computes](Self::show) stays the same.
    pub fn set_cover(&mut self, picture: Option<&Picture>) {
        self.panels.set_cover(picture, self.swapchain.format());
    }

    /// True where the window system lets panels be copied into the window. It is known once [`fit`](Self::fit) has given a
    /// size, and false before.
    pub fn shows_panels(&self) -> bool {
        self.swapchain.copied_to().is_some() && panels::are_possible(self.swapchain.format())
    }

    /// Makes the window's images fit a window of this many pixels. Returns the size that the next frame's camera needs,
    /// which may be another one while the window changes; `None` if there is nothing to draw into, as when it is minimised.
    pub fn fit(&mut self, window: (u32, u32)) -> Result<Option<(u32, u32)>> {
        let extent = self.swapchain.fit(window)?;
        Ok(extent.map(|extent| (extent.width, extent.height)))
    }

    /// True when [`show`](Self::show) would have to compile shaders first, which may take seconds in which nothing else is
    /// shown.
    ///
    /// # Errors
    /// The errors of [`show`](Self::show).
    pub fn compiles(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> Result<bool> {
        self.unbroken()?;
        self.wait()?;
        let scene = loaded(self.scene.as_ref())?;
        let is_compiling = |thread: &JoinHandle<()>| !thread.is_finished();
        if self.compiling.as_ref().is_some_and(is_compiling) {
            return Ok(true); // the thread has the lock that would have to be asked
        }
        self.renderer.compiles(scene, camera, clip, settings)
    }

    /// Draws a frame and shows it. The camera's picture has the size that [`fit`](Self::fit) gave. After an error on the way
    /// to the window there are no more frames: a new `Windowed` for the same window is the way on.
    pub fn show(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> Result<Redraw> {
        self.unbroken()?;
        self.await_compiled();
        self.wait()?;
        let Self {
            swapchain,
            frames,
            lines,
            overlay,
            panels,
            renderer,
            device,
            ..
        } = self;
        let scene = loaded(self.scene.as_ref())?;
        let configured = renderer.configure(scene, camera, clip, settings)?;
        let changes_nothing = configured.changes_nothing();
        let seen: Vec<_> = lines
            .iter()
            .filter_map(|line| line.seen_by(camera))
            .collect();
        let attachments = Attachments::color(swapchain.format());
        let frame = frames.next();
        overlay.write(device, frame, &seen, attachments)?;
        let panels = panels.write(device, frame, swapchain.copied_to())?;
        let cover = panels.as_ref().and_then(WrittenPanels::cover);
        // SAFETY: the semaphore's last frame was waited for, and with it the wait for the semaphore.
        let Some(image) = (unsafe { swapchain.acquire(frames.acquired()) })? else {
            return Ok(Redraw::Now);
        };
        let [r, g, b] = settings.background.unwrap_or_default();
        // SAFETY: the frame before the last was waited for, and its image acquired; scene, renderer, swapchain and lines live
        // until all frames were waited for. The rendering scope is opened and closed here around the draws, on an
        // attachment of the renderer's format, and the submission waits for its image. The buffers of lines and panels are
        // those of this frame's slot, and the host wrote them before the submission; `write` keeps the copies within the
        // image and the panels' apart from each other, and that of a cover is of all of the image.
        let shown = unsafe {
            let submitted = frames.submit(swapchain.drawn(image), |cmd| {
                let prepared = renderer.prepare(cmd, scene, None, configured)?;
                match cover {
                    Some((buffer, copy)) => {
                        swapchain.begin_rendering(cmd, image, Ground::Copy(buffer, copy));
                    }
                    None => {
                        let ground = Ground::Colour([r, g, b, 1.0]);
                        swapchain.begin_rendering(cmd, image, ground);
                        renderer.draw(cmd, [0.0, 0.0], &prepared)?;
                    }
                }
                if !seen.is_empty() {
                    let mut drawer = Drawer::new(device, cmd, None);
                    let size = (camera.width, camera.height);
                    overlay.record(&mut drawer, frame, size, attachments);
                }
                let panels = panels.as_ref().and_then(WrittenPanels::panels);
                swapchain.end_rendering(cmd, image, panels);
                Ok(())
            });
            submitted.and_then(|()| swapchain.present(image))
        };
        self.validated(shown)?;
        if !changes_nothing {
            return Ok(Redraw::WhenIdle);
        }
        // A frame that changes nothing leaves time to wait for the one before.
        self.wait()
    }

    /// Shows the panels on a colour and nothing else, as while there is no scene yet.
    ///
    /// # Errors
    /// The errors of [`show`](Self::show).
    pub fn show_panels(&mut self, background: [f32; 3]) -> Result<Redraw> {
        self.unbroken()?;
        self.frames.wait_for_all()?;
        let Self {
            swapchain,
            frames,
            panels,
            device,
            ..
        } = self;
        let panels = panels.write(device, frames.next(), swapchain.copied_to())?;
        let panels = panels.as_ref().and_then(WrittenPanels::panels);
        // SAFETY: all frames were waited for, and with them the waits for the semaphore.
        let Some(image) = (unsafe { swapchain.acquire(frames.acquired()) })? else {
            return Ok(Redraw::Now);
        };
        let [r, g, b] = background;
        // SAFETY: as in `show`, without a scene.
        let shown = unsafe {
            let submitted = frames.submit(swapchain.drawn(image), |cmd| {
                swapchain.begin_rendering(cmd, image, Ground::Colour([r, g, b, 1.0]));
                swapchain.end_rendering(cmd, image, panels);
                Ok(())
            });
            submitted.and_then(|()| swapchain.present(image))
        };
        self.validated(shown)?;
        Ok(Redraw::NotNeeded)
    }

    /// Draws a frame beside the window, as [`Headless`] would, in any size and without the window's rounding. It has memory of
    /// its own, which is freed again.
    pub fn picture(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Picture> {
        let scene = loaded(self.scene.as_ref())?.clone();
        let mut headless = self.beside()?;
        headless.show(scene)?;
        headless.render(camera, clip, settings)?;
        headless.picture()
    }

    /// Makes a renderer without a window on this window's device, for what is drawn beside its scene, as slices. It has memory of
    /// its own. Nobody else uses the device's queue while it draws, and no frame is in flight when it is made.
    ///
    /// # Errors
    /// The errors of [`Headless::beside`], and [`Error::Invalid`] after a frame has failed on its way to the window.
    pub fn beside(&mut self) -> Result<Headless> {
        self.unbroken()?;
        self.frames.wait_for_all()?;
        Headless::beside(&self.renderer)
    }

    /// The statistics of the last frame that is known to be drawn and that has computed anything; `None` before the
    /// first. Nobody waits for frames in a window, so that `wall_ms` is 0.
    pub fn stats(&self) -> Option<&FrameStats> {
        self.stats.as_ref()
    }

    /// Frees everything, the window too if nobody else has it. The error holds the validation layer's messages.
    pub fn close(self) -> Result<()> {
        let device = self.device().clone();
        drop(self);
        Error::validated(device.close())
    }

    /// The result of a frame on its way to the window, with what the validation layer says. After an error the image stays
    /// acquired, and nothing waits for its semaphore.
    fn validated(&mut self, shown: Result<()>) -> Result<()> {
        self.broken = shown.is_err();
        let messages = self.device.validation_messages();
        match shown {
            Ok(()) => Error::validated(messages),
            Err(error) => Err(error.after(messages)),
        }
    }

    fn unbroken(&self) -> Result<()> {
        if self.broken {
            let what = "a frame has failed on its way to the window; open it anew";
            return Err(Error::Invalid(what.into()));
        }
        Ok(())
    }

    /// Waits for the oldest frame in flight and reads its outcome. Returns whether the frame should be drawn once more.
    fn wait(&mut self) -> Result<Redraw> {
        self.frames.wait()?;
        let outcome = self.renderer.outcome();
        if self.renderer.is_first_use() {
            // Its times may contain compilation: the next frame computes everything anew, and its times count.
            self.renderer.forget();
            return Ok(Redraw::WhenIdle);
        }
        if outcome.is_some_and(|outcome| outcome != Outcome::Unchanged) {
            self.stats = self.renderer.stats();
        }
        Ok(Redraw::NotNeeded)
    }
}

/// The scene, which is wanted in order to show it or to change its layers.
fn loaded<T>(scene: Option<T>) -> Result<T> {
    scene.ok_or_else(|| Error::Invalid("there is no scene to show; load one first".into()))
}

/// Keeps the compiled pipelines for the next run.
impl Drop for Windowed {
    fn drop(&mut self) {
        self.await_compiled();
        if let Some(pipelines) = &mut self.pipelines {
            pipelines.keep(&self.device);
        }
    }
}

impl std::fmt::Debug for Windowed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Windowed")
            .field("device", self.device())
            .field("format", &self.swapchain.format())
            .field("scene", &self.scene)
            .finish_non_exhaustive()
    }
}
