//! `rara view`: a window on a scene, with a clip plane to drag through it.

mod action;
mod app;
mod cut;
mod flags;
mod input;
mod lost;
mod script;
mod shots;
mod stage;
mod title;
mod viewpoint;

use std::path::{Path, PathBuf};

use clap::Args;
use rara::Scene;
use rara::scene::Bounds;

use self::cut::Cut;
use self::input::KEYS;
use self::shots::Shots;
use self::stage::Scenery;
use super::failure::Failure;
use super::frame::FrameArgs;
use super::scenes::SceneArgs;
use super::{output, values};

/// Look at a scene in a window, and drag a clip plane through it
#[derive(Debug, Args)]
#[command(after_help = format!("\
{KEYS}

The window's title says what the last frame took on the device, and its three longest stages; T
prints all of them. A screenshot is what rara render draws with the same camera, clip and settings;
beside it goes its camera, for rara render --camera. Neither replaces a file.

Scripts, a line an action, # begins a comment; each is on the screen before the next:
  turn DX,DY             degrees          plane on, off, flip, next
  shift DX,DY            pixels           plane x, y, z        across an axis
  zoom STEPS                              plane +0.1, -0.1     along its normal, world units
  move X,Y,Z             world units      plane NX,NY,NZ,D
  camera orbit, fly, reset, next          drag DX,DY           pixels
  camera perspective, orthographic        tilt DX,DY           degrees
  mode none, hard, rara, exact            resize WxH
  screenshot [FILE]
  timings                                 minimise, restore
  repeat N ACTION                         quit

Examples:
  rara view scene.ply
  rara view scene.ply --clip plane:0,0,1,-2 --mode hard --size 1600x900
  printf 'plane +0.1\\nscreenshot cut.png\\nquit\\n' | rara view scene.ply --script -"))]
pub(super) struct View {
    #[command(flatten)]
    scenes: SceneArgs,
    /// The screenshots' files, .png or .exr; {} becomes their number
    #[arg(short, long, value_name = "OUT", default_value = "view_{}.png", value_parser = values::picture_path)]
    output: PathBuf,
    /// Do what a file says, or standard input for -, as for smoke tests: one action a line, see below. Without quit the
    /// window stays
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    #[command(flatten)]
    frame: FrameArgs,
}

/// A window that fits most screens.
const SIZE: (u32, u32) = (1280, 720);

impl View {
    pub(super) fn run(self) -> Result<(), Failure> {
        let settings = self.frame.settings.meant()?;
        let (clip, op) = (self.frame.clip.expressions()?, self.frame.clip.op());
        let camera = self.frame.camera.sized_by_default(SIZE);
        let views = camera.meant()?;
        let shots = shots(&self.output)?;
        let follow = self.script.as_deref() == Some(Path::new("-"));
        let script = match &self.script {
            Some(file) if !follow => script::read(file)?,
            _ => Vec::new(),
        };
        let events = app::connect()?;

        let loaded = self.scenes.load()?;
        let scene = loaded.scene();
        let views = views.of(&scene)?.into_iter();
        // Where a file places the camera, up is what is up in its own picture.
        let up = |camera: &rara::Camera| camera.rotation.transpose() * -glam::DVec3::Y;
        let views: Vec<_> = views
            .map(|view| (view.camera, camera.up().unwrap_or(up(&view.camera))))
            .collect();
        let Some((first, _)) = views.first() else {
            return Err(Failure::Usage("--cameras: the file has no camera".into()));
        };
        let bounds = Bounds::of(&scene);
        app::run(
            events,
            app::Start {
                device: self.frame.device.meant(),
                sh: settings.precision.sh,
                size: (first.width, first.height),
                scenery: Scenery {
                    name: name(&scene),
                    cut: Cut::new(clip, op, bounds.centre()),
                    settings,
                    centre: bounds.centre(),
                    radius: bounds.radius(),
                    shots,
                    views,
                },
                loaded,
                script,
                follow,
            },
        )
    }
}

/// Says what is wrong with `-o` before a window opens.
fn shots(pattern: &Path) -> Result<Shots, Failure> {
    let text = pattern.to_str().filter(|text| text.contains("{}"));
    let text = text.ok_or_else(|| {
        Failure::Usage(format!(
            "-o {}: put {{}} where the screenshots' number goes, as in -o view_{{}}.png",
            pattern.display()
        ))
    })?;
    output::check_file(Path::new(&text.replace("{}", "000")))?;
    Ok(Shots::new(text.to_owned()))
}

/// A short name for the title.
fn name(scene: &Scene<'_>) -> String {
    let first = scene.layers().first().map_or("", |layer| layer.name());
    match scene.layers().len() {
        0 | 1 => first.to_owned(),
        more => format!("{first} and {} more", more - 1),
    }
}
