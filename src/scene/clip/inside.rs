//! The inside of a mesh as a surface.

use glam::{DQuat, DVec3};

use super::surface_kind::SurfaceKind;
use crate::mesh::Mesh;
use crate::placement::Placement;
use rara_base::error::Result;

/// The inside of a closed mesh that stands somewhere, or all that is outside of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Inside {
    mesh: Mesh,
    placement: Placement,
    keeps_outside: bool,
}

impl Inside {
    /// The inside of a mesh that is placed as a scene is.
    pub fn new(mesh: Mesh, placement: Placement) -> Self {
        Self {
            mesh,
            placement,
            keeps_outside: false,
        }
    }

    /// Returns the mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Returns where the mesh stands: its scale, its rotation and its place.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// True where what is outside is kept.
    pub fn keeps_outside(&self) -> bool {
        self.keeps_outside
    }

    /// Returns the distance of a point from the mesh, world units: positive where the surface keeps the point.
    pub fn distance(&self, point: DVec3) -> f64 {
        let inside = self.mesh.signed_distance(self.placement.to_scene(point));
        let sign = if self.keeps_outside { -1.0 } else { 1.0 };
        sign * self.placement.scale() * inside
    }

    /// Returns where the line of points `start + t step` crosses the mesh, in no order: each as its t, and by how much the winding
    /// number of the mesh changes there.
    pub fn signed_crossings(&self, start: DVec3, step: DVec3) -> Vec<(f64, f64)> {
        let there = &self.placement;
        let step = there.rotation().inverse() * step / there.scale();
        let mut found = Vec::new();
        self.mesh.crossings(there.to_scene(start), step, &mut found);
        found
    }

    /// Returns the same inside after it was scaled, then turned, then moved, as a scene with this placement is.
    ///
    /// # Errors
    /// The errors of [`Placement::new`], where numbers overflow.
    pub fn placed(&self, placement: &Placement) -> Result<Self> {
        Ok(Self {
            placement: self.placement.placed(placement)?,
            ..self.clone()
        })
    }

    /// Returns the surface in the space of a scene that has this placement.
    #[must_use]
    pub fn in_scene(&self, placement: &Placement) -> Self {
        Self {
            placement: self.placement.in_scene(placement),
            ..self.clone()
        }
    }
}

impl SurfaceKind for Inside {
    fn complement(&self) -> Self {
        Self {
            keeps_outside: !self.keeps_outside,
            ..self.clone()
        }
    }

    fn gradient(&self, point: DVec3) -> DVec3 {
        let gradient = self.mesh.gradient(self.placement.to_scene(point));
        let turned = self.placement.rotation() * gradient;
        if self.keeps_outside { -turned } else { turned }
    }

    fn numbers(&self) -> Vec<f64> {
        let hash = self.mesh.content_hash();
        let (place, turn) = (self.placement.position(), self.placement.rotation());
        let DQuat { x, y, z, w } = turn;
        let halves = [hash >> 32, hash & 0xffff_ffff].map(|half| half as f64);
        let side = if self.keeps_outside { 1.0 } else { 0.0 };
        [
            &halves[..],
            &place.to_array(),
            &[x, y, z, w, self.placement.scale(), side],
        ]
        .concat()
    }
}
