//! An open window with a scene in it, and the actions on it.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DVec2, DVec3};
use rara::clip::{Lasso, NamedClip};
use rara::{Camera, Clip, Picture, Settings};
use winit::dpi::PhysicalSize;
use winit::event_loop::EventLoopProxy;
use winit::window::Window;

use super::action::Action;
use super::dropped::DroppedFile;
use super::failure::Failure;
use super::host::{Host, Shown};
use super::input::KEYS;
use super::lasso;
use super::loading::Loading;
use super::overlay::Overlay;
use super::scenery::{FaceView, Manner, SceneView, Scenery};
use super::slices::{FacePlan, ShownFaces};
use super::viewpoint::{Viewpoint, Walk};
use crate::Windowed;
use rara_shots::UP;

/// A message to the event loop from another thread.
pub(super) enum AppEvent {
    /// The script that standard input holds.
    Script(Result<Vec<Action>, Failure>),
    /// A scene that has been read, or why it could not be.
    Read(Box<Result<SceneView, Failure>>),
}

pub(super) struct Viewer {
    pub(super) host: Box<dyn Host>,
    pub(super) windowed: Windowed,
    pub(super) window: Arc<Window>,
    pub(super) proxy: EventLoopProxy<AppEvent>,
    pub(super) manner: Manner,
    pub(super) scenery: Scenery,
    pub(super) loaded: bool,
    /// True once there was one.
    pub(super) began: bool,
    pub(super) loading: Option<Loading>,
    /// Files that are yet to be opened.
    pub(super) dropped: Vec<PathBuf>,
    /// What was dropped with the scene that is being read.
    pub(super) beside: Vec<DroppedFile>,
    /// Clips of a file, of which one is meant, and the number of the one that is shown.
    pub(super) alternatives: (Vec<NamedClip>, usize),
    /// How often something has failed that the window outlives.
    pub(super) warnings: u32,
    pub(super) overlay: Overlay,
    /// The outline that is being drawn in the picture, px.
    pub(super) drawn: Vec<DVec2>,
    /// For how many frames the window still says that shaders are compiled.
    pub(super) compiling: u32,
    pub(super) faces: ShownFaces,
    /// The last frame of the scene that was shown.
    pub(super) last: Option<(Camera, Clip, Settings)>,
    pub(super) view: usize,
    pub(super) viewpoint: Viewpoint,
    /// Share of the scene's radius that flying covers in a second.
    speed: f64,
    /// The window's size in pixels, from its events: winit panics when it is asked for the size and the window is gone.
    pub(super) size: (u32, u32),
    /// How many of them are as long as one on an ordinary screen.
    pub(super) scale_factor: f64,
    minimised: bool,
    /// True when nothing of the window is visible.
    occluded: bool,
    /// True when the window does not yet show what it should.
    pub(super) dirty: bool,
    /// True when the last frame's numbers are not known yet.
    pub(super) unsettled: bool,
    /// The time at which the last frame was shown, if the next one follows at once.
    pub(super) shown_at: Option<Instant>,
    pub(super) intervals: Vec<Duration>,
    pub(super) titled_at: Option<Instant>,
}

/// The least and the most speed; a user can still come back from both.
const SPEEDS: (f64, f64) = (1e-6, 1e6);

impl Viewer {
    pub(super) fn new(
        windowed: Windowed,
        window: Arc<Window>,
        proxy: EventLoopProxy<AppEvent>,
        (host, manner): (Box<dyn Host>, Manner),
    ) -> rara::Result<Self> {
        let scenery = Scenery::nothing(manner.up.unwrap_or(UP))?;
        let viewpoint = scenery.viewpoint(0);
        Ok(Self {
            host,
            windowed,
            size: window.inner_size().into(),
            scale_factor: window.scale_factor(),
            window,
            proxy,
            alternatives: (Vec::new(), 0),
            warnings: 0,
            overlay: Overlay::new(manner.text),
            drawn: Vec::new(),
            compiling: 0,
            faces: ShownFaces::default(),
            last: None,
            manner,
            scenery,
            loaded: false,
            began: false,
            loading: None,
            dropped: Vec::new(),
            beside: Vec::new(),
            view: 0,
            viewpoint,
            speed: 0.5,
            minimised: false,
            occluded: false,
            dirty: true,
            unsettled: false,
            shown_at: None,
            intervals: Vec::new(),
            titled_at: None,
        })
    }

    /// The window's size in pixels; zero while it is minimised.
    pub(super) fn size(&self) -> (u32, u32) {
        if self.minimised {
            return (0, 0);
        }
        self.size
    }

    /// True when a user would see a frame.
    pub(super) fn visible(&self) -> bool {
        let (width, height) = self.size();
        !self.occluded && width > 0 && height > 0
    }

    pub(super) fn resized(&mut self, size: (u32, u32)) -> Result<(), Failure> {
        self.size = size;
        self.changed()
    }

    pub(super) fn rescaled(&mut self, scale_factor: f64) {
        self.scale_factor = scale_factor;
        self.dirty = true;
    }

    /// Handles that other windows hide all of it, or no longer do.
    pub(super) fn occlude(&mut self, occluded: bool) -> Result<(), Failure> {
        self.occluded = occluded;
        if !occluded {
            self.minimised = false;
        }
        self.changed()
    }

    /// Handles that the window has the keyboard. If it was minimised, a user or a window manager has brought it back.
    pub(super) fn focus(&mut self) -> Result<(), Failure> {
        if !std::mem::take(&mut self.minimised) {
            return Ok(());
        }
        self.changed()
    }

    /// Asks for a frame for another reason than an action.
    pub(super) fn changed(&mut self) -> Result<(), Failure> {
        self.dirty = true;
        if !self.visible() {
            self.windowed.fit(self.size())?;
        }
        Ok(())
    }

    /// Moves right, down and forward for a time, at the speed of flying.
    pub(super) fn fly(&mut self, direction: DVec3, time: Duration) {
        let by = self.speed * self.scenery.radius * time.as_secs_f64();
        self.viewpoint.go(direction * by);
        self.dirty = true;
    }

    /// Does what an action asks, except for quitting and resizing, which need the event loop.
    pub(super) fn act(&mut self, action: Action) -> Result<(), Failure> {
        if !self.loaded && action.needs_a_scene() {
            return Ok(());
        }
        let height = self.picture_size().1;
        match action {
            Action::Turn(degrees) => self.viewpoint.turn(degrees),
            Action::Shift(pixels) => self.viewpoint.shift(pixels, height),
            Action::Zoom(steps) if self.viewpoint.walk == Walk::Fly => {
                let speed = self.speed * 1.25_f64.powf(steps);
                self.speed = speed.clamp(SPEEDS.0, SPEEDS.1);
                return Ok(());
            }
            Action::Zoom(steps) => self.viewpoint.zoom(steps),
            Action::Go(by) => self.viewpoint.go(by),
            Action::Walk(walk) => {
                self.viewpoint.walk = walk;
                return Ok(());
            }
            Action::OtherWalk => {
                return self.act(Action::Walk(match self.viewpoint.walk {
                    Walk::Orbit => Walk::Fly,
                    Walk::Fly => Walk::Orbit,
                }));
            }
            Action::Projection(projection) => self.viewpoint.projection = projection,
            Action::OtherProjection => self.viewpoint.other_projection(),
            Action::Up(up) => {
                self.manner.up = Some(up);
                self.viewpoint.set_up(up);
            }
            Action::UpAxis(axis) => {
                let up = match self.viewpoint.has_up(axis) {
                    true => -axis,
                    false => axis,
                };
                return self.act(Action::Up(up));
            }
            Action::Reset => self.viewpoint.reset(),
            Action::NextClip => self.next_clip(),
            Action::NextView => {
                let walk = self.viewpoint.walk;
                self.view = (self.view + 1) % self.scenery.views.len();
                self.viewpoint = self.scenery.viewpoint(self.view);
                self.viewpoint.walk = walk;
            }
            Action::Held(action) => {
                let camera = self.viewpoint.camera(self.picture_size());
                let Scenery { clips, radius, .. } = &mut self.scenery;
                clips.act(action, &camera, *radius);
            }
            Action::Undo => self.scenery.clips.undo(),
            Action::Draw(to) => self.drawn.push(to),
            Action::Drawn(keeps) => {
                let outline = lasso::simplified(&std::mem::take(&mut self.drawn));
                self.dirty = true;
                if outline.len() > 2 {
                    let drawn = Lasso::new(vec![outline], keeps);
                    let drawn = drawn.map_err(|error| Failure::Asked(error.to_string()))?;
                    return self.act(Action::Lasso(drawn));
                }
            }
            Action::Lasso(drawn) => {
                let camera = self.viewpoint.camera(self.picture_size());
                self.scenery.clips.lasso(&camera, &drawn)?;
            }
            Action::Layer(which, visible) => self.scenery.clips.show(&which, visible)?,
            Action::LayerOpacity(which, opacity) => {
                let text = self.scenery.clips.fade(&which, opacity)?;
                self.overlay.tell(text);
            }
            Action::LayerTint(which, tint) => self.tint(&which, tint)?,
            Action::Edit(edit) => self.scenery.clips.edit(&edit)?,
            Action::Outline(on) => switch(&mut self.manner.outlined, on),
            Action::Slice(on) => switch(&mut self.manner.faces.slice, on),
            Action::Edge(on) => switch(&mut self.manner.faces.edge, on),
            Action::Rim(on) => switch(&mut self.manner.faces.rim, on),
            Action::Keys(on) if self.visible() && !self.windowed.shows_panels() => {
                if on != Some(false) {
                    self.host.say(&KEYS);
                }
            }
            Action::Keys(on) => self.overlay.set_keys(on),
            Action::Numbers(on) => self.overlay.set_numbers(on),
            Action::Drop(file) => self.dropped.push(file),
            Action::Mode(mode) => self.manner.settings.mode = mode,
            Action::Screenshot(path) => return self.screenshot(path),
            Action::Minimise | Action::Restore => {
                self.minimised = action == Action::Minimise;
                self.window.set_minimized(self.minimised);
                return self.changed();
            }
            Action::Timings => {
                let (size, stats) = (self.size(), self.windowed.stats());
                self.host.time(size, stats, &self.intervals);
                self.intervals.clear();
                self.shown_at = None;
                return Ok(());
            }
            Action::Flags => {
                let camera = self.viewpoint.camera(self.picture_size());
                let shown = shown(camera, &self.scenery, &self.manner);
                self.host.describe(&shown);
                return Ok(());
            }
            Action::Help => {
                self.host.say(&KEYS);
                return Ok(());
            }
            Action::Resize(_) | Action::Quit => return Ok(()),
        }
        self.dirty = true;
        Ok(())
    }

    /// The size of the picture that is shown, or would be if the window were not minimised.
    pub(super) fn picture_size(&self) -> (u32, u32) {
        (self.size.0.max(1), self.size.1.max(1))
    }

    /// Draws what there is to see by a camera, whether the window shows it or not.
    fn picture(&mut self, camera: &Camera) -> Result<Picture, Failure> {
        self.scenery.clips.apply(&mut self.windowed)?;
        if let Ok(Some(plan)) = FacePlan::new(&self.scenery, &self.manner, camera) {
            return Ok(plan.picture(&mut self.windowed, &self.scenery.scene)?);
        }
        let clip = self.scenery.clips.frame.clip();
        let settings = &self.manner.settings;
        Ok(self.windowed.picture(camera, &clip, settings)?)
    }

    fn screenshot(&mut self, path: Option<PathBuf>) -> Result<(), Failure> {
        let camera = self.viewpoint.camera(self.picture_size());
        let picture = self.picture(&camera)?;
        let shown = shown(camera, &self.scenery, &self.manner);
        let file = self.host.screenshot(&picture, path.as_deref(), &shown)?;
        self.overlay.tell(format!("wrote {}", file.display()));
        self.dirty = true;
        self.shown_at = None; // the next frame does not follow at once
        Ok(())
    }

    /// Asks for another size of the window; returns whether it has that size already.
    pub(super) fn resize(&mut self, wanted: (u32, u32)) -> bool {
        if self.size != wanted {
            let granted = self
                .window
                .request_inner_size(PhysicalSize::<u32>::from(wanted));
            // No event follows a size that is granted at once.
            self.size = granted.map_or(self.size, Into::into);
        }
        self.size == wanted
    }

    /// Tells the program that the window closes.
    pub(super) fn say_goodbye(&mut self) -> Result<(), Failure> {
        if !self.loaded {
            return Ok(());
        }
        let camera = self.viewpoint.camera(self.picture_size());
        self.host.close(&shown(camera, &self.scenery, &self.manner))
    }

    /// Frees everything; an error is what the validation layer has reported about it.
    pub(super) fn close(self) -> Result<(), Failure> {
        Ok(self.windowed.close()?)
    }

    /// Frees what is on the device, after a failure.
    pub(super) fn abandon(self) {
        // The window is left to the end of the process: freeing it talks to a server that may be gone, and Xlib would
        // then end the process before the failure is reported.
        std::mem::forget(self.window);
        drop(self.windowed);
    }
}

/// What there is to see by a camera.
fn shown<'a>(camera: Camera, scenery: &'a Scenery, manner: &'a Manner) -> Shown<'a> {
    let plan = FacePlan::new(scenery, manner, &camera);
    Shown {
        camera,
        clips: &scenery.clips,
        settings: &manner.settings,
        faces: plan.map_or_else(|_| FaceView::default(), |_| manner.faces),
        notes: &scenery.notes,
    }
}

/// Switches something on or off, whichever it is not where that is not said.
fn switch(is: &mut bool, on: Option<bool>) {
    *is = on.unwrap_or(!*is);
}
