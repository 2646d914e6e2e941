//! The edges of faces: which faces share them, whether they are closed, and what closes them.

use glam::DVec3;

use super::faces::{Buckets, Faces, place};
use super::report::MeshReport;
use super::sets::Sets;
use rara_base::counted::{counted, grouped};

/// No half-edge.
pub(super) const NONE: u32 = u32::MAX;

/// All edges, each with its half-edges: those of face f are 3 f, from its first corner to its second, 3 f + 1 and 3 f + 2.
pub(super) struct Edges(Buckets<u32>);

/// An edge between two vertices, the one of the smaller number first.
pub(super) struct Edge<'a> {
    pub(super) ends: [u32; 2],
    halves: &'a [(u32, u32)],
}

impl Edge<'_> {
    /// Its half-edges.
    pub(super) fn halves(&self) -> impl Iterator<Item = u32> + '_ {
        self.halves.iter().map(|(_, half)| *half)
    }

    pub(super) fn count(&self) -> usize {
        self.halves.len()
    }

    /// 1 for a half-edge that goes from the first end to the second one, and -1 for one back.
    pub(super) fn direction(&self, faces: &[[u32; 3]], half: u32) -> i64 {
        let from = faces[half as usize / 3][half as usize % 3];
        if from == self.ends[0] { 1 } else { -1 }
    }

    /// How many more half-edges go forward than back.
    pub(super) fn balance(&self, faces: &[[u32; 3]]) -> i64 {
        self.halves().map(|half| self.direction(faces, half)).sum()
    }

    /// The places of its ends, as messages have them.
    pub(super) fn name(&self, vertices: &[DVec3]) -> String {
        let [from, to] = self.ends.map(|end| place(vertices[end as usize]));
        format!("from {from} to {to}")
    }
}

impl Edges {
    pub(super) fn new(of: &Faces) -> Self {
        let half = |face: &[u32; 3], at: usize| {
            let (from, to) = (face[at], face[(at + 1) % 3]);
            (from.min(to), from.max(to))
        };
        let of_face = move |face| [0, 1, 2].map(|at| half(face, at));
        Self(Buckets::new(
            of.vertices.len(),
            of.faces.iter().flat_map(of_face),
        ))
    }

    /// All edges, in order of their ends.
    pub(super) fn all(&self) -> impl Iterator<Item = Edge<'_>> {
        self.0.all().zip(0..).flat_map(|(halves, vertex)| {
            halves.chunk_by(|a, b| a.0 == b.0).map(move |halves| Edge {
                ends: [vertex, halves[0].0],
                halves,
            })
        })
    }

    /// For each half-edge the other one of its edge, or [`NONE`] where it has not exactly one.
    pub(super) fn twins(&self, faces: usize) -> Vec<u32> {
        let mut twins = vec![NONE; 3 * faces];
        for edge in self.all() {
            if let [(_, a), (_, b)] = *edge.halves {
                twins[a as usize] = b;
                twins[b as usize] = a;
            }
        }
        twins
    }

    /// Refuses edges of an odd number of faces.
    pub(super) fn check(&self, of: &Faces) -> Result<(), String> {
        let mut first = None;
        let mut count = 0_u64;
        for edge in self.all().filter(|edge| edge.count() % 2 == 1) {
            count += 1;
            if first.is_none() {
                first = Some((edge.count(), edge.name(&of.vertices)));
            }
        }
        let Some((faces, name)) = first else {
            return Ok(());
        };
        let rest = match count {
            1 => String::new(),
            _ => format!("; it is the first of {} like it", grouped(count)),
        };
        Err(format!(
            "the mesh is not closed: the edge {name} has {}, and should have one on either side{rest}; fill the holes, or have \
             its inside decided by the winding number, which closes them",
            counted(faces, "face")
        ))
    }

    /// Adds faces that close the surface, whatever directions those that are there have: of each part of its rim, to the middle
    /// of that part's vertices. Then as many faces have an edge in one direction as in the other.
    pub(super) fn close(&self, of: &mut Faces, report: &mut MeshReport) {
        let mut rim = Vec::new();
        for edge in self.all() {
            let balance = edge.balance(&of.faces);
            let [from, to] = match balance > 0 {
                true => [edge.ends[1], edge.ends[0]],
                false => edge.ends,
            };
            rim.extend((0..balance.unsigned_abs()).map(|_| [from, to]));
        }
        if rim.is_empty() {
            return;
        }
        let mut parts = Sets::new(of.vertices.len());
        for [from, to] in &rim {
            parts.join(*from, *to, false);
        }
        let mut sums = std::collections::BTreeMap::new();
        for [from, _] in &rim {
            let (sum, count) = sums
                .entry(parts.find(*from).0)
                .or_insert((DVec3::ZERO, 0.0));
            *sum += of.vertices[*from as usize];
            *count += 1.0;
        }
        let mut middles = std::collections::BTreeMap::new();
        for (part, (sum, count)) in sums {
            middles.insert(part, of.vertices.len() as u32);
            of.vertices.push(sum / count);
        }
        report.closed = rim.len() as u64;
        for [from, to] in rim {
            of.faces.push([from, to, middles[&parts.find(from).0]]);
        }
    }
}
