//! The flags that place the camera.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::{Camera, Gaussians, Scene};

use super::failure::Failure;
use super::values;
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
    /// The direction that is up in the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(default_value = "0,-1,0", conflicts_with_all = ["cameras", "camera"])]
    up: DVec3,
    /// Vertical field of view, degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 50.0,
        allow_hyphen_values = true
    )]
    #[arg(conflicts_with_all = ["cameras", "camera"])]
    fov_y: f64,
    /// Cameras of a 3DGS cameras.json, a nerfstudio transforms.json or a COLMAP sparse folder
    #[arg(long, value_name = "FILE", conflicts_with = "camera")]
    cameras: Option<PathBuf>,
    /// Which of the --cameras: number from 0, name, or all
    #[arg(
        long,
        value_name = "N|NAME|all",
        default_value = "0",
        requires = "cameras"
    )]
    view: String,
    /// One camera: JSON with width, height, fx, fy, cx, cy, world_to_camera (16 numbers, row-major)
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// Picture size [default: 1024x1024, or the camera file's own; a window's: 1280x720]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
}

/// Picture size where neither a flag nor a file gives one.
const DEFAULT_SIZE: (u32, u32) = (1024, 1024);

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
        fov_y: f64,
        size: (u32, u32),
    },
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
        self.view == "all"
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
        let from_file = self.camera.is_some() || self.cameras.is_some();
        Self {
            size: self.size.or((!from_file).then_some(size)),
            ..self
        }
    }

    /// The world's up direction, unless a file places the camera.
    #[cfg(feature = "view")]
    pub(super) fn up(&self) -> Option<DVec3> {
        let from_file = self.camera.is_some() || self.cameras.is_some();
        (!from_file).then_some(self.up)
    }

    /// The cameras that the flags mean; reads their files.
    pub(super) fn meant(&self) -> Result<Views, Failure> {
        let size = self.size.unwrap_or(DEFAULT_SIZE);
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            let camera =
                Camera::look_at(eye, target, self.up, self.fov_y, size).map_err(Failure::usage)?;
            return Ok(Views::Given(vec![View {
                number: 0,
                name: "camera".into(),
                camera,
            }]));
        }
        if let Some(path) = &self.camera {
            let camera = self.sized(camera_files::load_camera(path)?)?;
            return Ok(Views::Given(vec![View {
                number: 0,
                name: path.display().to_string(),
                camera,
            }]));
        }
        let Some(path) = &self.cameras else {
            let (up, fov_y) = (self.up, self.fov_y);
            // Errors that do not depend on the scene are found before it is read.
            Camera::frame(&Bounds::of(&Gaussians::default()), up, fov_y, size)
                .map_err(Failure::usage)?;
            return Ok(Views::Framed { up, fov_y, size });
        };
        let loaded = camera_files::load_cameras(path)?.into_iter().enumerate();
        let mut views: Vec<View> = loaded
            .map(|(number, named)| View {
                number,
                name: named.name,
                camera: named.camera,
            })
            .collect();
        if !self.all() {
            views = vec![pick(views, &self.view, path)?];
        }
        for view in &mut views {
            view.camera = self.sized(view.camera)?;
        }
        Ok(Views::Given(views))
    }

    fn sized(&self, camera: Camera) -> Result<Camera, Failure> {
        self.size.map_or(Ok(camera), |size| {
            camera.resized(size).map_err(Failure::usage)
        })
    }
}

impl Views {
    /// The cameras, once the scene is known.
    pub(super) fn of(self, scene: &Scene<'_>) -> Result<Vec<View>, Failure> {
        match self {
            Self::Given(views) => Ok(views),
            Self::Framed { up, fov_y, size } => {
                let camera = Camera::frame(&Bounds::of(scene), up, fov_y, size)?;
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
    let found = index.and_then(|i| views.into_iter().nth(i));
    found.ok_or_else(|| {
        Failure::Usage(format!(
            "--view {wanted}: {} has {count} cameras, and none of that number (from 0) or name",
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
