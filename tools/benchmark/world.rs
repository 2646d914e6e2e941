//! Scenes, the cameras that look at them and the planes that cut them.

use std::path::PathBuf;

use glam::DVec3;
use rara::camera_files::load_cameras;
use rara::scene::{Bounds, Kind, generate, load};
use rara::{Camera, Clip, ClipOp, Error, Gaussians, Plane, Result, glam};

/// Degrees that the camera moves in a frame, as in measurements of other renderers.
const STEP: f64 = 4.0;
/// How far away the orbit is, in radii of the scene, and how far above its middle.
const DISTANCE: f64 = 2.2;
const HEIGHT: f64 = 0.36;
const FOV_Y: f64 = 50.0;

/// The origin of a scene.
#[derive(Debug, Clone)]
pub(crate) enum Source {
    Made(Kind, u32),
    /// A file, and the file of its cameras.
    File(PathBuf, Option<PathBuf>),
}

impl Source {
    /// The name that the tables give it.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Made(Kind::General, _) => "general".into(),
            Self::Made(Kind::Strands, _) => "strands".into(),
            Self::Made(Kind::Layers, _) => "layers".into(),
            Self::File(path, _) => path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into(),
        }
    }

    /// Gaussians, as far as their number is known before the scene is.
    pub(crate) fn expected(&self) -> usize {
        match self {
            Self::Made(_, count) => *count as usize,
            // This assumes SH of degree 3, with 248 bytes a Gaussian; a file of a lower degree holds more of them.
            Self::File(path, _) => path.metadata().map_or(0, |m| m.len() as usize / 248),
        }
    }

    /// Makes or loads it.
    pub(crate) fn world(&self) -> Result<World> {
        let (scene, cameras) = match self {
            Self::Made(kind, count) => (generate(*kind, *count as usize, 1), Vec::new()),
            Self::File(path, cameras) => {
                let cameras = match cameras {
                    Some(path) => load_cameras(path)?.into_iter().map(|c| c.camera).collect(),
                    None => Vec::new(),
                };
                (load(path, &mut |_, _| {})?.gaussians, cameras)
            }
        };
        if scene.is_empty() {
            return Err(Error::Invalid(format!(
                "{}: there is no Gaussian in it",
                self.name()
            )));
        }
        Ok(World {
            name: self.name(),
            bounds: Bounds::of(&scene),
            scene,
            cameras,
        })
    }
}

/// A scene, its cameras and the planes that cut it.
#[derive(Debug)]
pub(crate) struct World {
    pub(crate) name: String,
    pub(crate) scene: Gaussians,
    pub(crate) bounds: Bounds,
    cameras: Vec<Camera>,
}

impl World {
    /// The camera of a frame, for a picture of this width: the file's in turn, or round the scene.
    pub(crate) fn camera(&self, frame: u32, width: u32) -> Result<Camera> {
        if self.cameras.is_empty() {
            let turn = (STEP * f64::from(frame)).to_radians();
            let direction = DVec3::new(turn.sin(), -HEIGHT, -turn.cos()).normalize();
            let eye = self.bounds.centre() + DISTANCE * self.bounds.radius() * direction;
            let up = DVec3::NEG_Y;
            return Camera::look_at(eye, self.bounds.centre(), up, FOV_Y, (width, width));
        }
        let camera = self.cameras[frame as usize % self.cameras.len()];
        let height = f64::from(camera.height) * f64::from(width) / f64::from(camera.width);
        camera.resized((width, (height.round() as u32).max(1)))
    }

    /// The plane across `normal` that keeps this share of the centres. It goes between two of them: if it touched one,
    /// rounding would decide on which side that is.
    pub(crate) fn keeping(&self, share: f64, normal: DVec3) -> Result<Clip> {
        let along = self
            .scene
            .positions()
            .iter()
            .map(|p| normal.dot(p.as_dvec3()));
        let mut along: Vec<f64> = along.collect();
        let first = ((1.0 - share) * along.len() as f64) as usize;
        let first = first.min(along.len() - 1);
        let (below, &mut kept, _) = along.select_nth_unstable_by(first, f64::total_cmp);
        let dropped = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let dropped = if dropped.is_finite() { dropped } else { kept };
        clip_at(normal, (kept + dropped) / 2.0)
    }

    /// A plane through the middle, oblique to every axis.
    pub(crate) fn halved(&self) -> Result<Clip> {
        self.keeping(0.5, DVec3::new(0.9, 0.3, 0.2).normalize())
    }
}

/// Keeps the points with `normal . x` at least `at`.
pub(crate) fn clip_at(normal: DVec3, at: f64) -> Result<Clip> {
    Ok(Clip::of([Plane::new(normal, -at)?], ClipOp::And))
}
