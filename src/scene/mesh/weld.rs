//! One vertex for all that are at the same place, and no faces that are none.

use glam::DVec3;
use robust::{Coord, orient2d};

use super::MeshRule;
use super::duplicates::drop_duplicates;
use super::edges::Edges;
use super::faces::{Faces, normal, place};
use super::report::MeshReport;

/// The largest coordinate that a vertex may have, so that no product of a few overflows.
const FARTHEST: f64 = 1e30;

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
