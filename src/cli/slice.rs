//! `--slice`, `--outline` and `--rim`: what lies on a section's plane.

use clap::Args;
use rara::{Clip, Cue, Cues, HeadlessDesc, Picture, Plane, Raster, Scene, Settings, Show};
use rara_shots::Slice;

use super::combine::FrameSummary;
use super::failure::Failure;
use super::session::{Repeat, Session};
use super::values;
use super::views::NamedView;

/// What is shown of a section's plane.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sections")]
pub(super) struct SliceArgs {
    /// Show the colours on the section's plane, not the scene behind it
    ///
    /// The colour of a pixel is the mean of the splats' colours on the plane, each weighted by the splat's opacity there. The order
    /// of the splats has no effect.
    #[arg(long, conflicts_with = "aov")]
    slice: bool,
    /// Draw a line around each cut surface
    #[arg(long, value_name = "R,G,B", value_parser = values::colour)]
    outline: Option<[f32; 3]>,
    /// Width of the line of --outline, pixels
    #[arg(long, value_name = "PX", value_parser = values::positive, default_value_t = 2.0)]
    outline_width: f32,
    /// Tint each cut surface along its edge
    #[arg(long, value_name = "R,G,B", value_parser = values::colour)]
    rim: Option<[f32; 3]>,
    /// Width of the tint of --rim, pixels
    #[arg(long, value_name = "PX", value_parser = values::positive, default_value_t = 24.0)]
    rim_width: f32,
    /// Alpha from which a pixel of a slice counts as cut surface, 0 to 1
    ///
    /// --outline and --rim use it: they treat a pixel as cut surface if a picture with --slice would have at least this alpha
    /// there.
    #[arg(long, value_name = "ALPHA", value_parser = values::share, default_value_t = 0.1)]
    cut_level: f32,
}

/// A plane that is sliced, and the clip of what lies on it.
#[derive(Debug, Clone)]
pub(super) struct Cut {
    pub(super) plane: Plane,
    pub(super) rest: Clip,
}

impl SliceArgs {
    /// True when a slice takes the picture's place.
    pub(super) fn is_shown(&self) -> bool {
        self.slice
    }

    /// Refuses to draw a slice in another way than by tiles, before the scene is read.
    pub(super) fn check(&self, settings: &Settings) -> Result<(), Failure> {
        let raster = settings.raster;
        if !self.slice || matches!(raster, Raster::Auto | Raster::Tiles) {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "--slice is made by tiles alone, and --raster {raster} draws none: leave out one of them"
        )))
    }

    /// True when something is made of the scene's Gaussians once the scene is on the device.
    pub(super) fn needs_gaussians(&self) -> bool {
        self.slice || self.cues().is_some()
    }

    fn cues(&self) -> Option<Cues> {
        let mut cues = Cues::default();
        let cue = |width| move |colour| Cue { colour, width };
        cues.level = self.cut_level;
        cues.outline = self.outline.map(cue(self.outline_width));
        cues.rim = self.rim.map(cue(self.rim_width));
        (self.outline.is_some() || self.rim.is_some()).then_some(cues)
    }
}

pub(super) struct Slicer<'a> {
    args: &'a SliceArgs,
    scene: Scene<'a>,
    device: HeadlessDesc,
    /// A session that is opened for the first cue.
    session: Option<Session>,
}

impl<'a> Slicer<'a> {
    pub(super) fn new(args: &'a SliceArgs, scene: &Scene<'a>, device: HeadlessDesc) -> Self {
        Self {
            args,
            scene: scene.clone(),
            device,
            session: None,
        }
    }

    /// Draws a slice as the session's frame, in place of the session's scene.
    pub(super) fn frame(
        &self,
        session: &mut Session,
        (view, cut, settings): (&NamedView, &Cut, &Settings),
        repeat: Repeat,
    ) -> Result<FrameSummary, Failure> {
        let slice = Slice::new(&self.scene, &cut.plane);
        session
            .headless
            .load_as(slice.scene(), settings.precision.sh)?;
        let shown = settings.show(Show::Mean);
        Ok(session.measured_frame(&view.camera, &cut.rest, &shown, repeat)?)
    }

    /// Draws the cues onto the picture of a section, if there are any.
    pub(super) fn draw_cues(
        &mut self,
        picture: &mut Picture,
        (view, cut, settings): (&NamedView, &Cut, &Settings),
    ) -> Result<(), Failure> {
        let Some(cues) = self.args.cues() else {
            return Ok(());
        };
        let slice = Slice::new(&self.scene, &cut.plane);
        let scene = slice.scene();
        let sh = settings.precision.sh;
        let mut session = match self.session.take() {
            Some(mut session) => {
                session.headless.load_as(&scene, sh)?;
                session
            }
            None => Session::open(&self.device, &scene, sh)?,
        };
        // The picture may be drawn in any way; its slice is made by tiles alone.
        let shown = settings
            .show(Show::Mean)
            .raster(Raster::Auto)
            .background(None);
        let slice = session.picture(&view.camera, &cut.rest, &shown)?;
        self.session = Some(session);
        Ok(picture.draw_cues(&slice, &cues)?)
    }

    pub(super) fn has_cues(&self) -> bool {
        self.args.cues().is_some()
    }

    /// Frees what was opened for cues.
    pub(super) fn close(self) -> Result<(), Failure> {
        self.session
            .map_or(Ok(()), |session| Ok(session.headless.close()?))
    }
}
