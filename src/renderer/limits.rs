//! The most that frames will ask for, so that room for them is made before the first one.

use super::pair_room;
use crate::passes::shortlist_from;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_base::setters;
use rara_gpu::DeviceShape;
use rara_scene::camera::Camera;
use rara_scene::clip::{Clip, ClipOp, Inside, Plane, Quadric, Surface};
use rara_scene::mesh::{MOST_FACES, Mesh, MeshRule, shapes};
use rara_scene::placement::Placement;
use rara_scene::precision::ShFormat;
use rara_scene::settings::{Mode, Settings};

setters! {
    /// The most that frames will ask for, for [`Renderer::reserve`](super::Renderer::reserve): [`FrameLimits::new`] is the
    /// usual, and a host sets what it wants otherwise.
    #[derive(Debug, Clone, PartialEq)]
    #[non_exhaustive]
    pub struct FrameLimits {
        /// Width and height of the pictures, px, each by itself: of one that may be upright or lying, the longer side twice.
        pub size: (u32, u32),
        /// Gaussians of a scene, all of its layers together.
        pub gaussians: u32,
        /// Layers of a scene.
        pub layers: u32,
        /// How the scenes' spherical harmonics are stored.
        pub sh_format: ShFormat,
        /// Planes of a clip that is a list of planes; [`Camera::clip_near`] and [`Camera::clip_far`] add one each.
        pub planes: u32,
        /// Surfaces of a clip that bends or combines; 0 for none.
        pub surfaces: u32,
        /// Faces of the meshes whose insides a clip has; 0 for none.
        pub faces: u32,
        /// The settings that frames have, each with every kind of clip: modes, rasters, what is shown and with which laws.
        pub settings: Vec<Settings>,
        /// Pairs of tile and splat, for which there is then exactly this room: a frame with more has coarse lists, the same
        /// picture in two to six times the time, or far more where there is room for fewer pairs than Gaussians, and
        /// [`fell_back`](super::Renderer::fell_back) says so.
        /// [`SceneBuffers::estimated_pairs`](crate::SceneBuffers::estimated_pairs) tells a camera's. `None` for the usual room:
        /// 2 a Gaussian and 64 a tile of 8x8 pixels; frames with more then have it grow, which allocates.
        pub pairs: Option<u32>,
    }
}

impl FrameLimits {
    /// Pictures of so many pixels and scenes of so many Gaussians in one layer, cut by up to six planes in any mode, with the
    /// other settings as they are by default.
    pub fn new(size: (u32, u32), gaussians: u32) -> Self {
        let modes = [Mode::None, Mode::Hard, Mode::Rara, Mode::Exact];
        Self {
            size,
            gaussians,
            layers: 1,
            sh_format: ShFormat::default(),
            planes: 6,
            surfaces: 0,
            faces: 0,
            settings: modes.map(|mode| Settings::default().mode(mode)).to_vec(),
            pairs: None,
        }
    }

    /// That there can be such frames.
    pub(super) fn check(&self) -> Result<()> {
        let refuse = |what: String| Err(Error::Invalid(format!("FrameLimits::{what}")));
        let possible = 1..=Camera::MAX_SIZE;
        let (width, height) = self.size;
        if !possible.contains(&width) || !possible.contains(&height) {
            return refuse(format!(
                "size is {width}x{height}: a picture has 1 to {} pixels a side",
                Camera::MAX_SIZE
            ));
        }
        if self.layers == 0 {
            return refuse("layers is 0: a scene has at least one".into());
        }
        let places =
            u64::from(self.gaussians) + u64::from(self.layers) * u64::from(limits::BLOCK_SIZE);
        if places > u64::from(u32::MAX) {
            return refuse(format!(
                "gaussians is {} in {}: beyond the 2^32 of an index",
                self.gaussians,
                counted(self.layers, "layer")
            ));
        }
        let most = self.planes.max(self.surfaces);
        if most as usize > Clip::MAX_SURFACES {
            return refuse(format!(
                "planes or surfaces is {most}: a clip has {} at most",
                Clip::MAX_SURFACES
            ));
        }
        if self.faces as usize > MOST_FACES {
            return refuse(format!(
                "faces is {}: a mesh has {MOST_FACES} at most",
                self.faces
            ));
        }
        if let Some(pairs) = self.pairs.filter(|&pairs| pairs > pair_room::MOST) {
            return refuse(format!(
                "pairs is {pairs}: there is room for {} at most",
                pair_room::MOST
            ));
        }
        if self.settings.is_empty() {
            return refuse("settings is empty: give those that frames will have".into());
        }
        Ok(())
    }

    /// A clip of each kind that pipelines and buffers tell apart: none, and lists of planes and combinations of one surface,
    /// of several, of so many that blocks have shortlists of them, and of so many that splats have long records.
    pub(super) fn clips(&self, shape: DeviceShape) -> Result<Vec<Clip>> {
        let long = shortlist_from(shape);
        let many = limits::RECORD_SURFACES + 1;
        let mut clips = vec![Clip::default()];
        for count in counts([1, 2, long, many, self.planes], self.planes) {
            clips.push(planes(count)?);
        }
        // A layer that bends beside one of many planes has its code, shortlists and long records.
        let most = match self.layers > 1 && self.surfaces > 0 {
            true => self.surfaces.max(self.planes.min(long.max(many))),
            false => self.surfaces,
        };
        for count in counts([1, long, many, most, most], most) {
            clips.push(spheres(count)?);
        }
        if self.faces > 0 {
            let alone = Clip::of([mesh(self.faces)?], ClipOp::And);
            let beside = counts([1, long, many, most, most], most).map(spheres);
            let beside = beside.collect::<Result<Vec<_>>>()?.into_iter();
            clips.extend(beside.map(|spheres| Clip::joined([spheres, alone.clone()], ClipOp::And)));
            clips.push(alone);
        }
        Ok(clips)
    }
}

/// Those of some numbers, each once, that are not 0 and not beyond the most.
fn counts(mut counts: [u32; 5], most: u32) -> impl Iterator<Item = u32> {
    counts.sort_unstable();
    let mut last = 0;
    counts.into_iter().filter(move |count| {
        let is_new = *count > last && *count <= most;
        last = last.max(*count);
        is_new
    })
}

/// So many planes, no two of them the same.
fn planes(count: u32) -> Result<Clip> {
    let plane = |index| Plane::new(glam::DVec3::X, f64::from(index));
    let planes: Vec<Plane> = (0..count).map(plane).collect::<Result<_>>()?;
    Ok(Clip::of(planes, ClipOp::And))
}

/// So many spheres, no two of them the same.
fn spheres(count: u32) -> Result<Clip> {
    let sphere = |index| Quadric::sphere(glam::DVec3::X * f64::from(index), 1.0);
    let spheres: Vec<Surface> = (0..count)
        .map(|index| Ok(Surface::Quadric(sphere(index)?)))
        .collect::<Result<_>>()?;
    Ok(Clip::of(spheres, ClipOp::And))
}

/// The inside of a mesh of so many faces or a few more.
fn mesh(faces: u32) -> Result<Inside> {
    const ALONG: u32 = 16;
    let around = faces.div_ceil(2 * ALONG).max(3);
    let (vertices, faces) = shapes::torus(around, ALONG);
    let mesh = Mesh::from_triangles(&vertices, &faces, MeshRule::Winding)?; // which is not checked
    Ok(Inside::new(mesh, Placement::IDENTITY))
}

#[cfg(test)]
mod tests;
