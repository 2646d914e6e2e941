//! One vertex for all that are at the same place, and no faces that are none.

use glam::DVec3;
use robust::{Coord, orient2d};

use super::MeshRule;
use super::duplicates::drop_duplicates;
use super::edges::Edges;
use super::orient::normal;
use super::report::MeshReport;

/// The largest coordinate that a vertex may have, so that no product of a few overflows.
const FARTHEST: f64 = 1e30;

/// Vertices and the faces over them.
#[derive(Debug, Clone, Default)]
pub(super) struct Faces {
    pub(super) vertices: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
}

impl Faces {
    /// The corners of a face.
    pub(super) fn corners(&self, face: usize) -> [DVec3; 3] {
        self.faces[face].map(|vertex| self.vertices[vertex as usize])
    }

    /// The faces in another order, and the vertices as those need them first, so that what is close is so in memory too.
    pub(super) fn in_order(&self, order: &[u32]) -> Self {
        let mut made = Self {
            vertices: Vec::with_capacity(self.vertices.len()),
            faces: Vec::with_capacity(order.len()),
        };
        let mut numbers = vec![u32::MAX; self.vertices.len()];
        for face in order {
            made.faces.push(self.faces[*face as usize].map(|vertex| {
                let number = &mut numbers[vertex as usize];
                if *number == u32::MAX {
                    *number = made.vertices.len() as u32;
                    made.vertices.push(self.vertices[vertex as usize]);
                }
                *number
            }));
        }
        made
    }
}

/// A place as messages have it.
pub(super) fn place(at: DVec3) -> String {
    format!("({}, {}, {})", at.x, at.y, at.z)
}

/// The same faces over vertices of which no two are at one place, and all are of some face.
pub(super) fn welded(
    vertices: &[DVec3],
    faces: &[[u32; 3]],
    rule: MeshRule,
    report: &mut MeshReport,
) -> Result<Faces, String> {
    const NONE: u32 = u32::MAX;
    let mut made = Faces {
        vertices: Vec::new(),
        faces: Vec::with_capacity(faces.len()),
    };
    // The number that each vertex gets.
    let mut numbers = vec![NONE; vertices.len()];
    let mut known = Places::new(vertices.len());
    for (number, face) in faces.iter().enumerate() {
        let mut welded = [0; 3];
        for (to, &vertex) in welded.iter_mut().zip(face) {
            let at = *vertices.get(vertex as usize).ok_or_else(|| {
                format!(
                    "face {number} names vertex {vertex}, and there are {}; export the mesh again",
                    vertices.len()
                )
            })?;
            if numbers[vertex as usize] == NONE {
                if !at.abs().cmple(DVec3::splat(FARTHEST)).all() {
                    return Err(format!(
                        "face {number} has a corner at {}, which is not finite or beyond {FARTHEST:e}; export the mesh again",
                        place(at)
                    ));
                }
                // There is one zero.
                let at = at + DVec3::ZERO;
                let (own, is_new) = known.number(at, &mut made.vertices);
                numbers[vertex as usize] = own;
                report.welded += u64::from(!is_new);
            }
            *to = numbers[vertex as usize];
        }
        let [a, b, c] = welded;
        match a == b || b == c || c == a {
            true => report.degenerate += 1,
            false => made.faces.push(welded),
        }
    }
    if rule == MeshRule::Closed {
        drop_duplicates(&mut made, report);
    }
    Ok(made)
}

/// Drops faces without an area, unless the surface is open without them: three corners of a line, of which the neighbours have
/// only some. Returns the edges of what is left.
pub(super) fn without_slivers(of: &mut Faces, edges: Edges, report: &mut MeshReport) -> Edges {
    let is_sliver = |face: usize| is_line(of.corners(face));
    let count = (0..of.faces.len()).filter(|face| is_sliver(*face)).count() as u64;
    if count == 0 {
        return edges;
    }
    let kept = (0..of.faces.len()).filter(|face| !is_sliver(*face));
    let rest = Faces {
        vertices: of.vertices.clone(),
        faces: kept.map(|face| of.faces[face]).collect(),
    };
    let edges_of_rest = Edges::new(&rest);
    match edges_of_rest.check(&rest) {
        Ok(()) => {
            report.degenerate += count;
            *of = rest;
            edges_of_rest
        }
        Err(_) => {
            report.slivers = count;
            edges
        }
    }
}

/// True for corners of a line, exactly.
fn is_line(corners: [DVec3; 3]) -> bool {
    let size = (corners[1] - corners[0]).abs() * (corners[2] - corners[0]).abs().max_element();
    // Most faces have far more area than rounding can make up.
    if normal(corners).length() > 1e-9 * size.max_element() {
        return false;
    }
    (0..3).all(|axis| {
        let [a, b, c] = corners.map(|corner| Coord {
            x: corner[axis],
            y: corner[(axis + 1) % 3],
        });
        orient2d(a, b, c) == 0.0
    })
}

/// Things that vertices have, those of each vertex in order of a key: the key, and the number of the thing.
pub(super) struct Buckets<K> {
    first: Vec<u32>,
    items: Vec<(K, u32)>,
}

impl<K: Copy + Default + Ord> Buckets<K> {
    /// Sorts things, given by their vertex and their key.
    pub(super) fn new(vertices: usize, all: impl Iterator<Item = (u32, K)> + Clone) -> Self {
        let mut first = vec![0_u32; vertices + 1];
        let mut count = 0;
        for (vertex, _) in all.clone() {
            first[vertex as usize + 1] += 1;
            count += 1;
        }
        for at in 1..first.len() {
            first[at] += first[at - 1];
        }
        let mut items = vec![(K::default(), 0); count];
        let mut next = first.clone();
        for (number, (vertex, key)) in all.enumerate() {
            let at = &mut next[vertex as usize];
            items[*at as usize] = (key, number as u32);
            *at += 1;
        }
        for ends in first.windows(2) {
            items[ends[0] as usize..ends[1] as usize].sort_unstable();
        }
        Self { first, items }
    }

    /// The things of each vertex in turn.
    pub(super) fn all(&self) -> impl Iterator<Item = &[(K, u32)]> {
        let ends = self.first.windows(2);
        ends.map(|ends| &self.items[ends[0] as usize..ends[1] as usize])
    }
}

/// The numbers of places, found by their coordinates.
struct Places {
    /// Numbers plus 1, each at the first free slot from its hash on; 0 where there is none.
    slots: Vec<u32>,
}

impl Places {
    fn new(most: usize) -> Self {
        Self {
            slots: vec![0; (2 * most).next_power_of_two()],
        }
    }

    /// The number of a place, and whether it is new.
    fn number(&mut self, at: DVec3, known: &mut Vec<DVec3>) -> (u32, bool) {
        let mix = |hash: u64, part: f64| {
            let mixed = (hash ^ part.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            mixed ^ (mixed >> 29)
        };
        let hash = at.to_array().into_iter().fold(0, mix);
        let last = self.slots.len() - 1;
        let mut slot = (hash ^ (hash >> 32)) as usize & last;
        loop {
            match self.slots[slot] {
                0 => {
                    known.push(at);
                    self.slots[slot] = known.len() as u32;
                    return (known.len() as u32 - 1, true);
                }
                number if known[number as usize - 1] == at => return (number - 1, false),
                _ => slot = (slot + 1) & last,
            }
        }
    }
}
