//! `rara render`: pictures of a scene.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::{Aov, Camera, Clip, Scene, Settings};

use super::camera::{View, Views};
use super::clip::Regions;
use super::failure::Failure;
use super::film::{self, FilmArgs, Kind};
use super::frame::FrameArgs;
use super::framing;
use super::memory;
use super::output::{self, Progress};
use super::panorama::{self, Panorama, PanoramaArgs};
use super::path::PathArgs;
use super::pattern::filled;
use super::profile::{Profile, ProfileArgs};
use super::report::{Frame, Report};
use super::save_camera::SaveCameraArgs;
use super::scenes::SceneArgs;
use super::section::{Section, SectionArgs, Sections};
use super::session::Repeat;
use super::settings::name;
use super::slice::{Cut, SliceArgs, Slicer};
use super::values;

/// Draw one picture, one for each camera of a file, or a film
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara render scene.ply -o picture.png
  rara render scene.ply -o cut.png --clip plane:0,0,1,-2 --mode exact
  rara render scene.ply -o box.exr --clip box:0,0,0,1,1,2 --eye 3,-1,-4 --target 0,0,0
  rara render scene.ply -o cut.png --clip-file planes.json:axial
  rara render body.ply organ.ply -o both.png --background 1,1,1
  rara render scene.ply -o view_{}.png --cameras cameras.json --view all
  rara render scene.ply -o flat.png --ortho fit
  rara render scene.ply -o axial.png --section axial=0.4
  rara render scene.ply -o slab_{}.png --section coronal=0.1..0.9:9 --section-thickness 2
  rara render scene.ply -o slice.png --section axial=0.4 --slice --outline 1,1,0
  rara render scene.ply -o deep.exr --aov depth,normal,layer,weight,count
  rara render scene.ply -o round.mp4 --path orbit --frames 240 --background white
  rara render scene.ply -o way.apng --cameras cameras.json --path spline:0,7,12 --size 640x360
  rara render scene.ply -o room.png --panorama --eye 0,0,0
  rara render scene.ply --repeat 20 --json

Pictures: .png is 8-bit RGBA, un-premultiplied; .exr is 32-bit float RGBA, premultiplied.")]
pub(super) struct Render {
    #[command(flatten)]
    scenes: SceneArgs,
    /// The picture's file, .png or .exr; its folders are made; - is standard output, as --format says. {} becomes the number of
    /// the camera or section, {:04} the number with zeros before it, {name} its name. A name that ends in .apng is a film of
    /// all pictures; so is one in .mp4, .mov, .mkv or .webm, which ffmpeg encodes. May be left out with --json
    #[arg(short, long, value_name = "OUT", value_parser = values::film_file(), required_unless_present = "json")]
    output: Option<PathBuf>,
    /// Channels of the .exr beside its colours. Each is drawn by itself, and no time is reported of it
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "output")]
    aov: Vec<Aov>,
    /// Render N times, nothing carried over between them, and report the medians [default: as often as five frames need, but no
    /// longer than about 2 s]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    repeat: Option<u32>,
    /// Print the statistics as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    path: PathArgs,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    panorama: PanoramaArgs,
    #[command(flatten)]
    section: SectionArgs,
    #[command(flatten)]
    slice: SliceArgs,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    save_camera: SaveCameraArgs,
    #[command(flatten)]
    profile: ProfileArgs,
}

/// The pictures that are asked for.
enum Pictures {
    /// Of cameras, under one clip.
    Views(Views, Regions),
    Sections(Sections),
}

/// What becomes of the pictures.
struct Run {
    film: Option<Kind>,
    panorama: Option<Panorama>,
    /// True where frames are reported one by one.
    several: bool,
}

impl Run {
    /// Frames that make a picture.
    fn frames_a_picture(&self) -> usize {
        self.panorama.map_or(1, |_| Panorama::FACES)
    }

    /// The size of the picture that a camera makes.
    fn size(&self, camera: &Camera) -> (u32, u32) {
        let own = (camera.width, camera.height);
        self.panorama.map_or(own, Panorama::size)
    }
}

/// A picture that is to be drawn.
struct Planned {
    view: View,
    clip: Clip,
    section: Option<Section>,
}

impl Planned {
    /// A section's plane.
    fn cut(&self) -> Option<&Cut> {
        self.section.as_ref().map(|section| &section.cut)
    }
}

impl Pictures {
    /// Their numbers.
    fn numbers(&self) -> Vec<usize> {
        match self {
            Self::Views(views, _) => views.numbers().collect(),
            Self::Sections(sections) => sections.numbers().collect(),
        }
    }

    /// The pictures, once the scene is known.
    fn of(self, scene: &Scene<'_>) -> Result<Vec<Planned>, Failure> {
        Ok(match self {
            Self::Views(views, regions) => {
                let clip = regions.clip(scene)?;
                let views = framing::views(views, scene)?.into_iter();
                let planned = |view| Planned {
                    view,
                    clip: clip.clone(),
                    section: None,
                };
                views.map(planned).collect()
            }
            Self::Sections(sections) => {
                sections.save(scene)?;
                let sections = sections.of(scene)?.into_iter();
                let planned = |one: Section| Planned {
                    clip: one.clip(),
                    view: one.view.clone(),
                    section: Some(one),
                };
                sections.map(planned).collect()
            }
        })
    }
}

impl Render {
    pub(super) fn run(mut self) -> Result<(), Failure> {
        let mut settings = self.frame.settings.meant()?;
        let film = self.film.meant(self.output.as_deref())?;
        if film.is_some_and(Kind::is_opaque) && settings.background.is_none() {
            film::say_opaque();
            settings = settings.background(Some([0.0; 3]));
        }
        self.slice.check(&settings)?;
        let sections = self.section.meant(&self.frame.camera, &self.frame.clip)?;
        let panorama = self.panorama.meant(self.frame.camera.size())?;
        if let Some(panorama) = &panorama {
            let ahead = !self.path.moves();
            self.frame.camera.look_around(panorama.size(), ahead);
        }
        let pictures = match sections {
            Some(sections) => Pictures::Sections(sections),
            None => {
                let clip = self.frame.clip.meant()?;
                let views = self.path.views(&self.frame.camera, &self.scenes.places())?;
                if panorama.is_some() && matches!(views, Views::Framed { .. }) {
                    return Err(Failure::Usage(
                        "--panorama is what is seen from one place: say which by --eye, --camera or --cameras".into(),
                    ));
                }
                Pictures::Views(views, clip)
            }
        };
        let numbers = pictures.numbers();
        let several = self.frame.camera.all() || self.path.moves() || numbers.len() > 1;
        self.check_output(&numbers, several && film.is_none())?;

        let files = numbers
            .iter()
            .filter_map(|n| Some(filled(self.output.as_ref()?, *n, "")));
        let profile = self.profile.begin(&files.collect::<Vec<_>>())?;
        let run = Run {
            film,
            panorama,
            several: several || panorama.is_some(),
        };
        let done = self.draw(&profile, pictures, run, &settings);
        profile.end_after(done)
    }

    fn draw(
        &self,
        profile: &Profile,
        pictures: Pictures,
        run: Run,
        settings: &Settings,
    ) -> Result<(), Failure> {
        let loaded = profile.span("load", || self.scenes.load())?;
        let scene = loaded.scene();
        let mut planned = pictures.of(&scene)?;
        if let (Some(_), Some(up)) = (&run.panorama, self.horizon()) {
            for Planned { view, .. } in &mut planned {
                view.camera = panorama::levelled(view.camera, up);
            }
        }
        if run.film.is_none() {
            self.check_files(&planned)?;
        }
        self.save_camera.save(planned.iter().map(|one| &one.view))?;
        let sizes = planned.iter().map(|one| run.size(&one.view.camera));
        let kept = run.panorama.map_or(0, Panorama::kept_pixels);
        // A path has many pictures of one size.
        for size in sizes.clone().collect::<HashSet<_>>() {
            memory::check_picture(size, kept)?;
        }
        let size = match run.film {
            Some(_) => film::one_size(sizes)?,
            None => sizes.into_iter().next().unwrap_or((0, 0)),
        };
        let device = self.frame.device.meant();
        let mut session = profile.open(device, &scene, settings.precision.sh)?;
        let clips = loaded.has_clips() || planned.iter().any(|one| !one.clip.is_everything());
        let repeat = self.repeat(planned.len() * run.frames_a_picture());
        let mut frames = Vec::new();
        let mut written = Vec::new();
        let mut slicer = Slicer::new(&self.slice, &scene, self.frame.device.meant());
        let mut film = match (run.film, &self.output) {
            (Some(kind), Some(file)) => Some(self.film.begin(kind, file, size, planned.len())?),
            _ => None,
        };
        let mut progress = Progress::new("rendering");
        for (done, one) in planned.iter().enumerate() {
            progress.update(done as u64, planned.len() as u64);
            let path = self.picture_file(&one.view);
            let sliced = one.cut().filter(|_| self.slice.is_shown());
            let plane = one.cut().map(|cut| &cut.plane);
            let section = one.section.as_ref().filter(|_| sliced.is_none());
            let cut = section.map(|section| section.of_layers(&scene));
            if let Some(cut) = &cut {
                session.set_layer_clips(cut)?;
            }
            let scene = cut.as_ref().unwrap_or(&scene);
            let mut picture = None;
            if let Some(panorama) = &run.panorama {
                let mut faces = Vec::new();
                for face in panorama.faces(&one.view) {
                    let drawn = (&face.camera, &one.clip, settings);
                    let measured = session.measured_frame(drawn.0, drawn.1, drawn.2, repeat)?;
                    frames.push(Frame::new(&face, path.as_deref(), plane, measured));
                    if path.is_some() {
                        faces.push(session.last_picture()?);
                    }
                }
                if path.is_some() {
                    picture = Some(profile.span("panorama", || panorama.assembled(&faces)));
                }
            } else {
                let measured = match sliced {
                    Some(cut) => slicer.frame(&mut session, (&one.view, cut, settings), repeat)?,
                    None => {
                        session.measured_frame(&one.view.camera, &one.clip, settings, repeat)?
                    }
                };
                frames.push(Frame::new(&one.view, path.as_deref(), plane, measured));
                if path.is_some() {
                    picture = Some(session.last_picture()?);
                }
            }
            let (Some(mut picture), Some(path)) = (picture, path) else {
                continue;
            };
            if let Some(cut) = one.cut().filter(|_| slicer.has_cues()) {
                slicer.draw_cues(&mut picture, (&one.view, cut, settings))?;
            }
            if let Some(film) = &mut film {
                if !profile.span("encode", || film.add(&picture))? {
                    break;
                }
            } else if self.aov.is_empty() {
                profile.span("encode", || output::picture(&picture, &path))?;
            } else {
                let drawn = (&one.view.camera, &one.clip, settings);
                let channels = session.channels(&self.aov, scene, drawn)?;
                picture.save_with(&path, &channels)?;
            }
            if written.last() != Some(&path) {
                written.push(path);
            }
        }
        if let Some(film) = film {
            profile.span("encode", || film.finish())?;
        }
        drop(progress);
        slicer.close()?;

        let report = Report::new(&session, &loaded, size, name(settings.mode), &frames);
        let report = match run.several {
            true => report.with_frames(frames),
            false => report,
        };
        let report = match run.panorama {
            // Behind one who looks at a scene there is nothing.
            Some(_) => report.with_empty_frames(),
            None => report,
        };
        session.close()?;
        Ok(report.print(self.json, clips, &written)?)
    }

    /// The direction that is up in a panorama; none where cameras of a file have one of their own.
    fn horizon(&self) -> Option<DVec3> {
        let of_file = self.path.is_of_file();
        self.frame.camera.up().filter(|_| !of_file)
    }

    /// How often each of so many pictures is drawn.
    fn repeat(&self, pictures: usize) -> Repeat {
        match self.repeat {
            Some(repeat) => Repeat::Exactly(repeat),
            None if output::is_quiet() && !self.json => Repeat::Unmeasured,
            // A trace shows what happens in a frame; more of them would be harder to read.
            None if self.profile.is_traced() => Repeat::Exactly(1),
            None => Repeat::of_pictures(pictures),
        }
    }

    /// The file of the picture of a view.
    fn picture_file(&self, view: &View) -> Option<PathBuf> {
        Some(filled(self.output.as_ref()?, view.number, &view.name))
    }

    /// Makes the pictures' folders, and fails where two pictures would be one file.
    fn check_files(&self, planned: &[Planned]) -> Result<(), Failure> {
        let mut files = HashMap::new();
        let mut folders = HashSet::new();
        for one in planned {
            let Some(file) = self.picture_file(&one.view) else {
                return Ok(());
            };
            if folders.insert(file.parent().map(Path::to_owned)) {
                output::check_file(&file)?;
            }
            if let Some(other) = files.insert(file, &one.view.name) {
                return Err(Failure::Usage(format!(
                    "the pictures of {other} and {} would be one file: put {{}} where their number goes",
                    one.view.name
                )));
            }
        }
        Ok(())
    }

    /// Checks `-o` before any work is done.
    fn check_output(&self, numbers: &[usize], several: bool) -> Result<(), Failure> {
        let Some(pattern) = &self.output else {
            return Ok(());
        };
        if self.json && pattern == Path::new(values::STANDARD) {
            return Err(Failure::Usage(
                "-o - and --json both take standard output: name a file for the picture".into(),
            ));
        }
        let is_exr = pattern
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("exr"));
        if !self.aov.is_empty() && !is_exr {
            return Err(Failure::Usage(
                "--aov makes channels that only .exr files hold: give -o a name that ends in .exr"
                    .into(),
            ));
        }
        let first = numbers.first().copied().unwrap_or(0);
        if several && filled(pattern, 0, "a") == filled(pattern, 1, "b") {
            let what = match self.frame.camera.chosen_view() {
                Some(view) => &format!("--view {view} makes"),
                None if self.path.moves() => "--path makes",
                None => "these sections are",
            };
            let remedy = match pattern == Path::new(values::STANDARD) {
                true => {
                    "name a file with {} where their number goes, or give --format apng or rgba"
                }
                false => {
                    "put {} where their number goes, as in -o view_{}.png, or name a film, as film.apng"
                }
            };
            return Err(Failure::Usage(format!("{what} several pictures: {remedy}")));
        }
        // Folders whose names have a slot are made when all names are known.
        let is_one = |folder: &Path| filled(folder, 0, "a") == filled(folder, 1, "b");
        match pattern.parent().is_none_or(is_one) {
            true => Ok(output::check_file(&filled(pattern, first, "x"))?),
            false => Ok(()),
        }
    }
}
