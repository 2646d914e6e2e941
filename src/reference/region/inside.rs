//! The inside of a mesh. Where a line crosses it is found in double precision, from all of its faces.

use glam::{DMat3, DVec3};

use super::face_mass::mesh_share;
use super::quadric::Symmetric;
use super::region_surface::RegionSurface;
use super::{Ellipsoid, HalfSpace, Side, UnitSurface};
use crate::real::{Real, Vec3};
use rara_scene::clip::{Inside, Surface};
use rara_scene::mesh::MeshRule;

/// A mesh as a Gaussian sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitInside<T> {
    inside: Inside,
    centre: DVec3,
    axes: DMat3,
    /// The plane of the nearest face.
    pub(super) nearest: UnitSurface<T>,
}

fn wide<T: Real>(v: Vec3<T>) -> DVec3 {
    DVec3::new(v.x.wide(), v.y.wide(), v.z.wide())
}

fn columns<T: Real>(vectors: [Vec3<T>; 3]) -> DMat3 {
    let [u, v, w] = vectors.map(wide);
    DMat3::from_cols(u, v, w)
}

/// Vectors of the layer in the space of a mesh that stands there.
fn in_mesh(inside: &Inside, vectors: DMat3) -> DMat3 {
    let there = inside.placement();
    DMat3::from_quat(there.rotation().inverse()) * vectors * (1.0 / there.scale())
}

impl<T: Real> UnitInside<T> {
    pub(super) fn new(inside: &Inside, ellipsoid: &Ellipsoid<T>) -> Self {
        Self {
            inside: inside.clone(),
            centre: ellipsoid.centre,
            axes: columns(ellipsoid.axes),
            nearest: inside.unit_surface(ellipsoid),
        }
    }

    /// The share that the mesh keeps of a normal distribution of this mean and these deviations, in the unit space; none where its faces
    /// cut each other, or where the distribution has no width.
    pub(super) fn share(&self, mean: Vec3<T>, deviations: [Vec3<T>; 3]) -> Option<T> {
        let mesh = self.inside.mesh();
        let deviations = columns(deviations);
        let longest = deviations.x_axis.length_squared();
        let is_flat = deviations.determinant().abs() < 1e-12 * longest.max(1e-30);
        if is_flat || mesh.rule() != MeshRule::Closed {
            return None;
        }
        let mean = self.centre + self.axes * wide(mean);
        let there = self.inside.placement().to_scene(mean);
        let share = mesh_share(mesh, there, in_mesh(&self.inside, self.axes * deviations));
        Some(T::of(if self.inside.keeps_outside() {
            1.0 - share
        } else {
            share
        }))
    }

    /// True when a point of the unit space is kept.
    pub(super) fn keeps(&self, point: Vec3<T>) -> bool {
        self.inside.distance(self.centre + self.axes * wide(point)) >= 0.0
    }

    /// The places at which the line of points `at + t direction` goes in or comes out, in order, and whether it is kept before them.
    pub(super) fn changes(&self, at: Vec3<T>, direction: Vec3<T>) -> (bool, Vec<T>) {
        let start = self.centre + self.axes * wide(at);
        let mut crossings = self
            .inside
            .signed_crossings(start, self.axes * wide(direction));
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0.0;
        let mut changes = Vec::new();
        for (t, grows) in crossings {
            let before = winding != 0.0;
            winding += grows;
            if before != (winding != 0.0) {
                changes.push(T::of(t));
            }
        }
        (self.inside.keeps_outside(), changes)
    }
}

fn side_of(inside: &Inside, point: DVec3) -> Side {
    match inside.distance(point) >= 0.0 {
        true => Side::Visible,
        false => Side::Invisible,
    }
}

impl RegionSurface for Inside {
    fn gaussian_side<T: Real>(&self, ellipsoid: &Ellipsoid<T>, deviations: T) -> Side {
        let axes = in_mesh(self, columns(ellipsoid.axes));
        let centre = self.placement().to_scene(ellipsoid.centre);
        match self.mesh().touches_ball(centre, axes, deviations.wide()) {
            true => Side::Cutoff,
            false => side_of(self, ellipsoid.centre),
        }
    }

    fn box_side(&self, middle: DVec3, half: DVec3, support: f64) -> Side {
        // The ball around the box.
        match self.distance(middle).abs() > half.length() + support {
            true => side_of(self, middle),
            false => Side::Cutoff,
        }
    }

    /// The plane of the nearest face.
    fn unit_surface<T: Real>(&self, ellipsoid: &Ellipsoid<T>) -> UnitSurface<T> {
        let surface = Surface::from(self.clone());
        let gradient = surface.gradient(ellipsoid.centre);
        let distance = self.distance(ellipsoid.centre);
        UnitSurface {
            half_space: HalfSpace::of_plane(ellipsoid, gradient, distance),
            bend: Symmetric::zero(),
        }
    }

    fn crossings(&self, start: DVec3, step: DVec3) -> Vec<f64> {
        let crossings = self.signed_crossings(start, step).into_iter();
        crossings.map(|(at, _)| at).collect()
    }
}
