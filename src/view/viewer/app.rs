//! The event loop: it opens a window, turns events into actions, and draws a frame when something has changed. Without
//! events and a script to follow it sleeps, and looks twice a second whether an event has woken nobody.

use std::collections::VecDeque;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec2;
use rara::Error;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::{Window, WindowId};

use super::action::Action;
use super::desc::ViewerDesc;
use super::display::{Connection, without_place};
use super::failure::Failure;
use super::host::Host;
use super::input::Input;
use super::lost;
use super::scenery::{FaceView, Manner};
use super::stage::{AppEvent, Viewer};
use crate::Windowed;

struct App {
    /// What is opened, and by whom, until it is.
    start: Option<(ViewerDesc, Box<dyn Host>)>,
    proxy: EventLoopProxy<AppEvent>,
    stage: Option<Viewer>,
    input: Input,
    script: VecDeque<Action>,
    /// The script goes on when the window has this size; it fails at that time.
    resizing: Option<((u32, u32), Instant)>,
    /// How many warnings there were before the script's last step, where that opens a file.
    opens_after: Option<u32>,
    /// True once a step of the script has failed.
    has_failed: bool,
    /// The time at which held keys last moved the view.
    moved_at: Option<Instant>,
    failure: Option<Failure>,
}

/// Window managers may take their time with a new size.
const RESIZE_PATIENCE: Duration = Duration::from_secs(5);
/// The loop sleeps no longer. Threads of a driver that present a frame read from the display's connection as well, and keep
/// the events that they find there for this program without waking it.
const LONGEST_SLEEP: Duration = Duration::from_millis(500);
/// A frame that took longer moves the view no farther than this.
const LONGEST_STEP: Duration = Duration::from_millis(100);

impl Connection {
    /// Opens the window and stays until it is closed.
    ///
    /// # Errors
    /// What ended it: the first scene could not be read, the device or the window failed, or a step of the script did.
    pub fn run(self, mut desc: ViewerDesc, host: impl Host + 'static) -> Result<(), Failure> {
        let Self(events) = self;
        let proxy = events.create_proxy();
        if let Some(follow) = desc.follow.take() {
            let proxy = proxy.clone();
            // The thread ends with what it follows, or with the program.
            thread::spawn(move || {
                follow(&mut |actions| proxy.send_event(AppEvent::Script(actions)).is_ok());
            });
        }
        let mut app = App {
            script: std::mem::take(&mut desc.script).into(),
            start: Some((desc, Box::new(host))),
            proxy,
            stage: None,
            input: Input::default(),
            resizing: None,
            opens_after: None,
            has_failed: false,
            moved_at: None,
            failure: None,
        };
        let Some(ran) = lost::unless_lost(|| events.run_app(&mut app)) else {
            if let Some(stage) = app.stage.take() {
                stage.abandon();
            }
            return Err(lost::failure());
        };
        if let Some(failure) = app.failure {
            return Err(failure);
        }
        if app.has_failed {
            let message = "a file could not be opened, as said above";
            return Err(Failure::Script(message.into()));
        }
        ran.map_err(|error| Error::Device(format!("the window's events ended: {error}")).into())
    }
}

impl App {
    fn open(
        &mut self,
        events: &ActiveEventLoop,
        (desc, mut host): (ViewerDesc, Box<dyn Host>),
    ) -> Result<(), Failure> {
        let (width, height) = desc.size;
        let attributes = Window::default_attributes()
            .with_title("rara")
            .with_inner_size(PhysicalSize::new(width, height));
        let window = events.create_window(attributes).map_err(|error| {
            Error::Device(format!(
                "a window of {width}x{height} pixels could not be opened ({}); try a smaller one, or draw without a \
                 window (rara render)",
                without_place(&error.to_string())
            ))
        })?;
        let window = Arc::new(window);
        let mut windowed = Windowed::new(&desc.device, window.clone())?;
        windowed.compile_ahead(desc.limits())?;
        host.say(&format_args!(
            "device   {} ({}), {:?}; H lists the keys",
            windowed.device().info().name,
            windowed.device().info().driver,
            windowed.format()
        ));
        let manner = Manner {
            settings: desc.settings,
            up: desc.up,
            faces: FaceView::default(),
            outlined: desc.outlined,
            text: desc.text,
        };
        let stage = Viewer::new(windowed, window, self.proxy.clone(), (host, manner))?;
        self.stage.insert(stage).load(desc.load)
    }

    /// Keeps a failure and ends the loop; of several failures the first is kept.
    fn end(&mut self, events: &ActiveEventLoop, outcome: Result<(), Failure>) {
        if let Err(failure) = outcome {
            self.failure.get_or_insert(failure);
            events.exit();
        }
    }

    fn handle(&mut self, events: &ActiveEventLoop, event: WindowEvent) -> Result<(), Failure> {
        let Some(stage) = &mut self.stage else {
            return Ok(());
        };
        let action = match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => Some(Action::Quit),
            WindowEvent::RedrawRequested => {
                if stage.visible() {
                    stage.draw()?;
                }
                None
            }
            WindowEvent::Resized(size) => {
                let size = (size.width, size.height);
                self.resizing = self.resizing.filter(|(wanted, _)| *wanted != size);
                stage.resized(size)?;
                None
            }
            WindowEvent::Occluded(occluded) => {
                stage.occlude(occluded)?;
                None
            }
            WindowEvent::Focused(true) => {
                stage.focus()?;
                None
            }
            WindowEvent::Focused(false) => {
                self.input.release();
                stage.drawn.clear();
                None
            }
            WindowEvent::ModifiersChanged(modifiers) => {
                self.input.modifiers(modifiers.state());
                None
            }
            WindowEvent::ScaleFactorChanged { scale_factor, .. } => {
                stage.rescaled(scale_factor);
                None
            }
            WindowEvent::DroppedFile(file) => Some(Action::Drop(file)),
            // A key that is down when the window gets the keyboard was pressed for another window, or is reported once more.
            WindowEvent::KeyboardInput {
                event,
                is_synthetic: true,
                ..
            } if event.state.is_pressed() => None,
            WindowEvent::KeyboardInput { event, .. } => {
                stage.dirty |= event.state.is_pressed() && stage.overlay.hush();
                self.input.key(
                    &event.logical_key,
                    event.physical_key,
                    event.state,
                    event.repeat,
                )
            }
            WindowEvent::MouseInput { state, button, .. } => self.input.button(button, state),
            WindowEvent::CursorMoved { position, .. } => {
                let to = DVec2::new(position.x, position.y);
                self.input.cursor(to, stage.size().1)
            }
            WindowEvent::MouseWheel { delta, .. } => Some(self.input.wheel(delta)),
            _ => None,
        };
        match action {
            Some(Action::Quit) => events.exit(),
            Some(action @ Action::Screenshot(_)) => match stage.act(action) {
                // A full disk is no reason to close the window.
                Err(failure) if failure.concerns_a_file() => stage.warn(failure),
                outcome => outcome?,
            },
            Some(action) => match stage.act(action) {
                // A key may ask for a layer that is not there.
                Err(failure @ Failure::Asked(_)) => stage.warn(failure),
                outcome => outcome?,
            },
            None => {}
        }
        Ok(())
    }

    /// Runs the script as far as the results of what it did before are on the screen.
    fn follow(&mut self, events: &ActiveEventLoop) -> Result<(), Failure> {
        let Some(stage) = &mut self.stage else {
            return Ok(());
        };
        while self.resizing.is_none()
            && !stage.waits_for_files()
            && !(stage.dirty && stage.visible())
        {
            let warnings = stage.warnings;
            self.has_failed |= self.opens_after.take().is_some_and(|had| had < warnings);
            let waits = |action: &Action| stage.unsettled && stage.visible() && !action.moves();
            if self.script.front().is_some_and(waits) {
                break;
            }
            match self.script.pop_front() {
                None => break,
                Some(Action::Quit) => {
                    self.script.clear();
                    events.exit();
                }
                Some(Action::Resize(size)) if !stage.resize(size) => {
                    self.resizing = Some((size, Instant::now() + RESIZE_PATIENCE));
                }
                Some(Action::Resize(_)) => stage.changed()?,
                Some(action) => {
                    if matches!(action, Action::Drop(_)) {
                        self.opens_after = Some(stage.warnings);
                    }
                    stage.act(action)?;
                    // A hidden window has no frame after which what is dropped is opened.
                    stage.open_dropped()?;
                }
            }
        }
        match self.resizing {
            Some(((width, height), until)) if Instant::now() >= until => {
                let (w, h) = stage.size();
                Err(Failure::Script(format!(
                    "resize {width}x{height}: the window stays {w}x{h}; its display or window manager allows no other size"
                )))
            }
            _ => Ok(()),
        }
    }

    fn fly(&mut self) {
        let direction = self.input.direction();
        let now = Instant::now();
        let before = self.moved_at.take();
        if let Some(stage) = self.stage.as_mut().filter(|stage| stage.visible())
            && direction != glam::DVec3::ZERO
        {
            // At most once a frame: what has moved is drawn first.
            if stage.dirty {
                self.moved_at = before.or(Some(now));
                return;
            }
            let time = before.map_or(Duration::from_millis(16), |at| (now - at).min(LONGEST_STEP));
            stage.fly(direction, time);
            self.moved_at = Some(now);
        }
    }
}

impl ApplicationHandler<AppEvent> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if let Some(start) = self.start.take() {
            let opened = self.open(events, start);
            self.end(events, opened);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, sent: AppEvent) {
        match (sent, &mut self.stage) {
            (AppEvent::Script(Ok(actions)), _) => self.script.extend(actions),
            (AppEvent::Script(Err(failure)), _) => self.end(events, Err(failure)),
            (AppEvent::Read(outcome), Some(stage)) => {
                let arrived = stage.arrive(*outcome);
                self.end(events, arrived);
            }
            (AppEvent::Read(_), None) => {}
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let handled = self.handle(events, event);
        self.end(events, handled);
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if events.exiting() {
            return;
        }
        if let Some(stage) = &mut self.stage {
            let opened = stage.open_dropped();
            self.end(events, opened);
        }
        self.fly();
        let followed = self.follow(events);
        self.end(events, followed);
        let mut until = Instant::now() + LONGEST_SLEEP;
        if let Some((_, patience)) = self.resizing {
            until = until.min(patience);
        }
        if let Some(stage) = &mut self.stage
            && stage.visible()
        {
            let changes = stage.changes_by_itself(Instant::now());
            until = changes.map_or(until, |change| until.min(change));
            if stage.dirty || stage.unsettled {
                stage.window.request_redraw();
            }
        }
        events.set_control_flow(ControlFlow::WaitUntil(until));
    }

    /// Frees everything while the display is still there.
    fn exiting(&mut self, _: &ActiveEventLoop) {
        let Some(mut stage) = self.stage.take() else {
            return;
        };
        let saved = stage.say_goodbye();
        let closed = match self.failure {
            Some(_) => {
                stage.abandon();
                Ok(())
            }
            None => stage.close(),
        };
        self.failure = self.failure.take().or(saved.and(closed).err());
    }
}
