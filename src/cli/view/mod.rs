//! `rara view`: a window on a scene, with clip shapes to drag through it.

mod camera_flags;
mod flags;
mod host;
mod layer_flags;
mod script;
mod shots;
mod timings;

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::scene::Bounds;
use rara::scene::layers::SceneLayers;
use rara::{Camera, Clip, ClipOp, Scene};
use rara_view::viewer::{ClipEditor, Connection, KEYS, SceneView, ViewerDesc, Watch};

use self::host::Program;
use self::shots::Shots;
use super::camera::CameraArgs;
use super::clip::Regions;
use super::failure::Failure;
use super::frame::FrameArgs;
use super::process::make_drivers_folder;
use super::scenes::SceneArgs;
use super::section::{SectionArgs, Sections};
use super::views::Views;
use super::{output, values};
use rara_shots::Visible;

/// Look at a scene in a window, and drag clip shapes through it
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara view scene.ply
  rara view scene.ply --clip plane:0,0,1,-2 --mode hard --size 1600x900
  rara view scene.ply --clip-expr 'all(box:0,0,0,1,1,1, not(sphere:1,0,0,.5))'
  rara view body.ply organ.ply --clip plane:1,0,0,0 --layer-clip organ=whole
  rara view scene.ply --section axial=40%
  printf 'shape +0.1\\nscreenshot cut.png\\nquit\\n' | rara view scene.ply --script -

rara help view lists what the keys and the mouse do, and the actions of scripts.")]
#[command(after_long_help = format!("\
{KEYS}

The window's title has the time of the last frame on the device, and of its three longest stages;
T prints the times of all stages. A screenshot is the picture that rara render draws with the same
camera, clip and settings. Its camera is saved next to it, for rara render --camera. Neither
overwrites an existing file.

The window keeps the scene's Gaussians in memory, from which it makes slices and tinted layers. Cut
faces are drawn when the view rests: while something moves, the window shows the scene without them.

Scripts have an action on each line, and # begins a comment. The window shows the result of an
action before the next one begins.

The view:
  turn DX,DY                       turns the view, degrees
  shift DX,DY                      moves sideways, pixels
  zoom STEPS                       moves nearer, steps of the mouse wheel
  move X,Y,Z                       moves right, down and forward, world units
  camera orbit, fly                chooses how the mouse moves the camera
  camera perspective, orthographic chooses the projection
  camera reset, next               goes back to the first camera, or takes the next one of the file
  up x, -x, y, -y, z, -z, X,Y,Z    makes this direction up in the picture
The clip:
  shape on, off                    switches the edited clip on or off
  shape flip                       keeps the other side of the held shape
  shape next                       takes hold of the next shape of the edited clip
  shape SHAPE                      replaces the held shape, as in shape sphere:0,0,0,1
  shape plane, box, sphere         puts this shape where the held shape is
  shape x, y, z                    turns the held shape to an axis
  shape +0.1, -0.1                 moves the held shape along its normal, world units
  plane NX,NY,NZ,D                 replaces the held shape by a plane
  drag DX,DY                       moves the held shape, pixels
  tilt DX,DY                       turns the held shape, degrees
  scale FACTOR                     makes the held shape larger or smaller
  edit frame, N|NAME, next         edits the clip of all layers (frame), or that of one layer
  edit release                     removes the edited layer's own clip
  clip next                        takes the next clip of a dropped file
  lasso X,Y;X,Y;...                keeps what this polygon holds, pixels; with a leading ! the rest
  undo                             takes back the last change of a clip
Layers:
  layer N|NAME on, off             shows or hides a layer
  layer N|NAME 40%                 draws it with this share of its opacity
  layer N|NAME tint COLOUR|none    mixes a colour into it
The window:
  mode none, hard, rara, exact     chooses how cut splats are drawn
  outline, slice, edge, rim on|off marks shapes and cut faces, as the keys B, 7, 8 and 9 do
  keys, numbers on|off             shows the list of keys, or the clip's numbers
  screenshot [FILE]                writes a screenshot
  resize WxH                       gives the window this size, pixels
  minimise, restore                hides the window, or shows it again
  timings, flags                   prints the stages' times, or the flags that draw the picture
  drop FILE                        opens a file as if it were dropped on the window
  repeat N ACTION                  does an action N times
  quit                             closes the window"))]
pub(super) struct ViewCommand {
    /// File names of screenshots, .png, .exr or .npy; {} becomes the number
    #[arg(short, long, value_name = "OUT", default_value = "view_{}.png", value_parser = values::picture_file())]
    output: PathBuf,
    /// Run the actions in a file, one per line; - reads standard input
    ///
    /// The actions are listed below. The window stays open unless the script closes it by the action quit. If an action
    /// fails, the exit status is 1.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Start without the outlines of clip shapes; the key B shows them
    #[arg(long)]
    no_outline: bool,
    /// Start without text over the picture
    ///
    /// The window shows neither the hint about the keys nor the mode and the clip's numbers; the key M shows these numbers.
    /// Errors and the progress of loading are still shown.
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
    pub(super) fn run(mut self) -> Result<(), Failure> {
        let mut settings = self.frame.settings.meant();
        self.frame.camera = self.frame.camera.sized_by_default(SIZE);
        let save_clip = self.frame.clip.take_save();
        if let Some(file) = &save_clip {
            output::check_file(file)?;
        }
        let camera = &self.frame.camera;
        let begin = match self.section.meant(camera, &self.frame.clip)? {
            Some(sections) => Begin::Section(single(sections)?),
            None => {
                let (staged, of_file, _) = self.frame.staged(settings)?;
                settings = of_file;
                Begin::Views(camera.meant(&self.scenes.places())?, staged)
            }
        };
        let shots = shots(&self.output)?;
        let follow = self.script.as_deref() == Some(Path::new("-"));
        let is_streamed = |place: &PathBuf| place == Path::new(output::STANDARD);
        if follow && self.scenes.places().iter().any(is_streamed) {
            return Err(Failure::Usage(
                "--script -: standard input is the scene's; give the script as a file".into(),
            ));
        }
        let script = match &self.script {
            Some(file) if !follow => script::read(file)?,
            _ => Vec::new(),
        };
        let size = begin.size(camera)?;
        let display = Connection::open()?;

        let (scenes, up) = (self.scenes, camera.up());
        let expected = (scenes.places().len() as u32, begin.example());
        let load = Box::new(move |watch: Watch<'_>| {
            let mut loaded = scenes.load_watched(&mut |reading| watch(host::progress(reading)))?;
            let begin = begin.with_lassos(&loaded.scene())?;
            begin.regions().settle(&mut loaded)?;
            let view = begin.view(loaded, up)?;
            Ok(view.notes(flags::typed(&scenes.typed())))
        });
        let mut desc = ViewerDesc::new(load)
            .device(self.frame.device.meant())
            .size(size)
            .settings(settings)
            .up(camera.chosen_up())
            .outlined(!self.no_outline)
            .text(!self.no_text)
            .expected(expected)
            .script(script);
        if follow {
            desc = desc.follow(Some(Box::new(script::follow)));
        }
        make_drivers_folder();
        Ok(display.run(desc, Program { shots, save_clip })?)
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
            Self::Views(Views::Framed(framed), _) => Ok(framed.framing.size),
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

    /// The same once the scene is known, in which the first picture's lassos hold something.
    fn with_lassos(self, scene: &Scene<'_>) -> Result<Self, Failure> {
        Ok(match self {
            Self::Views(views, mut regions) => {
                let views = regions.see_lassos(views, scene)?;
                Self::Views(views, regions)
            }
            section => section,
        })
    }

    /// The clip of the first picture in an example of a scene.
    fn example(&self) -> Clip {
        match self {
            Self::Views(_, regions) => regions.example(None),
            Self::Section(sections) => sections.example(),
        }
    }

    /// A scene as it is looked at first.
    fn view(self, loaded: SceneLayers, up: Option<DVec3>) -> Result<SceneView, Failure> {
        let scene = loaded.scene();
        let visible = Visible::of(&scene);
        let middle = Bounds::of(&scene).centre();
        let (views, frame) = self.cameras((&scene, &visible), up, middle)?;
        Ok(SceneView::new(loaded, &visible, views, frame))
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
                let views = views.showing(visible)?.into_iter().map(|view| view.camera);
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
            "--section: a window shows one section, and these are {count}; give one, as axial=40%, and move it with Page Up \
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
