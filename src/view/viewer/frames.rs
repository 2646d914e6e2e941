//! The frames of an open window, and what is said over them and in the title.

use std::time::{Duration, Instant};

use super::failure::Failure;
use super::lasso;
use super::loading::Loading;
use super::outlines;
use super::overlay::OverlayScene;
use super::scenery::{FaceView, Scenery};
use super::slices::FacePlan;
use super::stage::Viewer;
use super::text::ProgressBar;
use super::title;
use crate::Redraw;

/// The title changes no more often than this, since each change costs the window system a message.
const TITLE_PAUSE: Duration = Duration::from_millis(200);
/// The frames over which the window says that shaders are compiled, from each frame that needed it on: the first frames in a new way
/// are drawn once more from nothing, which needs further shaders.
const COMPILING: u32 = 4;
/// The most times between frames that are kept.
const INTERVALS: usize = 10_000;

impl Viewer {
    pub(super) fn draw(&mut self) -> Result<(), Failure> {
        let Some(size) = self.windowed.fit(self.size())? else {
            // An event will report the next size.
            (self.dirty, self.unsettled) = (false, false);
            return Ok(());
        };
        if !self.loaded {
            self.lay_over(size);
            let background = self.manner.settings.background.unwrap_or_default();
            let redraw = self.windowed.show_panels(background)?;
            (self.dirty, self.unsettled) = (redraw == Redraw::Now, false);
            return Ok(());
        }
        let camera = self.viewpoint.camera(size);
        let Scenery {
            clips,
            centre,
            radius,
            ..
        } = &mut self.scenery;
        let before = clips.apply(&mut self.windowed)?;
        let clip = clips.frame.clip();
        let mut lines = match self.manner.outlined {
            true => outlines::lines(clips, &camera, (*centre, *radius)),
            false => Vec::new(),
        };
        lines.extend(lasso::lines(&self.drawn, &camera, *radius));
        let plan = FacePlan::new(&self.scenery, &self.manner, &camera);
        let wanted = plan.as_ref().ok().and_then(Option::as_ref);
        let is_covered = self.faces.uncover(&mut self.windowed, wanted);
        let settings = self.manner.settings;
        if self.windowed.compiles(&camera, &clip, &settings)? {
            self.shown_at = None; // the next frame does not follow at once
            if std::mem::replace(&mut self.compiling, COMPILING) == 0 {
                self.scenery.clips.take_back(&mut self.windowed, before)?;
                return self.say_that_shaders_compile(size);
            }
        }
        self.lay_over(size);
        self.windowed.set_lines(lines);
        let frame = (camera, clip, settings);
        let redraw = self.windowed.show(&frame.0, &frame.1, &frame.2)?;
        self.last = Some(frame);
        self.compiling = match redraw {
            Redraw::NotNeeded => 0,
            _ => self.compiling.saturating_sub(1),
        };
        self.dirty = redraw == Redraw::Now;
        self.unsettled = redraw == Redraw::WhenIdle;
        let now = Instant::now();
        // A frame that only asks for numbers does not count, since nobody waits for it.
        if let Some(before) = self.shown_at.take().filter(|_| self.unsettled)
            && self.intervals.len() < INTERVALS
        {
            self.intervals.push(now - before);
        }
        if self.unsettled {
            self.shown_at = Some(now);
        }
        self.faces.announced &= redraw != Redraw::WhenIdle;
        if redraw == Redraw::NotNeeded {
            self.overlay.scene_is_seen();
            self.tell_of_faces(plan.as_ref().err().copied());
            if let Ok(Some(plan)) = plan
                && !is_covered
            {
                self.cover(plan)?;
            }
        }
        // The numbers that are known now may be others than those over the picture.
        self.dirty |= redraw == Redraw::NotNeeded && self.overlay.is_old(&self.seen(size));
        if redraw == Redraw::NotNeeded || self.titled_at.is_none_or(|at| now - at >= TITLE_PAUSE) {
            self.titled_at = Some(now);
            self.entitle();
        }
        Ok(())
    }

    /// Shows cut faces with the next frame, since the view rests.
    fn cover(&mut self, plan: FacePlan) -> Result<(), Failure> {
        self.dirty = true;
        self.shown_at = None; // the next frame does not follow at once
        let cut = (plan, &self.scenery.scene);
        let covered = self.faces.cover(&mut self.windowed, cut);
        match covered.map_err(Failure::from) {
            // The window goes on without them.
            Err(failure) if failure.is_of_the_scene() => {
                self.manner.faces = FaceView::default();
                self.warn(failure);
                Ok(())
            }
            outcome => outcome,
        }
    }

    /// Tells once why there are no cut faces, if they are asked for.
    fn tell_of_faces(&mut self, why: Option<&'static str>) {
        self.faces.announced &= why.is_none();
        if std::mem::replace(&mut self.faces.told, why) == why {
            return;
        }
        if let Some(why) = why {
            self.overlay.tell(why.into());
            self.dirty = true;
        }
    }

    /// Shows the last frame once more, or nothing before the first, and over it that the next one has to compile shaders.
    fn say_that_shaders_compile(&mut self, size: (u32, u32)) -> Result<(), Failure> {
        self.lay_over(size);
        // A window without panels has its title.
        self.window.set_title("rara: compiling shaders");
        self.titled_at = None;
        // The size may have changed since, and with it what would have to be compiled.
        let last = self
            .last
            .as_ref()
            .filter(|last| (last.0.width, last.0.height) == size);
        match last {
            Some((camera, clip, settings))
                if !self.windowed.compiles(camera, clip, settings)? =>
            {
                self.windowed.show(camera, clip, settings)?;
            }
            _ => {
                let background = self.manner.settings.background.unwrap_or_default();
                self.windowed.show_panels(background)?;
            }
        }
        self.dirty = true;
        Ok(())
    }

    /// Lays over the picture what there is to say.
    fn lay_over(&mut self, size: (u32, u32)) {
        if let Some(panels) = self.overlay.panels(self.overlay.content(&self.seen(size))) {
            self.windowed.set_panels(&panels);
        }
    }

    /// What there is to say of the picture.
    fn seen(&self, size: (u32, u32)) -> OverlayScene<'_> {
        OverlayScene {
            clips: self.loaded.then_some(&self.scenery.clips),
            mode: self.manner.settings.mode,
            stats: self.windowed.stats(),
            progress: match (self.compiling > 0, self.faces.announced) {
                (true, _) => Some(("compiling shaders".into(), ProgressBar::Moving(0.5))),
                (_, true) => Some(("drawing cut faces".into(), ProgressBar::Moving(0.5))),
                _ => self.loading.as_ref().map(Loading::progress),
            },
            size,
            scale_factor: self.scale_factor,
        }
    }

    /// True when there is something else to say than what is written over the picture.
    pub(super) fn is_behind(&self) -> bool {
        self.overlay.is_old(&self.seen(self.size))
    }

    fn entitle(&self) {
        let Scenery { name, clips, .. } = &self.scenery;
        let mode = self.manner.settings.mode;
        let stats = self.windowed.stats();
        let text = title::title(name, mode.name(), clips.words().as_deref(), stats);
        self.window.set_title(&text);
    }
}
