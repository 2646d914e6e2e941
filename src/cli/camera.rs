//! The flags that place the camera.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::Camera;

use super::failure::Failure;
use super::json_kind::{JsonKind, wanted};
use super::views::{Framed, NamedView, Views, picked, say_up};
use super::{aspect, output, up, values};
use rara::camera_files::NamedCamera;
use rara::scene::trained_folder;
use rara_shots::{Depths, Framing, Lens, UP};

pub(super) const HEADING: &str = "Camera";

/// The camera's position and lens. Without any of these it frames what is visible of the scene.
#[derive(Debug, Args)]
#[command(next_help_heading = HEADING)]
pub struct CameraArgs {
    /// The position of the camera
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    eye: Option<DVec3>,
    /// The point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    target: Option<DVec3>,
    /// Direction that is up in the picture, such as -y or 0,-1,0
    ///
    /// Try y if the scene is upside down, and z or -z if it lies on its side. For a section, the default depends on
    /// its axis. Otherwise it is the direction in the comment "Vertical Axis" of a .ply; else, if rara frames the scene and finds
    /// cameras in the scene's folder, their mean up direction; else -y. If the camera looks
    /// along the up direction, rara takes z instead, or -y if the camera looks along z.
    #[arg(long, value_name = "X,Y,Z|AXIS", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    up: Option<DVec3>,
    /// Vertical field of view, degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = FOV_Y,
        allow_hyphen_values = true
    )]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    fov_y: f64,
    /// Draw without perspective; show HEIGHT world units, or all (fit)
    ///
    /// The height of the picture is HEIGHT. fit shows everything that is visible, and cannot be combined with --eye.
    #[arg(long, value_name = "HEIGHT|fit", value_parser = ortho, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera", "fov_y"])]
    ortho: Option<Ortho>,
    /// Take cameras from a cameras.json, transforms.json, camera_path.json or COLMAP folder
    ///
    /// Other formats are a settings.json of SuperSplat, a project.opf of Pix4D and a glTF with cameras. A camera_path.json also
    /// gives its crop box, its background colour, and the pictures per second of a film. If --view is given without --cameras,
    /// the cameras are those of a file in the scene's folder, or of the scene's own file.
    #[arg(long, value_name = "FILE", conflicts_with = "camera")]
    cameras: Option<PathBuf>,
    /// Cameras to draw: all, N, NAME, N..M, or several with commas
    ///
    /// Numbers count from 0, and N..M includes N and M. With --cameras, the default is 0. Without --cameras and --view, the
    /// camera frames the scene.
    #[arg(long, value_name = "N|NAME|N..M|all", conflicts_with_all = ["eye", "target", "ortho", "fov_y", "up"])]
    view: Option<String>,
    /// Take the camera from a JSON file that --save-camera wrote
    ///
    /// The file has width, height, fx, fy, cx, cy and world_to_camera (16 numbers, row-major). It may have "projection":
    /// "orthographic"; fx and fy are then in pixels per world unit. The JSON that --json prints has such a camera under
    /// "camera". If --view is given, the file may have a list of cameras.
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// Ignore the lens distortion of the cameras
    ///
    /// Each camera is drawn as a pinhole camera with the same focal lengths and the same principal point, so that straight
    /// lines stay straight. The picture then matches an undistorted photograph of the same size and with the same focal lengths
    /// and principal point.
    #[arg(long)]
    undistort: bool,
    /// Clip away what is nearer than this depth, world units
    ///
    /// This is a clip plane perpendicular to the view axis, which moves with the camera. It cuts every layer, and cuts splats as
    /// --mode says.
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    clip_near: Option<f64>,
    /// Clip away what is deeper than this depth, world units
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    clip_far: Option<f64>,
    /// Leave out splats centred nearer than this depth [default: 0.2]
    ///
    /// The depth is in world units. Unlike --clip-near, this flag does not cut the other splats.
    #[arg(long, value_name = "DEPTH")]
    near_cut: Option<f64>,
    /// Picture size [default: camera's or 1024x1024; rara view: 1280x720]
    ///
    /// If the aspect ratio differs from that of the camera in a file, the picture shows all that this camera sees, without
    /// stretching, and more of the scene on two sides.
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
    /// Whether only the camera's place and its axes count.
    #[arg(skip)]
    is_around: bool,
}

/// The scale of an orthographic picture.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ortho {
    /// World units that it is high.
    Height(f64),
    /// So high that it holds the scene.
    Fit,
}

fn ortho(text: &str) -> Result<Ortho, String> {
    match text.parse::<f64>() {
        _ if text == "fit" => Ok(Ortho::Fit),
        Ok(height) if height > 0.0 && height.is_finite() => Ok(Ortho::Height(height)),
        _ => Err("expected the picture's height in world units, above zero, or `fit`".into()),
    }
}

const DEFAULT_SIZE: (u32, u32) = (1024, 1024);
/// Degrees.
pub(super) const FOV_Y: f64 = 50.0;

/// The cameras of a file where the Gaussians of these scenes are.
fn placed(path: &Path, scenes: &[PathBuf]) -> Result<Vec<NamedCamera>, Failure> {
    let placed = trained_folder::load_cameras(path, scenes)
        .map_err(|error| wanted(JsonKind::Cameras, path, error))?;
    for note in placed.notes {
        output::say(format_args!("note: {note}"));
    }
    Ok(placed.cameras)
}

impl CameraArgs {
    /// True when `--view all` was typed: a run of several frames, however many there are.
    pub(super) fn all(&self) -> bool {
        self.view.as_deref() == Some("all")
    }

    fn is_from_file(&self) -> bool {
        self.camera.is_some() || self.cameras.is_some() || self.view.is_some()
    }

    /// The same flags for a command whose default size is another.
    #[cfg(feature = "view")]
    pub(super) fn sized_by_default(self, size: (u32, u32)) -> Self {
        let from_file = self.is_from_file();
        Self {
            size: self.size.or((!from_file).then_some(size)),
            ..self
        }
    }

    /// Means cameras whose pictures show all directions, of this size. Where none is said the camera may look straight `ahead`.
    pub(super) fn look_around(&mut self, size: (u32, u32), ahead: bool) {
        self.is_around = true;
        self.size = Some(size);
        let up = self.up.unwrap_or(UP).normalize();
        let level = if up.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
        if let (Some(eye), None, true) = (self.eye, self.target, ahead) {
            self.target = Some(eye + (level - up * level.dot(up)).normalize());
        }
    }

    /// The world's up direction, unless a file places the camera.
    pub(super) fn up(&self) -> Option<DVec3> {
        let from_file = self.is_from_file();
        (!from_file).then_some(self.up.unwrap_or(UP))
    }

    /// True when a flag places the camera, chooses its lens or cuts at its depths.
    pub(super) fn places(&self) -> bool {
        let from_file = self.is_from_file();
        let cuts = [self.clip_near, self.clip_far, self.near_cut];
        let cuts = cuts.iter().any(Option::is_some);
        from_file
            || cuts
            || self.eye.is_some()
            || self.target.is_some()
            || self.ortho.is_some()
            || self.fov_y != FOV_Y
    }

    pub(super) fn chosen_up(&self) -> Option<DVec3> {
        self.up
    }

    pub(super) fn chosen_view(&self) -> Option<&str> {
        self.view.as_deref()
    }

    pub(super) fn size(&self) -> Option<(u32, u32)> {
        self.size
    }

    /// The size of a picture whose camera no file gives.
    pub(super) fn chosen_size(&self) -> (u32, u32) {
        self.size.unwrap_or(DEFAULT_SIZE)
    }

    /// The point that an orbit goes round and the direction of its axis, where flags place the camera.
    pub(super) fn pivot(&self) -> Option<(DVec3, DVec3)> {
        let target = self.target.filter(|_| self.eye.is_some())?;
        Some((target, self.up.unwrap_or(UP)))
    }

    /// Refuses what would choose cameras of a file for `what`, which needs none.
    pub(super) fn without_file(&self, what: &str) -> Result<(), Failure> {
        match self.is_from_file() {
            false => Ok(()),
            true => Err(Failure::Usage(format!(
                "{what} goes round the framed scene, or round --target and from --eye: leave out the cameras of a file"
            ))),
        }
    }

    /// The file of cameras that a flag names.
    pub(super) fn chosen_file(&self) -> Option<&Path> {
        self.cameras.as_deref().or(self.camera.as_deref())
    }

    /// The file of the cameras: the one that is named, or the one beside a scene; `flag` asks for it.
    fn file(&self, scenes: &[PathBuf], flag: &str) -> Result<PathBuf, Failure> {
        if let Some(file) = self.chosen_file() {
            return Ok(file.to_owned());
        }
        let Some(found) = trained_folder::cameras_of(scenes) else {
            for scene in scenes
                .iter()
                .filter(|scene| *scene != Path::new(output::STANDARD))
            {
                std::fs::metadata(scene).map_err(rara::Error::io(scene))?;
            }
            return Err(Failure::Usage(format!(
                "{flag}: no cameras are in the scene, and no cameras.json or transforms.json is in its folder; name one by --cameras"
            )));
        };
        output::say(format_args!(
            "note: the cameras are those of {}",
            found.display()
        ));
        Ok(found)
    }

    /// The cameras of a file with these numbers or names, in this order; all of them where none is `wanted`. `flag` asks for
    /// them. Also of files beside these scenes.
    pub(super) fn of_file(
        &self,
        scenes: &[PathBuf],
        flag: &str,
        wanted: Option<&[String]>,
    ) -> Result<Vec<NamedView>, Failure> {
        let is_placed = self.eye.or(self.target).or(self.up).is_some();
        if is_placed || self.ortho.is_some() || self.fov_y != FOV_Y {
            return Err(Failure::Usage(format!(
                "{flag} takes the cameras of a file: leave out --eye, --target, --up, --fov-y and --ortho"
            )));
        }
        let path = self.file(scenes, flag)?;
        let loaded = placed(&path, scenes)?;
        let numbers = match wanted {
            None => (0..loaded.len()).collect(),
            Some(wanted) => {
                let names: Vec<_> = loaded.iter().map(NamedCamera::name).collect();
                let all = wanted.iter().map(|one| picked(&names, one, &path, flag));
                all.collect::<Result<Vec<_>, _>>()?.concat()
            }
        };
        let view = |number: &usize| {
            let named = &loaded[*number];
            Ok(NamedView {
                number: *number,
                name: named.name().to_owned(),
                camera: self.cut(self.sized(self.drawn(named)?)?)?,
            })
        };
        let views = numbers.iter().map(view).collect::<Result<_, Failure>>()?;
        self.say_what_changed(numbers.iter().map(|number| &loaded[*number]));
        Ok(views)
    }

    /// The camera that a picture is drawn by.
    fn drawn(&self, named: &NamedCamera) -> rara::Result<Camera> {
        match self.undistort {
            true => named.undistorted(),
            false => named.camera(),
        }
    }

    /// Says what the cameras that are drawn have not as their file has it.
    fn say_what_changed<'a>(&self, drawn: impl Iterator<Item = &'a NamedCamera>) {
        let (mut bent, mut repaired) = (Vec::new(), Vec::new());
        for named in drawn {
            if let Some(lens) = named.distortion() {
                let text = format!("its {lens} lens is drawn as a pinhole, without distortion");
                bent.push((named.name(), text));
            }
            if !named.repairs().is_empty() {
                repaired.push((named.name(), named.repairs().join(", and ")));
            }
        }
        for changed in [bent, repaired] {
            let Some((name, text)) = changed.first() else {
                continue;
            };
            let others = match changed.len() - 1 {
                0 => String::new(),
                1 => "; 1 other camera is changed likewise".into(),
                more => format!("; {more} other cameras are changed likewise"),
            };
            output::say(format_args!("note: camera {name}: {text}{others}"));
        }
    }

    /// The camera that cuts at the depths of the flags.
    fn cut(&self, camera: Camera) -> Result<Camera, Failure> {
        self.depths().camera(camera).map_err(Failure::usage)
    }

    fn depths(&self) -> Depths {
        Depths {
            near: self.clip_near,
            far: self.clip_far,
            cut: self.near_cut,
        }
    }

    /// The cameras that the flags mean, also of files beside these scenes; reads their files.
    pub fn meant(&self, scenes: &[PathBuf]) -> Result<Views, Failure> {
        let size = self.chosen_size();
        if let (Some(_), Some(Ortho::Fit)) = (self.eye, self.ortho) {
            return Err(Failure::Usage(
                "--ortho fit places the camera itself: give a height with --eye".into(),
            ));
        }
        let lens = match self.ortho {
            None => Lens::Perspective(self.fov_y),
            Some(Ortho::Height(height)) => Lens::Orthographic(Some(height)),
            Some(Ortho::Fit) => Lens::Orthographic(None),
        };
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            let up = self
                .up
                .or_else(|| trained_folder::stated_up(scenes))
                .unwrap_or(UP);
            let camera = lens.look((eye, target), up, size);
            let camera = camera.map_err(Failure::usage)?;
            say_up(&camera, up);
            return Ok(Views::Given(vec![NamedView {
                number: 0,
                name: "camera".into(),
                camera: self.cut(camera)?,
            }]));
        }
        if let (Some(path), None) = (&self.camera, &self.view) {
            let camera = self.cut(self.sized(self.only(path, scenes)?)?)?;
            return Ok(Views::Given(vec![NamedView {
                number: 0,
                name: path.display().to_string(),
                camera,
            }]));
        }
        if self.cameras.is_none() && self.view.is_none() {
            let (up, note) = up::up_of(self.up, scenes);
            let framing = Framing::new(lens, size).up(up).depths(self.depths());
            let framing = framing.eye(self.eye).target(self.target);
            framing.check().map_err(Failure::usage)?;
            return Ok(Views::Framed(Framed { framing, note }));
        }
        let one = [self.view.clone().unwrap_or_else(|| "0".into())];
        let wanted = (!self.all()).then_some(&one[..]);
        self.of_file(scenes, "--view", wanted).map(Views::Given)
    }

    fn sized(&self, camera: Camera) -> Result<Camera, Failure> {
        match self.size {
            Some(size) if self.is_around => camera.resized(size).map_err(Failure::usage),
            Some(size) => aspect::sized(camera, size),
            None => Ok(camera),
        }
    }

    /// The camera of a file that has one.
    fn only(&self, path: &Path, scenes: &[PathBuf]) -> Result<Camera, Failure> {
        let loaded = placed(path, scenes)?;
        match &loaded[..] {
            [only] => {
                let camera = self.drawn(only)?;
                self.say_what_changed([only].into_iter());
                Ok(camera)
            }
            several => Err(Failure::Usage(format!(
                "--camera {}: the file has {}: choose by --view, which takes numbers, names and all",
                path.display(),
                output::counted(several.len() as u64, "camera")
            ))),
        }
    }
}
