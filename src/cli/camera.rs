//! The flags that place the camera.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::{Camera, Gaussians, Scene};

use super::failure::Failure;
#[cfg(doc)]
use super::framing;
use super::{aspect, output, training, values};
use rara::{camera_files, scene::Bounds};

/// The camera's position and lens. Without any of these it frames the scene.
#[derive(Debug, Args)]
#[command(next_help_heading = "Camera (without any of these it frames the scene)")]
pub(super) struct CameraArgs {
    /// The eye's position
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    #[arg(requires = "target", conflicts_with_all = ["cameras", "camera"])]
    eye: Option<DVec3>,
    /// The point that it looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true, requires = "eye")]
    target: Option<DVec3>,
    /// The direction that is up in the picture, as 0,-1,0 or -y; where a scene is upside down, y, and where it lies on its
    /// side, z or -z [default: -y; a section's may be another]
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
    /// Orthographic, without perspective: the picture's height in world units, or `fit` for all of the scene, without --eye
    #[arg(long, value_name = "HEIGHT|fit", value_parser = ortho, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["cameras", "camera", "fov_y"])]
    ortho: Option<Ortho>,
    /// Cameras of a 3DGS cameras.json, a nerfstudio transforms.json or a COLMAP sparse folder [default with --view: those
    /// beside the scene]
    #[arg(long, value_name = "FILE", conflicts_with = "camera")]
    cameras: Option<PathBuf>,
    /// Which of the cameras: number from 0, name, or all [default with --cameras: 0; without it the camera frames the scene]
    #[arg(long, value_name = "N|NAME|all", conflicts_with_all = ["eye", "camera", "ortho", "fov_y", "up"])]
    view: Option<String>,
    /// One camera: JSON with width, height, fx, fy, cx, cy, world_to_camera (16 numbers, row-major), and perhaps
    /// "projection": "orthographic"; fx and fy are then the pixels of a world unit
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// Keep what is at this depth or deeper, world units along the view axis: a plane that moves with the camera, cuts every
    /// layer, and cuts splats as --mode says
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    clip_near: Option<f64>,
    /// Keep what is at this depth or nearer, likewise
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    clip_far: Option<f64>,
    /// Picture size [default: 1024x1024, or the camera file's own; a window's: 1280x720]. Of another aspect than the camera
    /// file's it shows all that the camera sees, undistorted, and more beside it
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
}

/// The scale of an orthographic picture.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ortho {
    /// World units that it is high.
    Height(f64),
    /// As many as hold the scene.
    Fit,
}

fn ortho(text: &str) -> Result<Ortho, String> {
    match text.parse::<f64>() {
        _ if text == "fit" => Ok(Ortho::Fit),
        Ok(height) if height > 0.0 && height.is_finite() => Ok(Ortho::Height(height)),
        _ => Err("expected the picture's height in world units, above zero, or `fit`".into()),
    }
}

/// The projection of a camera that frames the scene.
#[derive(Debug, Clone, Copy)]
pub(super) enum Lens {
    /// Degrees of its vertical field of view.
    Perspective(f64),
    /// World units that its picture is high; `None` for as many as hold the scene.
    Orthographic(Option<f64>),
}

impl Lens {
    fn frame(self, bounds: &Bounds, up: DVec3, size: (u32, u32)) -> rara::Result<Camera> {
        match self {
            Self::Perspective(fov_y) => Camera::frame(bounds, up, fov_y, size),
            Self::Orthographic(height) => {
                let camera = Camera::frame_orthographic(bounds, up, size)?;
                Ok(height.map_or(camera, |height| {
                    let scale = f64::from(size.1) / height;
                    camera.fx(scale).fy(scale)
                }))
            }
        }
    }
}

/// The direction that is up in the world where nothing else is said.
const UP: DVec3 = DVec3::NEG_Y;
/// Picture size where neither a flag nor a file gives one.
const DEFAULT_SIZE: (u32, u32) = (1024, 1024);
/// Degrees.
const FOV_Y: f64 = 50.0;

/// A camera and what its file calls it.
#[derive(Debug, Clone)]
pub(super) struct View {
    /// Its number in the file; it replaces `{}` in a picture's name.
    pub(super) number: usize,
    pub(super) name: String,
    pub(super) camera: Camera,
}

/// The cameras that the flags mean.
#[derive(Debug)]
pub(super) enum Views {
    /// Cameras that are known before the scene is loaded.
    Given(Vec<View>),
    /// A camera that the scene's bounds will place.
    Framed {
        up: DVec3,
        lens: Lens,
        size: (u32, u32),
        depths: Depths,
    },
}

/// The depths that `--clip-near` and `--clip-far` mean.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Depths {
    near: Option<f64>,
    far: Option<f64>,
}

impl Depths {
    /// The camera with planes at these depths.
    fn of(self, camera: Camera) -> Result<Camera, Failure> {
        let camera = camera.clip_near(self.near).clip_far(self.far);
        camera.clip_planes().map_err(Failure::usage)?;
        Ok(camera)
    }
}

impl Views {
    /// The numbers of the cameras in their file.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let (given, framed) = match self {
            Self::Given(views) => (views.as_slice(), None),
            Self::Framed { .. } => (&[][..], Some(0)),
        };
        given.iter().map(|view| view.number).chain(framed)
    }
}

impl CameraArgs {
    /// True when `--view all` was typed: a run of several frames, however many there are.
    pub(super) fn all(&self) -> bool {
        self.view.as_deref() == Some("all")
    }

    /// True when a file places the camera.
    fn is_from_file(&self) -> bool {
        self.camera.is_some() || self.cameras.is_some() || self.view.is_some()
    }

    /// Refuses several cameras, where `what` needs one.
    pub(super) fn single(&self, what: &str) -> Result<(), Failure> {
        match self.all() {
            false => Ok(()),
            true => Err(Failure::Usage(format!(
                "{what} has one camera: give --view a number or a name"
            ))),
        }
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

    /// The world's up direction, unless a file places the camera.
    #[cfg(feature = "view")]
    pub(super) fn up(&self) -> Option<DVec3> {
        let from_file = self.is_from_file();
        (!from_file).then_some(self.up.unwrap_or(UP))
    }

    /// True when a flag places the camera, chooses its lens or cuts at its depths.
    pub(super) fn places(&self) -> bool {
        let from_file = self.is_from_file();
        let cuts = self.clip_near.is_some() || self.clip_far.is_some();
        from_file || cuts || self.eye.is_some() || self.ortho.is_some() || self.fov_y != FOV_Y
    }

    /// The direction that is up in the picture, if a flag says it.
    pub(super) fn chosen_up(&self) -> Option<DVec3> {
        self.up
    }

    /// The size of a picture whose camera no file gives.
    pub(super) fn chosen_size(&self) -> (u32, u32) {
        self.size.unwrap_or(DEFAULT_SIZE)
    }

    /// The file of the cameras: the one that is named, or where only a view is named, the one beside a scene.
    fn file(&self, scenes: &[PathBuf]) -> Result<Option<PathBuf>, Failure> {
        if self.cameras.is_some() || self.view.is_none() {
            return Ok(self.cameras.clone());
        }
        let found = scenes.iter().find_map(|scene| training::cameras(scene));
        let found = found.ok_or_else(|| {
            Failure::Usage(
                "--view: no cameras.json or transforms.json is beside the scene; name one by --cameras".into(),
            )
        })?;
        output::say(format_args!(
            "note: the cameras are those of {}",
            found.display()
        ));
        Ok(Some(found))
    }

    /// The cameras that the flags mean, also of files beside these scenes; reads their files.
    pub(super) fn meant(&self, scenes: &[PathBuf]) -> Result<Views, Failure> {
        let size = self.chosen_size();
        let up = self.up.unwrap_or(UP);
        let depths = Depths {
            near: self.clip_near,
            far: self.clip_far,
        };
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            let camera = match self.ortho {
                None => Camera::look_at(eye, target, up, self.fov_y, size),
                Some(Ortho::Height(height)) => Camera::orthographic(eye, target, up, height, size),
                Some(Ortho::Fit) => {
                    return Err(Failure::Usage(
                        "--ortho fit places the camera itself: give a height with --eye and --target".into(),
                    ));
                }
            };
            let camera = depths.of(camera.map_err(Failure::usage)?)?;
            return Ok(Views::Given(vec![View {
                number: 0,
                name: "camera".into(),
                camera,
            }]));
        }
        if let Some(path) = &self.camera {
            let camera = depths.of(self.sized(camera_files::load_camera(path)?)?)?;
            return Ok(Views::Given(vec![View {
                number: 0,
                name: path.display().to_string(),
                camera,
            }]));
        }
        let Some(path) = &self.file(scenes)? else {
            let lens = match self.ortho {
                None => Lens::Perspective(self.fov_y),
                Some(Ortho::Height(height)) => Lens::Orthographic(Some(height)),
                Some(Ortho::Fit) => Lens::Orthographic(None),
            };
            // Errors that do not depend on the scene are found before it is read.
            let unframed = lens.frame(&Bounds::of(&Gaussians::default()), up, size);
            depths.of(unframed.map_err(Failure::usage)?)?;
            if self.up.is_none() {
                scenes
                    .iter()
                    .find_map(|scene| training::hint_of_up(scene, UP));
            }
            return Ok(Views::Framed {
                up,
                lens,
                size,
                depths,
            });
        };
        let loaded = training::load_cameras(path, scenes)?
            .into_iter()
            .enumerate();
        let mut views: Vec<View> = loaded
            .map(|(number, named)| View {
                number,
                name: named.name,
                camera: named.camera,
            })
            .collect();
        if !self.all() {
            let wanted = self.view.as_deref().unwrap_or("0");
            views = vec![pick(views, wanted, path)?];
        }
        for view in &mut views {
            view.camera = depths.of(self.sized(view.camera)?)?;
        }
        Ok(Views::Given(views))
    }

    fn sized(&self, camera: Camera) -> Result<Camera, Failure> {
        match self.size {
            Some(size) => aspect::sized(camera, size),
            None => Ok(camera),
        }
    }
}

impl Views {
    /// The cameras, once the scene is known; one that frames it holds the box around it. [`framing::views`] are nearer.
    pub(super) fn of(self, scene: &Scene<'_>) -> Result<Vec<View>, Failure> {
        match self {
            Self::Given(views) => Ok(views),
            Self::Framed {
                up,
                lens,
                size,
                depths,
            } => {
                let camera = depths.of(lens.frame(&Bounds::of(scene), up, size)?)?;
                Ok(vec![View {
                    number: 0,
                    name: "framing".into(),
                    camera,
                }])
            }
        }
    }
}

/// The view with the number or name `wanted`; a name may leave out its ending.
fn pick(views: Vec<View>, wanted: &str, path: &Path) -> Result<View, Failure> {
    let count = views.len();
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_owned());
    let by_number = wanted.parse::<usize>().ok().filter(|n| *n < count);
    let index = by_number
        .or_else(|| views.iter().position(|v| v.name == wanted))
        .or_else(|| {
            views
                .iter()
                .position(|v| stem(&v.name).is_some_and(|s| s == wanted))
        });
    let meant = values::meant(wanted, views.iter().map(|view| view.name.as_str()));
    let found = index.and_then(|i| views.into_iter().nth(i));
    found.ok_or_else(|| {
        Failure::Usage(format!(
            "--view {wanted}: {} has {count} cameras, and none of that number (from 0) or name{meant}",
            path.display()
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_picked_by_number_name_or_stem() {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 50.0, (8, 8)).unwrap();
        let names = ["a.jpg", "b/7.png", "2"];
        let views = || {
            names.iter().enumerate().map(|(number, n)| View {
                number,
                name: n.to_string(),
                camera,
            })
        };
        let picked = |wanted| {
            pick(views().collect(), wanted, Path::new("f"))
                .map(|v| v.number)
                .ok()
        };
        assert_eq!(picked("1"), Some(1));
        assert_eq!(picked("a.jpg"), Some(0));
        assert_eq!(picked("a"), Some(0));
        assert_eq!(picked("7"), Some(1));
        assert_eq!(picked("2"), Some(2));
        assert_eq!(picked("9"), None);
    }
}
