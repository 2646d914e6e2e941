//! The flags that place the camera.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::Camera;

use super::failure::Failure;
use super::json_kind::JsonKind;
use super::lens::{Depths, Lens, Ortho, UP, ortho};
use super::views::{Framing, NamedView, Views, picked};
use super::{aspect, output, training, values};
use rara::camera_files::{self, NamedCamera};

pub(super) const HEADING: &str = "Camera";

/// The camera's position and lens. Without any of these it frames what is visible of the scene.
#[derive(Debug, Args)]
#[command(next_help_heading = HEADING)]
pub(super) struct CameraArgs {
    /// The eye's position
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    eye: Option<DVec3>,
    /// The point that the eye looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    target: Option<DVec3>,
    /// Direction that is up in the picture, as -y or 0,-1,0
    ///
    /// y suits a scene that is upside down, z or -z one that lies on its side. By default -y, and where the camera
    /// frames the scene the mean of the cameras beside it, if there are any; a section may have another. In a view
    /// along it z is up, and -y in one along z.
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
    /// Draw without perspective, HEIGHT world units high, or fit all
    ///
    /// fit shows all that is visible, and goes without --eye.
    #[arg(long, value_name = "HEIGHT|fit", value_parser = ortho, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera", "fov_y"])]
    ortho: Option<Ortho>,
    /// Take cameras from a cameras.json, transforms.json, camera_path.json or COLMAP folder
    ///
    /// With --view and without this flag the cameras are those beside the scene.
    #[arg(long, value_name = "FILE", conflicts_with = "camera")]
    cameras: Option<PathBuf>,
    /// Choose from the cameras: N, NAME, N..M, several with commas, or all
    ///
    /// Numbers count from 0, and a range has both of its ends. By default 0 with --cameras; without it the camera
    /// frames the scene.
    #[arg(long, value_name = "N|NAME|N..M|all", conflicts_with_all = ["eye", "target", "ortho", "fov_y", "up"])]
    view: Option<String>,
    /// Take one camera from a JSON file, as --save-camera writes it
    ///
    /// The file has width, height, fx, fy, cx, cy, world_to_camera (16 numbers, row-major), and perhaps
    /// "projection": "orthographic"; fx and fy are then the pixels of a world unit. --json has the same under
    /// "camera". With --view the file may hold a list of cameras.
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// Draw the pinholes of cameras whose lenses bend straight lines
    ///
    /// They have the same focal lengths and principal point, and no distortion: the pictures are those that a tool would make that
    /// undistorts the photographs and leaves their size.
    #[arg(long)]
    undistort: bool,
    /// Keep what is at this depth or deeper, world units
    ///
    /// It is a plane across the view axis, which moves with the camera, cuts every layer, and cuts splats as --mode
    /// says.
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    clip_near: Option<f64>,
    /// Keep what is at this depth or nearer
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    clip_far: Option<f64>,
    /// Draw splats whose centres are at this depth or deeper, world units
    ///
    /// Each is drawn whole. By default 0.2.
    #[arg(long, value_name = "DEPTH")]
    near_cut: Option<f64>,
    /// Size of the picture [default: 1024x1024, or the camera file's]
    ///
    /// A window is 1280x720. Of another aspect than the camera file's the picture shows all that the camera sees,
    /// undistorted, and more beside it.
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
    /// Whether only the camera's place and its axes count.
    #[arg(skip)]
    is_around: bool,
}

const DEFAULT_SIZE: (u32, u32) = (1024, 1024);
/// Degrees.
pub(super) const FOV_Y: f64 = 50.0;

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

    /// The file of the cameras: the one that is named, or the one beside a scene; `flag` asks for it.
    fn file(&self, scenes: &[PathBuf], flag: &str) -> Result<PathBuf, Failure> {
        if let Some(file) = self.cameras.as_ref().or(self.camera.as_ref()) {
            return Ok(file.clone());
        }
        let found = scenes.iter().find_map(|scene| training::cameras(scene));
        let found = found.ok_or_else(|| {
            Failure::Usage(format!(
                "{flag}: no cameras.json or transforms.json is beside the scene; name one by --cameras"
            ))
        })?;
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
        let loaded = training::load_cameras(&path, scenes)
            .map_err(|error| JsonKind::Cameras.wanted(&path, error))?;
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
                camera: self.depths().camera(self.sized(self.drawn(named)?)?)?,
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

    fn depths(&self) -> Depths {
        Depths {
            near: self.clip_near,
            far: self.clip_far,
            cut: self.near_cut,
        }
    }

    /// The cameras that the flags mean, also of files beside these scenes; reads their files.
    pub(super) fn meant(&self, scenes: &[PathBuf]) -> Result<Views, Failure> {
        let (size, depths) = (self.chosen_size(), self.depths());
        let lens = match self.ortho {
            None => Lens::Perspective(self.fov_y),
            Some(Ortho::Height(height)) => Lens::Orthographic(Some(height)),
            Some(Ortho::Fit) => Lens::Orthographic(None),
        };
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            let camera = lens.look((eye, target), self.up.unwrap_or(UP), size)?;
            return Ok(Views::Given(vec![NamedView {
                number: 0,
                name: "camera".into(),
                camera: depths.camera(camera)?,
            }]));
        }
        if let (Some(path), None) = (&self.camera, &self.view) {
            let camera = depths.camera(self.sized(self.only(path, scenes)?)?)?;
            return Ok(Views::Given(vec![NamedView {
                number: 0,
                name: path.display().to_string(),
                camera,
            }]));
        }
        if self.cameras.is_none() && self.view.is_none() {
            let (up, note) = training::up_of(self.up, scenes);
            let framed = Framing {
                up,
                lens,
                size,
                depths,
                eye: self.eye,
                target: self.target,
                note,
            };
            return framed.checked().map(Views::Framed);
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
        // A single camera is what the file should have.
        let loaded = training::load_cameras(path, scenes).map_err(|error| {
            let of_one = camera_files::load_camera(path).err().unwrap_or(error);
            JsonKind::Cameras.wanted(path, of_one)
        })?;
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
