//! `rara view`: a window on a scene, with clip shapes to drag through it.

mod action;
mod app;
mod camera_flags;
mod cut;
mod display;
mod dropped;
mod flags;
mod frames;
mod grip;
mod input;
mod layer_flags;
mod layers;
mod loading;
mod lost;
mod numbers;
mod opening;
mod outlines;
mod overlay;
mod scenery;
mod script;
mod shots;
mod stage;
mod text;
mod title;
mod viewpoint;

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::{Camera, ClipOp, Scene};

use self::cut::ClipEditor;
use self::input::KEYS;
use self::loading::LoadedWindow;
use self::scenery::Manner;
use self::shots::Shots;
use super::camera::CameraArgs;
use super::clip::Regions;
use super::failure::Failure;
use super::frame::FrameArgs;
use super::framing::Visible;
use super::scenes::SceneArgs;
use super::section::{SectionArgs, Sections};
use super::views::Views;
use super::{output, values};

/// Look at a scene in a window, and drag clip shapes through it
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara view scene.ply
  rara view scene.ply --clip plane:0,0,1,-2 --mode hard --size 1600x900
  rara view scene.ply --clip-expr 'all(box:0,0,0,1,1,1, not(sphere:1,0,0,.5))'
  rara view body.ply organ.ply --clip plane:1,0,0,0 --layer-clip organ=whole
  rara view scene.ply --section axial=0.4
  printf 'plane +0.1\\nscreenshot cut.png\\nquit\\n' | rara view scene.ply --script -

rara help view lists the keys, the mouse and the actions of scripts.")]
#[command(after_long_help = format!("\
{KEYS}

The window's title says what the last frame took on the device, and its three longest stages; T
prints all of them. A screenshot is what rara render draws with the same camera, clip and settings;
beside it goes its camera, for rara render --camera. Neither replaces a file.

Scripts, a line an action, # begins a comment; each is on the screen before the next:
  turn DX,DY             degrees          shape on, off, flip, next
  shift DX,DY            pixels           shape x, y, z        along an axis; a plane across it
  zoom STEPS                              shape +0.1, -0.1     along its normal, world units
  move X,Y,Z             world units      shape SHAPE          in the held one's place
  camera orbit, fly, reset, next          plane NX,NY,NZ,D     a plane in its place
  camera perspective, orthographic        drag DX,DY           pixels
  clip next              of a dropped file
  mode none, hard, rara, exact            tilt DX,DY           degrees
  screenshot [FILE]                       scale FACTOR
  resize WxH                              layer N|NAME [on|off]
  minimise, restore                       edit next, frame, N|NAME, release
  timings, flags                          outline on, off
  keys on, off                            numbers on, off
  drop FILE                               repeat N ACTION
  quit"))]
pub(super) struct ViewCommand {
    /// The screenshots' files, .png or .exr; {} becomes their number
    #[arg(short, long, value_name = "OUT", default_value = "view_{}.png", value_parser = values::picture_file())]
    output: PathBuf,
    /// Do what a file says, or standard input for -, one action a line
    ///
    /// The actions are listed below. Without quit the window stays. A step that fails is exit status 1.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Begin without the outlines of the shapes, which the key B brings
    #[arg(long)]
    no_outline: bool,
    /// Begin without text over the picture
    ///
    /// The hint is left out, and so are the clip's numbers, which the key M brings. What fails is written there all
    /// the same, and how far the reading of a scene has come.
    #[arg(long)]
    no_text: bool,
    #[command(flatten)]
    section: SectionArgs,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

/// A window that fits most screens.
const SIZE: (u32, u32) = (1280, 720);

/// What is looked at first.
enum Begin {
    /// The cameras, under the clip that was typed.
    Views(Views, Regions),
    Section(Sections),
}

impl ViewCommand {
    pub(super) fn run(self) -> Result<(), Failure> {
        let settings = self.frame.settings.meant()?;
        let clip = &self.frame.clip;
        let camera = self.frame.camera.sized_by_default(SIZE);
        let begin = match self.section.meant(&camera, clip)? {
            Some(sections) => Begin::Section(single(sections)?),
            None => Begin::Views(camera.meant(&self.scenes.places())?, clip.meant()?),
        };
        let shots = shots(&self.output)?;
        let follow = self.script.as_deref() == Some(Path::new("-"));
        let is_streamed = |place: &PathBuf| place == Path::new(values::STANDARD);
        if follow && self.scenes.places().iter().any(is_streamed) {
            return Err(Failure::Usage(
                "--script -: standard input is the scene's; give the script as a file".into(),
            ));
        }
        let script = match &self.script {
            Some(file) if !follow => script::read(file)?,
            _ => Vec::new(),
        };
        let size = begin.size(&camera)?;
        let events = display::connect()?;

        let (scenes, up) = (self.scenes, camera.up());
        app::run(
            events,
            app::Start {
                device: self.frame.device.meant(),
                size,
                manner: Manner {
                    sh: settings.precision.sh,
                    settings,
                    up: camera.chosen_up(),
                    outlined: !self.no_outline,
                    text: !self.no_text,
                    shots,
                },
                load: Box::new(move |watch| {
                    let mut loaded = scenes.load_watched(watch)?;
                    begin.regions().settle(&mut loaded)?;
                    LoadedWindow::new(loaded, begin, up, &scenes.typed())
                }),
                script,
                follow,
            },
        )
    }
}

impl Begin {
    /// Cameras without a clip.
    fn unclipped(views: Views) -> Self {
        Self::Views(views, Regions::default())
    }

    fn size(&self, camera: &CameraArgs) -> Result<(u32, u32), Failure> {
        match self {
            Self::Views(Views::Given(views), _) => {
                let first = views
                    .first()
                    .map(|view| (view.camera.width, view.camera.height));
                first.ok_or_else(|| Failure::Usage("--cameras: the file has no camera".into()))
            }
            Self::Views(Views::Framed(framed), _) => Ok(framed.size),
            _ => Ok(camera.chosen_size()),
        }
    }

    /// What clips, but for a section's own plane.
    fn regions(&self) -> &Regions {
        match self {
            Self::Views(_, regions) => regions,
            Self::Section(sections) => sections.regions(),
        }
    }

    /// The cameras, each with its up direction, and the clip, once the scene is known.
    fn cameras(
        self,
        (scene, visible): (&Scene<'_>, &Visible),
        up: Option<DVec3>,
        centre: DVec3,
    ) -> Result<(Vec<(Camera, DVec3)>, ClipEditor), Failure> {
        // Where a file or a section places the camera, up is what is up in its own picture.
        let own_up = |camera: &Camera| -camera.rotation.row(1);
        match self {
            Self::Views(views, regions) => {
                views.note().into_iter().for_each(output::say);
                let up = views.up().or(up);
                let views = super::framing::views_of(views, visible)?
                    .into_iter()
                    .map(|view| view.camera);
                let views = views.map(|camera| (camera, up.unwrap_or(own_up(&camera))));
                let cut = ClipEditor::new(regions.expressions(scene)?, regions.op(), centre);
                Ok((views.collect(), cut))
            }
            Self::Section(sections) => {
                let mut views = Vec::new();
                let mut cut = ClipEditor::new(Vec::new(), ClipOp::And, centre);
                for section in sections.sections(scene)? {
                    views.push((section.view.camera, own_up(&section.view.camera)));
                    cut = ClipEditor::of_section(section.own, section.others, centre);
                }
                Ok((views, cut))
            }
        }
    }
}

/// Refuses a series of sections: a window has one camera and one clip.
fn single(sections: Sections) -> Result<Sections, Failure> {
    match sections.numbers().count() {
        1 => Ok(sections),
        count => Err(Failure::Usage(format!(
            "--section: a window shows one section, and these are {count}; give one, as axial=0.4, and move it with Page Up \
             and Page Down, or draw all of them with rara render"
        ))),
    }
}

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
