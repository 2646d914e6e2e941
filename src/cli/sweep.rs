//! `rara sweep`: a clip moves: a plane across the scene, or any region to another. The camera stands still or moves too.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use rara::scene::layers::Region;
use rara::{Settings, Show};

use super::clip::{Regions, joined};
use super::combine::FrameSummary;
use super::failure::Failure;
use super::frame::FrameArgs;
use super::kept::SessionCache;
use super::layer_names;
use super::memory;
use super::moving::{Moving, MovingArgs};
use super::near;
use super::path::PathArgs;
use super::pictures::{
    self, Destination, Order, PictureArgs, PictureJob, Pixels, Plan, RenderedPicture,
};
use super::profile::{Profile, ProfileArgs};
use super::report::{FrameRecord, RenderReport, SceneReport};
use super::save_camera::SaveCameraArgs;
use super::scenes::SceneArgs;
use super::values;
use super::views::Views;

/// Move a plane across the scene, or change one clip into another, in equal steps
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara sweep scene.ply --clip-normal 0,0,1 -o frames
  rara sweep scene.ply --clip-normal 0,0,1 --frames 240 -o sweep.mp4 --background white
  rara sweep scene.ply --clip-normal 1,0,0 --frames 30 --mode hard --json
  rara sweep scene.ply --clip-normal 0,0,1 --clip-file planes.json:skin -o frames
  rara sweep scene.ply --clip-normal 0,0,1 --path orbit:0.5 --ease both --frames 240 -o round.mp4
  rara sweep scene.ply --from sphere:0,0,0,.1 --to sphere:0,0,0,2 -o frames
  rara sweep scene.ply --from 'all(plane:1,0,0,0, box:0,0,0,1,1,1)' --to 'all(plane:0,1,0,0, box:0,0,0,1,1,1)' -o turn

If a plane moves across the scene, the first frame keeps everything inside the robust bounds that rara info prints, and the
last frame keeps nothing inside them. From the third frame on, a frame computes only what the moving clip changes. The
shapes of --clip and similar flags do not move; --clip-op combines the moving shapes with them. The JSON has the statistics
of each frame, their medians at the top level, and their means under \"mean\".")]
pub(super) struct Sweep {
    /// File names of pictures, a folder or a film, as for rara render
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// The normal of a plane that moves across the scene; it points to the side that is kept
    ///
    /// rara sweep needs either this flag, or --from and --to.
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(conflicts_with = "from")]
    clip_normal: Option<DVec3>,
    #[command(flatten)]
    moving: MovingArgs,
    /// Render each frame without reusing results; the pictures are the same
    ///
    /// Without this flag, a frame reuses those results of the previous frame that the moving clip does not change.
    #[arg(long)]
    independent: bool,
    /// Render each frame N times, without reusing results, and report medians
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    repeat: u32,
    #[command(flatten)]
    pictures: PictureArgs,
    #[command(flatten)]
    path: PathArgs,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    save_camera: SaveCameraArgs,
    #[command(flatten)]
    profile: ProfileArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

/// What makes several pictures.
const SEVERAL: &str = "a sweep makes";

/// Pictures where nothing else is said.
const FRAMES: u32 = 30;

/// A sweep as its flags describe it, before the scene is known.
struct SweepPlan {
    settings: Settings,
    /// The shapes that stand still.
    regions: Regions,
    /// One camera, or one for each picture.
    views: Views,
    moving: Moving<Region>,
    frames: u32,
}

impl SweepPlan {
    fn numbers(&self) -> Vec<usize> {
        (0..self.frames as usize).collect()
    }
}

impl Sweep {
    pub(super) fn run(self) -> Result<(), Failure> {
        self.run_in(&mut SessionCache::default(), None)
    }

    /// What a run of many commands has to know before it draws any picture.
    pub(super) fn plan(&self) -> Result<Plan, Failure> {
        let meant = self.meant()?;
        let numbers = meant.numbers();
        let output = self.output.as_deref();
        let wanted = (&numbers[..], Some(SEVERAL));
        let destination = self.pictures.destination(output, wanted, None)?;
        Ok(destination.plan(
            (&self.scenes, self.frame.device.meant()),
            &numbers,
            self.frame.camera.chosen_size(),
        ))
    }

    /// What the flags mean. Errors that do not depend on the scene are found before it is read.
    fn meant(&self) -> Result<SweepPlan, Failure> {
        let (regions, settings, _) = self.frame.staged(self.frame.settings.meant())?;
        if settings.show == Show::Count {
            pictures::needs_floats(self.output.as_deref(), pictures::COUNTS)?;
        }
        let frames = self.path.frames().unwrap_or(FRAMES);
        let places = self.scenes.places();
        let mut views = self.path.views(&self.frame.camera, &places, frames)?;
        let frames = match self.path.moves() {
            true => views.numbers().count() as u32,
            false => {
                views = views.single("a sweep without --path")?;
                frames
            }
        };
        let pace = (frames, self.path.ease());
        let moving = self.moving.meant(self.clip_normal, pace)?;
        let moving = moving.ok_or_else(|| {
            Failure::Usage(
                "sweep needs a clip that moves: give --clip-normal for a plane that moves across the scene, or --from and --to \
                 for a clip that changes into another one"
                    .into(),
            )
        })?;
        Ok(SweepPlan {
            settings,
            regions,
            views,
            moving,
            frames,
        })
    }

    /// Draws the pictures that are in `order`, or all of them and reports them.
    pub(super) fn run_in(
        self,
        kept: &mut SessionCache,
        order: Option<&dyn Order>,
    ) -> Result<(), Failure> {
        let mut plan = self.meant()?;
        let numbers = plan.numbers();
        let output = self.output.as_deref();
        let wanted = (&numbers[..], Some(SEVERAL));
        let destination = self.pictures.destination(output, wanted, order)?;
        plan.settings = destination.settings(plan.settings);

        let profile = self.profile.begin(|| destination.files(&numbers))?;
        let done = self.draw((&profile, kept), plan, &destination);
        profile.end_after(done)
    }

    fn draw(
        &self,
        (profile, kept): (&Profile, &mut SessionCache),
        plan: SweepPlan,
        destination: &Destination<'_>,
    ) -> Result<(), Failure> {
        let SweepPlan {
            settings,
            mut regions,
            mut views,
            moving,
            frames,
        } = plan;
        let (device, sh) = (&self.frame.device, settings.precision.sh);
        let session_of = (device, &self.profile, sh);
        let example = (regions.example(moving.example()), settings);
        let first = profile.first_frame(device, &self.scenes, example);
        let (mut place, mut loaded) = kept.load(profile, &self.scenes, &session_of, first)?;
        views = regions.see_lassos(views, &loaded.scene())?;
        regions.settle(&mut loaded)?;
        layer_names::tell_own_clips(&loaded);
        let scene = loaded.scene();
        let moving = moving.in_scene(&scene)?;
        let views = views.in_scene(&scene)?;
        self.save_camera.save(views.iter())?;
        let view_of = |index: u32| &views[(index as usize).min(views.len() - 1)];
        let (shapes, op) = (regions.expressions(&scene)?, regions.op());
        let called = |index: &u32| (*index as usize, view_of(*index).name.clone());
        let Some(planned) = destination.left((0..frames).collect(), called)? else {
            return Ok(());
        };
        let size = |one: &PictureJob<u32>| {
            let camera = &view_of(one.what).camera;
            (camera.width, camera.height)
        };
        memory::check_pictures(planned.iter().map(size), 0)?;
        let size = destination.size(planned.iter().map(size))?;
        let scene_report = SceneReport::new(&loaded);
        let whole = joined(&shapes, op);
        let seen = views
            .iter()
            .map(|view| (&view.name[..], &view.camera, &whole));
        let taken = near::of(&scene, seen);
        let scene = match destination.order() {
            Some(_) => loaded.scene(), // later commands need the Gaussians again
            None => loaded.take_scene(),
        };
        let mut session = place.open(profile, device.meant(), scene, sh)?;
        if let Some(order) = destination.order() {
            order.opened(session.headless.driver());
        }
        let clip_of = |index| moving.clip(index, (&shapes, op));
        // The first frames, those that cut much and take over, and the last: together they need every shader.
        let (middle, last) = (frames / 2, frames - 1);
        let first = [0, middle, middle + 1, middle + 2, last].map(|index| index.min(last));
        let clips = first.map(clip_of).into_iter();
        let clips = clips.collect::<rara::Result<Vec<_>>>()?;
        if destination.order().is_none() {
            let frames = first.into_iter().zip(&clips);
            let frames = frames.map(|(index, clip)| (&view_of(index).camera, clip, &settings));
            session.warm_up(frames)?;
        }

        let written = destination.draw("sweeping", profile, (&planned, size), |one| {
            let (index, file) = (one.what, one.file.as_deref());
            let (view, clip) = (view_of(index), clip_of(index)?);
            let measured = if self.independent || self.repeat > 1 {
                session.frame(&view.camera, &clip, &settings, self.repeat)?
            } else {
                let drawn = session.headless.render(&view.camera, &clip, &settings)?;
                FrameSummary::from_frames(&[drawn])
            };
            let frame = FrameRecord::new(view, file, moving.plane(index)?.as_ref(), measured);
            let stored = file.map(|_| session.headless.read_back()).transpose()?;
            Ok(RenderedPicture {
                picture: stored.map(Pixels::Stored),
                ..frame.into()
            })
        })?;
        if destination.order().is_some() {
            return Ok(kept.keep(place, loaded, session)?);
        }

        let mode = settings.mode.to_string();
        let report = RenderReport::new(&session, scene_report, size, mode, &written.pictures);
        let report = report
            .with_frames(written.pictures)
            .with_mean()
            .with_near_cut(taken);
        session.headless.close()?;
        Ok(report.print(self.pictures.answer(), true, &written.files)?)
    }
}
