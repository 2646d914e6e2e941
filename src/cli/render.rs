//! `rara render`: pictures of a scene.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use rara::scene::layers::Region;
use rara::{Aov, Camera, Clip, Picture, Scene, Settings, Show};
use rara_shots::{Face, Panorama, levelled};

use super::clip::{Regions, joined};
use super::failure::Failure;
use super::frame::FrameArgs;
use super::kept::SessionCache;
use super::labels::LabelArgs;
use super::memory;
use super::moving::{Moving, MovingArgs};
use super::near;
use super::output::{self, counted};
use super::panorama::PanoramaArgs;
use super::path::PathArgs;
use super::pictures::{
    self, Destination, Order, PictureArgs, PictureJob, Pixels, Plan, RenderedPicture,
};
use super::profile::{Profile, ProfileArgs};
use super::report::{self, Answer, FrameRecord, RenderReport, SceneReport};
use super::save_camera::SaveCameraArgs;
use super::scenes::SceneArgs;
use super::section::{Section, SectionArgs, Sections};
use super::session::{Repeat, Session};
use super::slice::{self, SliceArgs, Slicer};
use super::values;
use super::views::{NamedView, Views};

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
  rara render scene.ply -o axial.png --section axial=40%
  rara render scene.ply -o sheet.png --sheet --section coronal=10%..90%:9 --section-thickness 2
  rara render scene.ply -o slice.png --section axial=40% --slice --outline 1,1,0
  rara render scene.ply -o deep.exr --aov depth,normal,layer,weight,count
  rara render scene.ply -o round.mp4 --path orbit --frames 240 --background white
  rara render scene.ply -o way.apng --cameras cameras.json --path spline:0,7,12 --size 640x360
  rara render scene.ply -o open.mp4 --path orbit --from plane:z=0% --to plane:z=60% --ease both
  rara render scene.ply -o room.png --panorama --eye 0,0,0
  rara render scene.ply --repeat 20 --json

Pictures: .png is 8-bit RGBA, un-premultiplied; .exr is 32-bit float RGBA, premultiplied.

The program prints how many splats are `visible` (the clip keeps them whole), `cutoff` (it cuts them), `invisible` (it removes \
them) and `culled` (they are out of view, too faint or hidden).")]
pub(super) struct Render {
    /// A picture (.png, .exr, .npy) or film (.apng, .mp4, .mov, .mkv, .webm); - is stdout
    ///
    /// Folders that do not exist are created. {} becomes the number of the camera or section, {:04} the number with leading
    /// zeros, and {name} the name. If OUT is a folder or a name without an ending, several pictures are written into this
    /// folder as frame_000.png and so on. A film contains all pictures; .apng needs no other program, and the other films need ffmpeg. --format chooses what is
    /// written to standard output. With --json or --json-lines, --output is optional.
    #[arg(short, long, value_name = "OUT")]
    #[arg(required_unless_present_any = ["json", "json_lines"])]
    output: Option<PathBuf>,
    /// Extra channels, added to an .exr, or in separate files next to a .png (16 bits) or .npy
    ///
    /// Next to a.png, the files are a.depth.png, a.normal.png and so on. A 16-bit .png stores depths in thousandths of a world
    /// unit, normals from -1 to 1, weights from 0 to 1, counts as whole numbers, and layers as numbers from 1. The channels
    /// are drawn separately, and the reported times leave them out.
    #[arg(long, value_name = "LIST", value_parser = values::named::<Aov>(), value_delimiter = ',')]
    aov: Vec<Aov>,
    /// Render each picture N times, without reusing results, and report medians
    ///
    /// By default, rara renders each picture several times, until there are five frames of all pictures together or 2 s have
    /// passed, and reports medians. With --quiet, it renders each picture once.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    repeat: Option<u32>,
    #[command(flatten)]
    moving: MovingArgs,
    #[command(flatten)]
    pictures: PictureArgs,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    save_camera: SaveCameraArgs,
    #[command(flatten)]
    section: SectionArgs,
    #[command(flatten)]
    slice: SliceArgs,
    #[command(flatten)]
    labels: LabelArgs,
    #[command(flatten)]
    path: PathArgs,
    #[command(flatten)]
    panorama: PanoramaArgs,
    #[command(flatten)]
    profile: ProfileArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

/// Pictures of a path where nothing else is said: four seconds of a film.
const FRAMES: u32 = 120;

enum Pictures {
    /// Pictures of cameras, under one clip, and perhaps one that moves.
    Views(Views, Regions, Option<Box<Moving<Region>>>),
    Sections(Sections),
}

struct Shot {
    view: NamedView,
    clip: Clip,
    section: Option<Section>,
    /// The scene that it shows, where each picture has its own.
    moment: Option<usize>,
}

impl Shot {
    fn cut(&self) -> Option<&Face> {
        self.section.as_ref().map(|section| &section.cut)
    }
}

impl Pictures {
    fn numbers(&self) -> Vec<usize> {
        match self {
            Self::Views(views, ..) => views.numbers().collect(),
            Self::Sections(sections) => sections.numbers().collect(),
        }
    }

    /// Returns the clips of all pictures, without the planes of sections.
    fn regions(&self) -> &Regions {
        match self {
            Self::Views(_, regions, _) => regions,
            Self::Sections(sections) => sections.regions(),
        }
    }

    /// The same once the scene is known, in which the first picture's lassos hold something.
    fn with_lassos(self, scene: &Scene<'_>) -> Result<Self, Failure> {
        Ok(match self {
            Self::Views(views, mut regions, moving) => {
                let views = regions.see_lassos(views, scene)?;
                Self::Views(views, regions, moving)
            }
            sections => sections,
        })
    }

    /// The clip of the first picture in an example of a scene.
    fn example(&self) -> Clip {
        match self {
            Self::Views(_, regions, moving) => {
                regions.example(moving.as_ref().and_then(|moving| moving.example()))
            }
            Self::Sections(sections) => sections.example(),
        }
    }

    /// The pictures, once the scene is known.
    fn shots(self, scene: &Scene<'_>) -> Result<Vec<Shot>, Failure> {
        Ok(match self {
            Self::Views(views, regions, moving) => {
                let (still, op) = (regions.expressions(scene)?, regions.op());
                let moving = moving.map(|moving| moving.in_scene(scene)).transpose()?;
                let clip = joined(&still, op);
                let views = views.in_scene(scene)?.into_iter().zip(0..);
                let shot = |(view, index)| -> Result<Shot, Failure> {
                    Ok(Shot {
                        view,
                        clip: match &moving {
                            Some(moving) => moving.clip(index, (&still, op))?,
                            None => clip.clone(),
                        },
                        section: None,
                        moment: None,
                    })
                };
                views.map(shot).collect::<Result<_, _>>()?
            }
            Self::Sections(sections) => {
                let sections = sections.sections(scene)?.into_iter();
                let shot = |one: Section| Shot {
                    clip: one.clip(),
                    view: one.view.clone(),
                    section: Some(one),
                    moment: None,
                };
                sections.map(shot).collect()
            }
        })
    }
}

/// A picture of each scene, if there are several: by the same camera, or each by its own.
fn of_moments(shots: Vec<Shot>, moments: &[(usize, SceneArgs)]) -> Vec<Shot> {
    if moments.is_empty() {
        return shots;
    }
    let shot = |(at, (number, scenes)): (usize, &(usize, SceneArgs))| {
        let shot = shots.get(at).unwrap_or(&shots[0]);
        let file = scenes.places().into_iter().next().unwrap_or_default();
        let number = match shots.len() {
            1 => *number,
            _ => shot.view.number,
        };
        let view = NamedView {
            number,
            name: file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            ..shot.view.clone()
        };
        Shot {
            view,
            clip: shot.clip.clone(),
            section: None,
            moment: Some(at),
        }
    };
    moments.iter().enumerate().map(shot).collect()
}

/// What the flags mean, before the scene is known.
struct RenderPlan {
    settings: Settings,
    panorama: Option<Panorama>,
    pictures: Pictures,
    /// The scenes of the pictures, where each has its own.
    moments: Vec<(usize, SceneArgs)>,
    numbers: Vec<usize>,
    /// What makes several pictures, if anything does.
    several: Option<String>,
}

impl Render {
    pub(super) fn run(self) -> Result<(), Failure> {
        self.run_in(&mut SessionCache::default(), None)
    }

    /// What a run of many commands has to know before it draws any picture.
    pub(super) fn plan(mut self) -> Result<Plan, Failure> {
        let meant = self.meant()?;
        let numbers = &meant.numbers;
        let output = self.output.as_deref();
        let several = meant.several.as_deref();
        let destination = (self.pictures).destination(output, (numbers, several), None)?;
        let size = match (&meant.panorama, &meant.pictures) {
            (Some(panorama), _) => panorama.size(),
            (None, Pictures::Views(Views::Given(views), ..)) if !views.is_empty() => {
                (views[0].camera.width, views[0].camera.height)
            }
            _ => self.frame.camera.chosen_size(),
        };
        Ok(destination.plan((&self.scenes, self.frame.device.meant()), numbers, size))
    }

    fn meant(&mut self) -> Result<RenderPlan, Failure> {
        let moments = self.scenes.moments()?;
        if let Some((_, first)) = moments.first() {
            self.scenes = first.clone();
        }
        let mut settings = self.frame.settings.meant();
        self.slice.check(&settings)?;
        let sections = self.section.meant(&self.frame.camera, &self.frame.clip)?;
        let panorama = self.panorama.meant(self.frame.camera.size())?;
        if panorama.is_some() && self.changes_pictures() {
            return Err(Failure::Usage(
                "--outline, --rim, --scale-bar and --letters cannot mark a --panorama, which is made of six pictures: leave out these flags \
                 or --panorama".into(),
            ));
        }
        if let Some(panorama) = &panorama {
            let ahead = !self.path.moves();
            self.frame.camera.look_around(panorama.size(), ahead);
        }
        let pictures = match sections {
            Some(_) if self.path.moves() => {
                return Err(Failure::Usage(
                    "--path moves the camera, and --section has it face the cut: give one of them"
                        .into(),
                ));
            }
            Some(sections) => Pictures::Sections(sections),
            None => {
                let (clip, staged, fps) = self.frame.staged(settings)?;
                settings = staged;
                self.pictures
                    .pace(fps.filter(|_| self.path.is_as_in_file()));
                let frames = self.path.frames().unwrap_or(FRAMES);
                let places = self.scenes.places();
                let views = self.path.views(&self.frame.camera, &places, frames)?;
                let pace = (views.numbers().count() as u32, self.path.ease());
                let moving = self.moving.meant(None, pace)?;
                if moving.is_some() && !self.path.moves() {
                    return Err(Failure::Usage(
                        "--from and --to move a clip while --path moves the camera: give --path, or use rara sweep, which moves \
                         the clip alone"
                            .into(),
                    ));
                }
                if panorama.is_some() && matches!(views, Views::Framed { .. }) {
                    return Err(Failure::Usage(
                        "--panorama draws what is seen from one point: give the point by --eye, --camera or --cameras".into(),
                    ));
                }
                Pictures::Views(views, clip, moving.map(Box::new))
            }
        };
        let numbers = pictures.numbers();
        let mut several = self.several(numbers.len());
        let numbers = match (moments.len(), numbers.len()) {
            (0, _) => numbers,
            (_, _) if matches!(pictures, Pictures::Sections(_)) => {
                return Err(Failure::Usage(
                    "--section cuts one scene, and these are several: name one of them".into(),
                ));
            }
            (_, 1) => {
                several = Some("these scenes make".into());
                moments.iter().map(|(number, _)| *number).collect()
            }
            (scenes, pictures) if scenes == pictures => numbers,
            (scenes, pictures) => {
                return Err(Failure::Usage(format!(
                    "there are {} and {}: give one camera for all, or as many as scenes (--frames \
                     {scenes} of a path)",
                    counted(scenes as u64, "scene"),
                    counted(pictures as u64, "camera")
                )));
            }
        };
        if !self.aov.is_empty() {
            self.pictures.check_takes_channels(self.output.as_deref())?;
        }
        if settings.show == Show::Count {
            pictures::needs_floats(self.output.as_deref(), pictures::COUNTS)?;
        }
        Ok(RenderPlan {
            settings,
            panorama,
            pictures,
            moments,
            numbers,
            several,
        })
    }

    /// Draws the pictures that are in `order`, or all of them and reports them.
    pub(super) fn run_in(
        mut self,
        kept: &mut SessionCache,
        order: Option<&dyn Order>,
    ) -> Result<(), Failure> {
        let RenderPlan {
            settings,
            panorama,
            pictures,
            moments,
            numbers,
            several,
        } = self.meant()?;
        let several = several.as_deref();
        let output = self.output.as_deref();
        let destination = (self.pictures).destination(output, (&numbers, several), order)?;
        let settings = destination.settings(settings);

        let profile = self.profile.begin(|| destination.files(&numbers))?;
        let pictures = (pictures, &moments[..], several.is_some());
        let done = self.draw(
            (&profile, kept),
            pictures,
            (panorama, &destination),
            &settings,
        );
        profile.end_after(done)
    }

    /// True when pictures are changed once they are drawn.
    fn changes_pictures(&self) -> bool {
        self.slice.changes_pictures() || self.labels.are_drawn()
    }

    /// What makes so many pictures, if they are several: a run of several frames, however many there are.
    fn several(&self, count: usize) -> Option<String> {
        match self.frame.camera.chosen_view() {
            Some(view) if count > 1 || self.frame.camera.all() => {
                Some(format!("--view {view} makes"))
            }
            _ if self.path.moves() => Some("--path makes".into()),
            _ => (count > 1).then(|| "these sections are".into()),
        }
    }

    fn draw(
        &self,
        (profile, kept): (&Profile, &mut SessionCache),
        (pictures, moments, several): (Pictures, &[(usize, SceneArgs)], bool),
        (panorama, destination): (Option<Panorama>, &Destination<'_>),
        settings: &Settings,
    ) -> Result<(), Failure> {
        let (device, sh) = (&self.frame.device, settings.precision.sh);
        let session_of = (device, &self.profile, sh);
        let example = (pictures.example(), *settings);
        let first = profile.first_frame(device, &self.scenes, example);
        // A slice is another scene, drawn in another way.
        let first = first.filter(|_| !self.slice.is_shown());
        let (mut place, mut loaded) = kept.load(profile, &self.scenes, &session_of, first)?;
        let pictures = pictures.with_lassos(&loaded.scene())?;
        let regions = pictures.regions().clone();
        regions.settle(&mut loaded)?;
        let scene = loaded.scene();
        let mut shots = of_moments(pictures.shots(&scene)?, moments);
        if let (Some(_), Some(up)) = (&panorama, self.horizon()) {
            for Shot { view, .. } in &mut shots {
                view.camera = levelled(view.camera, up);
            }
        }
        for shot in &shots {
            self.labels.check(&shot.view.camera)?;
        }
        self.save_camera.save(shots.iter().map(|shot| &shot.view))?;
        let called = |shot: &Shot| (shot.view.number, shot.view.name.clone());
        let Some(planned) = destination.left(shots, called)? else {
            return Ok(());
        };
        let size = |camera: &Camera| panorama.map_or((camera.width, camera.height), Panorama::size);
        let sizes = planned.iter().map(|one| size(&one.what.view.camera));
        let pixels = panorama.map_or(0, Panorama::face_pixels);
        memory::check_pictures(sizes.clone(), pixels)?;
        let size = destination.size(sizes)?;
        let scene_report = SceneReport::new(&loaded);
        let seen = planned.iter().map(|one| &one.what);
        let seen = seen.map(|shot| (&shot.view.name[..], &shot.view.camera, &shot.clip));
        let taken = near::of(&loaded.scene(), seen.filter(|_| panorama.is_none()));
        // Later commands need the Gaussians again, and slices are made of them.
        let scene = match destination.order().is_none() && !self.slice.needs_gaussians() {
            true => loaded.take_scene(),
            false => loaded.scene(),
        };
        let mut session = place.open(profile, device.meant(), scene, sh)?;
        let scene = loaded.scene();
        if let Some(order) = destination.order() {
            order.opened(session.headless.driver());
        }
        let is_clipped = |one: &PictureJob<Shot>| !one.what.clip.is_everything();
        let clips = loaded.has_clips() || planned.iter().any(is_clipped);
        let faces = panorama.map_or(1, |_| Panorama::face_names().len());
        let repeat = match destination.order() {
            Some(_) => Repeat::Following,
            None => self.repeat(planned.len() * faces),
        };
        let is_section = planned.iter().any(|one| one.what.section.is_some());
        let device = self.frame.device.meant();
        let mut slicer = Slicer::new(&self.slice, &scene, is_section, device);
        slicer.check()?;
        let mut shown = 0;
        let written = destination.draw("rendering", profile, (&planned, size), |one| {
            if let Some(at) = one.what.moment.filter(|at| *at != shown) {
                let mut next = profile.span("load", || moments[at].1.load())?;
                regions.settle(&mut next)?;
                session.headless.load_as(next.scene(), sh)?;
                shown = at;
            }
            if let Some(panorama) = &panorama {
                return self.surroundings(profile, &mut session, (panorama, one), settings, repeat);
            }
            let PictureJob {
                what: shot, file, ..
            } = one;
            let Shot {
                view,
                clip,
                section,
                moment: _,
            } = shot;
            let sliced = shot.cut().filter(|_| self.slice.is_shown());
            let section = section.as_ref().filter(|_| sliced.is_none());
            let cut_scene = section.map(|section| loaded.scene_cut_by(&section.own));
            if let Some(cut_scene) = &cut_scene {
                session.set_layer_clips(cut_scene)?;
            }
            let measured = match sliced {
                Some(cut) => slicer.frame(&mut session, (view, cut, settings), repeat)?,
                None => session.measured_frame(&view.camera, clip, settings, repeat)?,
            };
            let plane = shot.cut().map(|cut| &cut.plane);
            let is_whole = settings.show == Show::Colour && sliced.is_none();
            let is_faint = is_whole
                && report::may_be_faint(&measured.stats.counts)
                && report::is_faint(&session.headless.picture()?, settings.background);
            let mut record = FrameRecord::new(view, file.as_deref(), plane, measured);
            record.is_faint = is_faint;
            let mut drawn = RenderedPicture::from(record);
            if file.is_some() {
                drawn.picture = Some(match self.changes_pictures() {
                    false => Pixels::Stored(session.headless.read_back()?),
                    true => {
                        let mut picture = session.headless.picture()?;
                        if sliced.is_some() {
                            slicer.finish(&mut picture, settings);
                        }
                        let cuts = match shot.cut() {
                            Some(cut) => vec![cut.clone()],
                            None if self.slice.has_cues() => slice::faces(clip, &view.camera)?,
                            None => Vec::new(),
                        };
                        slicer.draw_cues(&mut picture, (view, &cuts, settings))?;
                        self.labels.draw(&mut picture, &view.camera);
                        Pixels::Decoded(picture)
                    }
                });
                if !self.aov.is_empty() {
                    let frame = (&view.camera, clip, settings);
                    drawn.channels = session.headless.channels(&self.aov, frame)?;
                }
            }
            Ok(drawn)
        })?;
        slicer.close()?;
        if destination.order().is_some() && !moments.is_empty() {
            return Ok(session.headless.close()?); // what is on the device is no longer what was loaded
        }
        if destination.order().is_some() {
            return Ok(kept.keep(place, loaded, session)?);
        }

        let mode = settings.mode.to_string();
        let report = RenderReport::new(&session, scene_report, size, mode, &written.pictures);
        let (faces, pictures) = (written.faces, written.pictures);
        let report = match panorama {
            Some(_) => report.with_frames(faces),
            None if several => report.with_frames(pictures),
            None => report,
        };
        let report = report.with_near_cut(taken);
        session.headless.close()?;
        Ok(report.print(self.pictures.answer(), clips, &written.files)?)
    }

    fn surroundings(
        &self,
        profile: &Profile,
        session: &mut Session,
        (panorama, one): (&Panorama, &PictureJob<Shot>),
        settings: &Settings,
        repeat: Repeat,
    ) -> Result<RenderedPicture, Failure> {
        let PictureJob {
            what: shot, file, ..
        } = one;
        let (mut frames, mut pictures) = (Vec::new(), Vec::new());
        let view = &shot.view;
        for (name, camera) in Panorama::face_names()
            .iter()
            .zip(panorama.faces(&view.camera))
        {
            let face = NamedView {
                name: format!("{} {name}", view.name),
                camera,
                ..view.clone()
            };
            let measured = session.measured_frame(&camera, &shot.clip, settings, repeat)?;
            frames.push(FrameRecord::new(&face, file.as_deref(), None, measured));
            if file.is_some() {
                pictures.push(session.headless.picture()?);
            }
        }
        let pictures: Option<[Picture; 6]> = pictures.try_into().ok();
        let assembled = |faces| profile.span("panorama", || panorama.assembled(faces));
        let mut together = FrameRecord::together(view, file.as_deref(), &frames);
        together.seams = pictures.as_ref().map(|faces| panorama.seams(faces));
        Ok(RenderedPicture {
            picture: pictures
                .as_ref()
                .map(|faces| Pixels::Decoded(assembled(faces))),
            faces: frames,
            ..RenderedPicture::from(together)
        })
    }

    /// The direction that is up in a panorama; none where cameras of a file have one of their own.
    fn horizon(&self) -> Option<DVec3> {
        let of_file = self.path.is_of_file();
        self.frame.camera.up().filter(|_| !of_file)
    }

    /// How often each of so many frames is drawn.
    fn repeat(&self, frames: usize) -> Repeat {
        let is_table = self.pictures.answer() == Answer::Table;
        match self.repeat {
            Some(repeat) => Repeat::Exactly(repeat),
            None if output::is_quiet() && is_table => Repeat::Unmeasured,
            // A trace shows what happens in a frame; more of them would be harder to read.
            None if self.profile.is_traced() => Repeat::Exactly(1),
            None => Repeat::of_pictures(frames),
        }
    }
}
