//! `rara sweep`: the camera stands still and one plane moves across the scene.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use rara::clip::Expression;
use rara::{Clip, Plane, Settings, Shape};

use super::camera::Views;
use super::failure::Failure;
use super::frame::FrameArgs;
use super::output::{self, Progress};
use super::profile::{Profile, ProfileArgs};
use super::report::Report;
use super::scenes::SceneArgs;
use super::settings::name;
use super::values;
use rara::scene::extent_along;

/// Move a clip plane across the scene in equal steps
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara sweep scene.ply --clip-normal 0,0,1 -o frames
  rara sweep scene.ply --clip-normal 1,0,0 --frames 30 --mode hard --json
  rara sweep scene.ply --clip-normal 0,0,1 --clip-file planes.json:skin -o frames

The first frame keeps the whole of the scene's robust bounds, the last one nothing of them. Pictures are
frame_000.png and so on. The third frame and those after it compute only what the plane changes. Other clip shapes stand still; --clip-op joins the moving plane to them too. The
JSON has the frames, their medians on top and their means under \"mean\".")]
pub(super) struct Sweep {
    #[command(flatten)]
    scenes: SceneArgs,
    /// The moving plane's normal; it points to the side that stays
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    clip_normal: DVec3,
    /// Number of frames
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// Folder for the pictures; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Render each frame from nothing; without this flag a frame takes over what stays the same, to the same bytes
    #[arg(long)]
    independent: bool,
    /// Render each frame N times, nothing carried over between them, and take the medians
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    repeat: u32,
    /// Print the statistics as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    profile: ProfileArgs,
}

impl Sweep {
    pub(super) fn run(self) -> Result<(), Failure> {
        let settings = self.frame.settings.meant()?;
        let plane: Shape = Plane::new(self.clip_normal, 0.0)
            .map_err(Failure::usage)?
            .into();
        // The shapes that stand still, and the one that moves.
        let mut shapes = self.frame.clip.expressions()?;
        shapes.push(Expression::Shape(plane));
        self.frame.camera.single("a sweep")?;
        let views = self.frame.camera.meant()?;
        if let Some(folder) = &self.output {
            output::make_folder(folder)?;
        }

        let profile = self.profile.begin(&[])?;
        let done = self.draw(&profile, views, shapes, &settings);
        profile.end_after(done)
    }

    /// `shapes` are those that stand still, and last the one that moves.
    fn draw(
        &self,
        profile: &Profile,
        views: Views,
        mut shapes: Vec<Expression>,
        settings: &Settings,
    ) -> Result<(), Failure> {
        let normal = Plane::new(self.clip_normal, 0.0)?.normal();
        let op = self.frame.clip.op();
        let loaded = profile.span("load", || self.scenes.load())?;
        let scene = loaded.scene();
        let camera = views.of(&scene)?.remove(0).camera;
        let range = extent_along(&scene, normal);
        let device = self.frame.device.meant();
        let mut session = profile.open(device, &scene, settings.precision.sh)?;
        let mut frames = Vec::new();
        let mut written = Vec::new();
        let mut progress = Progress::new("sweeping");
        for index in 0..self.frames {
            progress.update(index.into(), self.frames.into());
            let plane = Plane::new(normal, -position(range, index, self.frames))?;
            shapes.pop();
            shapes.push(Expression::Shape(Shape::from(plane)));
            let clip = Clip::joined(shapes.iter().map(Expression::clip), op);
            frames.push(if self.independent || self.repeat > 1 {
                session.frame(&camera, &clip, settings, self.repeat)?
            } else {
                session.next_frame(&camera, &clip, settings)?
            });
            if let Some(folder) = &self.output {
                let path = folder.join(format!("frame_{index:03}.png"));
                profile.save_picture(&mut session, &path)?;
                written.push(path);
            }
        }
        drop(progress);

        let size = (camera.width, camera.height);
        let report = Report::new(&session, &loaded, size, name(settings.mode), &frames);
        let report = report.with_frames(frames).with_mean();
        session.close()?;
        Ok(report.print(self.json, &written)?)
    }
}

/// The plane's position in one frame: both ends included, the middle when there is one frame only.
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
