//! Scenes, the cameras that look at them and the planes that cut them.

use std::path::{Path, PathBuf};

use glam::DVec3;
use rara::camera_files::{NamedCamera, load_cameras};
use rara::scene::{Bounds, Kind, generate};
use rara::{Camera, Clip, ClipOp, Error, Gaussians, Plane, Result};

use crate::cases::{Source, sources};

/// Degrees that the camera moves in a frame, as in measurements of other renderers.
const STEP: f64 = 4.0;
/// How far away the orbit is, in radii of the scene, and how far above its middle.
const DISTANCE: f64 = 2.2;
const HEIGHT: f64 = 0.36;
const FOV_Y: f64 = 50.0;

#[derive(Debug)]
pub(super) struct World {
    pub(super) name: String,
    pub(super) scene: Gaussians,
    /// The file that the scene is from.
    pub(super) file: Option<PathBuf>,
    bounds: Bounds,
    cameras: Vec<Camera>,
}

impl World {
    pub(super) fn made(name: &str, kind: Kind, count: usize) -> Self {
        let scene = generate(kind, count, 1);
        Self {
            name: name.into(),
            bounds: Bounds::of(&scene),
            scene,
            file: None,
            cameras: Vec::new(),
        }
    }

    /// A scene from a file, seen by the cameras of another one.
    pub(super) fn load(file: &Path, cameras: Option<&Path>) -> Result<Self> {
        let Source { name, gaussians } = sources(&[file.into()], 0)?.remove(0);
        if gaussians.is_empty() {
            return Err(Error::format(file, "there is no Gaussian in it"));
        }
        let cameras = cameras.map(load_cameras).transpose()?.unwrap_or_default();
        let cameras = cameras.iter().map(NamedCamera::camera);
        Ok(Self {
            name,
            bounds: Bounds::of(&gaussians),
            scene: gaussians,
            file: Some(file.into()),
            cameras: cameras.collect::<Result<_>>()?,
        })
    }

    /// The camera of a frame, for a picture of this width: the file's in turn, or round the scene.
    pub(super) fn camera(&self, frame: u32, width: u32) -> Result<Camera> {
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

    /// The plane, oblique to every axis, that keeps this share of the centres. It goes between two of them: if it touched
    /// one, rounding would decide on which side that is.
    pub(super) fn keeping(&self, share: f64) -> Result<Clip> {
        let normal = DVec3::new(0.9, 0.3, 0.2).normalize();
        let along = |p: &glam::Vec3| normal.dot(p.as_dvec3());
        let mut along: Vec<f64> = self.scene.positions().iter().map(along).collect();
        let first = ((1.0 - share) * along.len() as f64) as usize;
        let first = first.min(along.len() - 1);
        let (below, &mut kept, _) = along.select_nth_unstable_by(first, f64::total_cmp);
        let dropped = below.iter().copied().reduce(f64::max).unwrap_or(kept);
        let at = f64::midpoint(kept, dropped);
        Ok(Clip::of([Plane::new(normal, -at)?], ClipOp::And))
    }
}
