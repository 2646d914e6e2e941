//! The lines by which people recognise a mesh.

use glam::DVec3;

use super::Mesh;
use super::edges::{Edges, NONE};
use super::faces::normal;

/// The cosine of the angle from which on two faces meet in an edge that is seen: 30 degrees.
const SHARP: f64 = 0.866;

impl Mesh {
    /// The ends of the edges that are seen from a point, or from far away: those at which faces meet at more than 30 degrees, and
    /// those at which they turn away from the eye. `to_eye` is the direction from a place of the mesh to the eye.
    pub(crate) fn outline(&self, to_eye: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 2]> {
        let faces = &self.0.made;
        let twins = self
            .0
            .twins
            .get_or_init(|| Edges::new(faces).twins(faces.faces.len()));
        let seen = |face: u32| {
            let corners = self.corners(face);
            let normal = normal(corners).normalize_or_zero();
            (normal, normal.dot(to_eye(corners[0])) > 0.0)
        };
        let seen: Vec<_> = (0..faces.faces.len() as u32).map(seen).collect();
        let is_line = |half: u32, twin: u32| {
            let [(here, is_front), (there, is_front_there)] =
                [half, twin].map(|half| seen[half as usize / 3]);
            is_front != is_front_there || here.dot(there) < SHARP
        };
        let halves = (0_u32..).zip(twins);
        // Each edge by the first of its half-edges.
        let lines =
            halves.filter(|&(half, &twin)| twin == NONE || half < twin && is_line(half, twin));
        let ends = lines.map(|(half, _)| {
            let corners = self.corners(half / 3);
            [half % 3, (half + 1) % 3].map(|corner| corners[corner as usize])
        });
        ends.collect()
    }
}
