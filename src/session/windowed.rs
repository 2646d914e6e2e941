//! Shows scenes in a window, which may be any crate's that speaks `raw-window-handle`.

use std::sync::Arc;

use ash::vk;
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use super::lines::Line;
use super::panels::{self, Panel, Panels};
use super::target::Target;
use super::{HeadlessDesc, Session, loaded};
use crate::passes::{Lines, SceneLayer, SplatColours};
use crate::renderer::{ColorSpace, FrameRequest, Outcome, RendererDesc};
use crate::stats::FrameStats;
use rara_base::error::{Error, Result};
use rara_gpu::{
    Attachments, Device, DeviceDesc, Drawer, FRAMES, InFlight, Surface, Swapchain, Window,
};
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::picture::Picture;
use rara_scene::precision::ShFormat;
use rara_scene::settings::Settings;
use rara_scene::{LayerState, Scene};

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
    session: Session,
    /// The statistics of the last frame that was waited for and has computed anything.
    stats: Option<FrameStats>,
    /// True when a frame has failed between its image and the window.
    broken: bool,
}

/// The need to show a frame once more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Redraw {
    /// It is shown, and all that can be known of it is known.
    NotNeeded,
    /// It is shown. Show it once more when there is nothing else to do: its statistics are not known yet, or it ran out of
    /// room for tiles and was drawn in a slower way.
    WhenIdle,
    /// It is not shown, as the window was not ready for it. Show it again.
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
        let renderer = RendererDesc {
            frames_in_flight: FRAMES as u32,
            ..RendererDesc::new(swapchain.format())
        };
        Ok(Self {
            frames: InFlight::new(&device)?,
            swapchain,
            lines: Vec::new(),
            overlay: Lines::new(desc.bindings_on(&device), FRAMES),
            panels: Panels::default(),
            session: Session::new(device, desc, renderer)?,
            stats: None,
            broken: false,
        })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.session.device
    }

    /// The format of the window's pictures.
    pub fn format(&self) -> vk::Format {
        self.swapchain.format()
    }

    /// Uploads a scene in place of the one before, its spherical harmonics stored as `format` says.
    pub fn load_as<'a>(&mut self, scene: impl Into<Scene<'a>>, format: ShFormat) -> Result<()> {
        self.frames.wait_for_all()?;
        self.session.load(scene.into(), format)
    }

    /// The layers of the scene; none without one.
    pub fn layers(&self) -> &[SceneLayer] {
        self.session.layers()
    }

    /// As [`SceneBuffers::layer_index`](crate::SceneBuffers::layer_index), of the scene that is loaded.
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn layer_index(&self, name: &str) -> Result<usize> {
        self.session.scene()?.layer_index(name)
    }

    /// As [`SceneBuffers::set_layer_state`](crate::SceneBuffers::set_layer_state), of the scene that is loaded.
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn set_layer_state(&mut self, index: usize, state: LayerState) -> Result<()> {
        self.session.scene_mut()?.set_layer_state(index, state)
    }

    /// As [`SceneBuffers::set_layer_clip`](crate::SceneBuffers::set_layer_clip), of the scene that is loaded.
    ///
    /// # Errors
    /// The same, and [`Error::Invalid`] without a scene.
    pub fn set_layer_clip(&mut self, index: usize, clip: Option<Clip>) -> Result<()> {
        self.session.scene_mut()?.set_layer_clip(index, clip)
    }

    /// Draws these lines over the window's next pictures, in place of those before. They stand in the world: each frame's
    /// camera sees them where they are, the part behind it left out. [`picture`](Self::picture) does not have them.
    pub fn set_lines(&mut self, lines: Vec<Line>) {
        self.lines = lines;
    }

    /// Shows these panels over the window's next pictures and their lines, in place of those before. Of panels that overlap the
    /// first is shown, and one whose picture has not as many pixels as its size says is left out. [`picture`](Self::picture) does not have them, and neither has a window that does not
    /// [show panels](Self::shows_panels).
    pub fn set_panels(&mut self, panels: &[Panel]) {
        self.panels.set(panels, self.swapchain.format());
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
    /// As of [`show`](Self::show).
    pub fn compiles(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> Result<bool> {
        self.unbroken()?;
        self.wait()?;
        let renderer = &mut self.session.renderer;
        let scene = loaded(&self.session.scene, "show")?;
        renderer.set_color_format(self.swapchain.format());
        renderer.set_color_space(ColorSpace::Stored);
        renderer.compiles(&FrameRequest::in_flight(scene, camera, clip, settings))
    }

    /// Draws a frame and shows it. The camera's picture has the size that [`fit`](Self::fit) gave. After an error on the way
    /// to the window there are no more frames: a new `Windowed` for the same window is the way on.
    pub fn show(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> Result<Redraw> {
        self.unbroken()?;
        self.wait()?;
        let Self {
            swapchain,
            frames,
            lines,
            overlay,
            panels,
            ..
        } = self;
        let renderer = &mut self.session.renderer;
        let scene = loaded(&self.session.scene, "show")?;
        renderer.set_color_format(swapchain.format());
        renderer.set_color_space(ColorSpace::Stored);
        let configured = renderer.configure(scene, camera, clip, settings)?;
        let changes_nothing = configured.changes_nothing();
        let seen: Vec<_> = lines
            .iter()
            .filter_map(|line| line.seen_by(camera))
            .collect();
        let (device, attachments) = (&self.session.device, Attachments::color(swapchain.format()));
        let frame = frames.next();
        overlay.write(device, frame, &seen, attachments)?;
        let panels = panels.write(device, frame, swapchain.copied_to())?;
        let panels = panels
            .as_ref()
            .map(|(buffer, copies)| (*buffer, &copies[..]));
        // SAFETY: the semaphore's last frame was waited for, and with it the wait for the semaphore.
        let Some(image) = (unsafe { swapchain.acquire(frames.acquired()) })? else {
            return Ok(Redraw::Now);
        };
        let [r, g, b] = settings.background.unwrap_or_default();
        // SAFETY: the frame before the last was waited for, and its image acquired; scene, renderer, swapchain and lines live
        // until all frames were waited for. The rendering scope is opened and closed here around the draws, on an
        // attachment of the renderer's format, and the submission waits for its image. The buffers of lines and panels are
        // those of this frame's slot, and the host wrote them before the submission; `write` keeps the copies within the
        // image and apart from each other.
        let shown = unsafe {
            let submitted = frames.submit(swapchain.drawn(image), |cmd| {
                let prepared = renderer.prepare(cmd, scene, None, configured)?;
                swapchain.begin_rendering(cmd, image, [r, g, b, 1.0]);
                renderer.draw(cmd, [0.0, 0.0], &prepared)?;
                if !seen.is_empty() {
                    let mut drawer = Drawer::new(device, cmd, None);
                    let size = (camera.width, camera.height);
                    overlay.record(&mut drawer, frame, size, attachments);
                }
                swapchain.end_rendering(cmd, image, panels);
                Ok(())
            });
            submitted.and_then(|()| swapchain.present(image))
        };
        // After an error the image stays acquired, and nothing waits for its semaphore.
        self.broken = shown.is_err();
        shown.map_err(|error| self.session.explain(error))?;
        self.session.check_validation()?;
        if !changes_nothing {
            return Ok(Redraw::WhenIdle);
        }
        // A frame that changes nothing leaves time to wait for the one before.
        Ok(match self.wait()? {
            Some(Outcome::NeedsRoom) => Redraw::WhenIdle,
            Some(Outcome::NoRoom) => return Err(super::no_room(settings)),
            Some(Outcome::Drawn | Outcome::Unchanged) | None => Redraw::NotNeeded,
        })
    }

    /// Shows the panels on a colour and nothing else, as while there is no scene yet.
    ///
    /// # Errors
    /// As of [`show`](Self::show).
    pub fn show_panels(&mut self, background: [f32; 3]) -> Result<Redraw> {
        self.unbroken()?;
        self.frames.wait_for_all()?;
        let Self {
            swapchain,
            frames,
            panels,
            ..
        } = self;
        let panels = panels.write(&self.session.device, frames.next(), swapchain.copied_to())?;
        let panels = panels
            .as_ref()
            .map(|(buffer, copies)| (*buffer, &copies[..]));
        // SAFETY: all frames were waited for, and with them the waits for the semaphore.
        let Some(image) = (unsafe { swapchain.acquire(frames.acquired()) })? else {
            return Ok(Redraw::Now);
        };
        let [r, g, b] = background;
        // SAFETY: as in `show`, without a scene.
        let shown = unsafe {
            let submitted = frames.submit(swapchain.drawn(image), |cmd| {
                swapchain.begin_rendering(cmd, image, [r, g, b, 1.0]);
                swapchain.end_rendering(cmd, image, panels);
                Ok(())
            });
            submitted.and_then(|()| swapchain.present(image))
        };
        self.broken = shown.is_err();
        shown.map_err(|error| self.session.explain(error))?;
        self.session.check_validation()?;
        Ok(Redraw::NotNeeded)
    }

    /// Draws a frame beside the window, as [`Headless`](crate::Headless) would, in any size and without the window's
    /// rounding.
    pub fn picture(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Picture> {
        self.unbroken()?;
        loaded(&self.session.scene, "show")?;
        self.wait()?;
        self.frames.wait_for_all()?;
        let session = &mut self.session;
        let mut target = Target::default();
        let drawn = session.draw(&mut target, camera, clip, settings, SplatColours::Scene);
        let picture = drawn.and_then(|_| target.read_back(&session.device));
        let picture = picture.map_err(|error| session.explain(error))?;
        session.check_validation()?;
        Ok(picture)
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

    fn unbroken(&self) -> Result<()> {
        if self.broken {
            let what = "a frame has failed on its way to the window; open it anew";
            return Err(Error::Invalid(what.into()));
        }
        Ok(())
    }

    /// Waits for the oldest frame in flight and reads its outcome; `None` before there are so many.
    fn wait(&mut self) -> Result<Option<Outcome>> {
        self.frames.wait()?;
        let renderer = &mut self.session.renderer;
        let Some(frame) = renderer.oldest() else {
            return Ok(None);
        };
        let outcome = renderer.outcome(frame);
        if frame.is_first_use() {
            // Its times may contain compilation: the next frame computes everything anew, and its times count. To the window
            // that is as if it had to be drawn again.
            renderer.forget();
            return Ok(Some(Outcome::NeedsRoom));
        }
        if outcome != Outcome::Unchanged && frame.is_in_flight() {
            // A picture beside the window is not the window's frame.
            self.stats = Some(frame.stats());
        }
        Ok(Some(outcome))
    }
}

impl std::fmt::Debug for Windowed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Windowed")
            .field("device", self.device())
            .field("format", &self.swapchain.format())
            .field("scene", &self.session.scene)
            .finish_non_exhaustive()
    }
}
