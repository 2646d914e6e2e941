//! `rara sweep`: the camera stands still and a clip moves: a plane across the scene, or any region to another.

use std::cell::LazyCell;
use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use rara::clip::Expression;
use rara::{Bounds, Clip, Plane, Settings, Show};

use super::clip::{Regions, joined};
use super::combine::FrameSummary;
use super::failure::Failure;
use super::frame::FrameArgs;
use super::kept::SessionCache;
use super::layer_names;
use super::memory;
use super::near;
use super::pictures::{self, Destination, Order, PictureArgs, Pixels, Plan, RenderedPicture};
use super::profile::{Profile, ProfileArgs};
use super::report::{FrameRecord, RenderReport, SceneReport};
use super::save_camera::SaveCameraArgs;
use super::scenes::SceneArgs;
use super::values;
use super::views::Views;
use rara::scene::extent_along;
use rara::scene::layers::Region;

/// Move a plane across the scene, or change one clip into another, in equal steps
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara sweep scene.ply --clip-normal 0,0,1 -o frames
  rara sweep scene.ply --clip-normal 0,0,1 --frames 240 -o sweep.mp4 --background white
  rara sweep scene.ply --clip-normal 1,0,0 --frames 30 --mode hard --json
  rara sweep scene.ply --clip-normal 0,0,1 --clip-file planes.json:skin -o frames
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
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(required_unless_present = "from", conflicts_with = "from")]
    clip_normal: Option<DVec3>,
    /// The clip of the first frame, an expression as for --clip-expr
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    from: Option<Region>,
    /// The clip of the last frame; it has the same kinds of shapes in the same order as --from
    ///
    /// Points, sizes and radii are interpolated linearly, and rotations and normals along the shortest arcs.
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    to: Option<Region>,
    /// Number of frames
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
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

impl Sweep {
    pub(super) fn run(self) -> Result<(), Failure> {
        self.run_in(&mut SessionCache::default(), None)
    }

    /// What a run of many commands has to know before it draws any picture.
    pub(super) fn plan(&self) -> Result<Plan, Failure> {
        self.meant()?;
        let numbers: Vec<_> = (0..self.frames as usize).collect();
        let output = self.output.as_deref();
        let wanted = (&numbers[..], Some(SEVERAL));
        let destination = self.pictures.destination(output, wanted, None)?;
        Ok(destination.plan(
            (&self.scenes, self.frame.device.meant()),
            &numbers,
            self.frame.camera.chosen_size(),
        ))
    }

    /// What the flags mean: the settings, the shapes that stand still, and the camera. Errors that do not depend on the scene
    /// are found before it is read.
    fn meant(&self) -> Result<(Settings, Regions, Views), Failure> {
        let (shapes, settings, _) = self.frame.staged(self.frame.settings.meant())?;
        if settings.show == Show::Count {
            pictures::needs_floats(self.output.as_deref(), pictures::COUNTS)?;
        }
        self.moving(|region| Ok(region.example().clone()))?;
        let views = self.frame.camera.meant(&self.scenes.places())?;
        Ok((settings, shapes, views.single("a sweep")?))
    }

    /// Draws the pictures that are in `order`, or all of them and reports them.
    pub(super) fn run_in(
        self,
        kept: &mut SessionCache,
        order: Option<&dyn Order>,
    ) -> Result<(), Failure> {
        let (settings, shapes, views) = self.meant()?;
        let numbers: Vec<_> = (0..self.frames as usize).collect();
        let output = self.output.as_deref();
        let wanted = (&numbers[..], Some(SEVERAL));
        let destination = self.pictures.destination(output, wanted, order)?;
        let settings = destination.settings(settings);

        let profile = self.profile.begin(|| destination.files(&numbers))?;
        let done = self.draw((&profile, kept), (views, shapes), &destination, &settings);
        profile.end_after(done)
    }

    /// What moves, between regions that are meant so.
    fn moving(
        &self,
        meant: impl Fn(&Region) -> rara::Result<Expression>,
    ) -> Result<SweepTarget, Failure> {
        let moving = match (self.clip_normal, &self.from, &self.to) {
            (Some(normal), ..) => {
                SweepTarget::Plane(Plane::new(normal, 0.0).map_err(Failure::usage)?.normal())
            }
            (None, Some(from), Some(to)) => SweepTarget::Region(meant(from)?, meant(to)?),
            _ => unreachable!("one of them is required"),
        };
        for index in 0..self.frames.min(MOST_TRIED) {
            let share = position((0.0, 1.0), index, self.frames.min(MOST_TRIED));
            moving.at(share).map_err(Failure::usage)?;
        }
        Ok(moving)
    }

    fn draw(
        &self,
        (profile, kept): (&Profile, &mut SessionCache),
        (views, regions): (Views, Regions),
        destination: &Destination<'_>,
        settings: &Settings,
    ) -> Result<(), Failure> {
        let (device, sh) = (&self.frame.device, settings.precision.sh);
        let session_of = (device, &self.profile, sh);
        let (mut place, mut loaded) = kept.load(profile, &self.scenes, &session_of)?;
        regions.settle(&mut loaded)?;
        layer_names::tell_own_clips(&loaded);
        let scene = loaded.scene();
        let bounds = LazyCell::new(|| Bounds::of(&scene));
        let moving = self.moving(|region| region.resolve(|| *bounds))?;
        let view = views.in_scene(&scene)?.remove(0);
        self.save_camera.save([&view].into_iter())?;
        let camera = view.camera;
        let (mut shapes, op) = (regions.expressions(&scene)?, regions.op());
        let called = |index: &u32| (*index as usize, view.name.clone());
        let Some(planned) = destination.left((0..self.frames).collect(), called)? else {
            return Ok(());
        };
        let range = match moving {
            SweepTarget::Plane(normal) => extent_along(&scene, normal),
            SweepTarget::Region(..) => (0.0, 1.0),
        };
        let size = (camera.width, camera.height);
        memory::check_picture(size, 0)?;
        let scene_report = SceneReport::new(&loaded);
        let whole = joined(&shapes, op);
        let taken = near::of(&scene, [(&view.name[..], &camera, &whole)].into_iter());
        let scene = match destination.order() {
            Some(_) => loaded.scene(), // later commands need the Gaussians again
            None => loaded.take_scene(),
        };
        let mut session = place.open(profile, device.meant(), scene, sh)?;
        if let Some(order) = destination.order() {
            order.opened(session.headless.driver());
        }
        let mut clip_of = |index| -> rara::Result<Clip> {
            shapes.push(moving.at(position(range, index, self.frames))?);
            let clip = joined(&shapes, op);
            shapes.pop();
            Ok(clip)
        };
        // The first frames, those that cut much and take over, and the last: together they need every shader.
        let middle = self.frames / 2;
        let first = [0, middle, middle + 1, middle + 2, self.frames - 1]
            .map(|index| clip_of(index.min(self.frames - 1)));
        let first = first.into_iter().collect::<rara::Result<Vec<_>>>()?;
        if destination.order().is_none() {
            session.warm_up(first.iter().map(|clip| (&camera, clip, settings)))?;
        }

        let written = destination.draw("sweeping", profile, (&planned, size), |one| {
            let (index, file) = (one.what, one.file.as_deref());
            let clip = clip_of(index)?;
            let measured = if self.independent || self.repeat > 1 {
                session.frame(&camera, &clip, settings, self.repeat)?
            } else {
                FrameSummary::from_frames(&[session.headless.render(&camera, &clip, settings)?])
            };
            let plane = moving.plane(position(range, index, self.frames))?;
            let frame = FrameRecord::new(&view, file, plane.as_ref(), measured);
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

enum SweepTarget {
    /// A plane of this unit normal, across the scene.
    Plane(DVec3),
    /// A region that moves from the first to the other.
    Region(Expression, Expression),
}

/// The most steps that are tried before the scene is read.
const MOST_TRIED: u32 = 1000;

impl SweepTarget {
    /// The clip in a position: of a plane along its normal, of a region the share of its way.
    fn at(&self, position: f64) -> rara::Result<Expression> {
        Ok(match self {
            Self::Plane(normal) => Expression::Shape(Plane::new(*normal, -position)?.into()),
            Self::Region(from, to) => from.between(to, position)?,
        })
    }

    fn plane(&self, position: f64) -> rara::Result<Option<Plane>> {
        match self {
            Self::Plane(normal) => Plane::new(*normal, -position).map(Some),
            Self::Region(..) => Ok(None),
        }
    }
}

/// The position in one frame: both ends included, the middle when there is one frame only.
fn position((from, to): (f64, f64), index: u32, frames: u32) -> f64 {
    match frames {
        1 => (from + to) / 2.0,
        _ => from + (to - from) * f64::from(index) / f64::from(frames - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_equal_and_reach_both_ends() {
        let positions = [0, 1, 2, 3, 4].map(|i| position((-1.0, 3.0), i, 5));
        assert_eq!(positions, [-1.0, 0.0, 1.0, 2.0, 3.0]);
        assert_eq!(position((-1.0, 3.0), 0, 1), 1.0);
    }
}
