//! Triangles of the polygons that files have as faces.

use glam::DVec3;
use robust::{Coord, orient2d};

use super::MOST_FACES;

/// The most corners of a polygon that is not convex.
const MOST_CORNERS: usize = 1000;

/// Faces of any number of corners.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    /// The corners of all, one face behind the other.
    pub(super) corners: Vec<u32>,
    /// How many each has; empty where all have three.
    pub(super) counts: Vec<u32>,
}

impl Polygons {
    /// The triangles of all faces. Those of fewer than three corners are points and lines, and have none.
    pub(super) fn triangles(&self, vertices: &[DVec3]) -> Result<Vec<[u32; 3]>, String> {
        let (triangles, _) = self.corners.as_chunks();
        if self.counts.is_empty() {
            return Ok(triangles.to_vec());
        }
        let mut made = Vec::with_capacity(triangles.len());
        let mut rest = &self.corners[..];
        for (number, count) in self.counts.iter().enumerate() {
            let (corners, behind) = rest.split_at(*count as usize);
            rest = behind;
            divide(corners, vertices, &mut made).map_err(|what| {
                format!("face {number} {what}; divide it into triangles where it is made")
            })?;
            if made.len() > MOST_FACES {
                return Err(format!(
                    "the faces have more than {MOST_FACES} triangles; simplify the mesh"
                ));
            }
        }
        Ok(made)
    }
}

/// Adds the triangles of a polygon, which may be concave.
fn divide(corners: &[u32], vertices: &[DVec3], made: &mut Vec<[u32; 3]>) -> Result<(), String> {
    let place = |corner: u32| vertices[corner as usize];
    match *corners {
        [] | [_] | [_, _] => return Ok(()),
        [a, b, c] => {
            made.push([a, b, c]);
            return Ok(());
        }
        _ => {}
    }
    // Newell's normal, from a corner on, so that a place far from zero costs no digits.
    let from = |corner: u32| place(corner) - place(corners[0]);
    let up: DVec3 = (0..corners.len())
        .map(|at| from(corners[at]).cross(from(corners[(at + 1) % corners.len()])))
        .sum();
    let z = up.abs().max_position();
    let (x, y) = match up[z] < 0.0 {
        false => ((z + 1) % 3, (z + 2) % 3),
        true => ((z + 2) % 3, (z + 1) % 3),
    };
    let flat: Vec<_> = corners
        .iter()
        .map(|corner| Coord {
            x: place(*corner)[x],
            y: place(*corner)[y],
        })
        .collect();
    let turn = |a: usize, b: usize, c: usize| orient2d(flat[a], flat[b], flat[c]);
    let count = corners.len();
    // All that lies to the left of every triangle from the first corner on is convex.
    if (1..count - 1).all(|at| turn(0, at, at + 1) > 0.0)
        && (0..count).all(|at| turn(at, (at + 1) % count, (at + 2) % count) >= 0.0)
    {
        made.extend((1..count - 1).map(|at| [corners[0], corners[at], corners[at + 1]]));
        return Ok(());
    }
    if count > MOST_CORNERS {
        return Err(format!(
            "has {count} corners and is not convex, and at most {MOST_CORNERS} are read"
        ));
    }
    // One ear after the other: a corner whose triangle has no other corner in it.
    let mut left: Vec<usize> = (0..count).collect();
    let mut at = 0;
    let mut skipped = 0;
    while left.len() > 3 {
        let own = [0, 1, 2].map(|step| left[(at + step) % left.len()]);
        let [a, b, c] = own;
        let holds = |other: usize| {
            turn(a, b, other) >= 0.0 && turn(b, c, other) >= 0.0 && turn(c, a, other) >= 0.0
        };
        let is_other = |other: &usize| own.iter().all(|corner| corners[*corner] != corners[*other]);
        let is_ear = turn(a, b, c) > 0.0
            && !left
                .iter()
                .filter(|other| is_other(other))
                .any(|other| holds(*other));
        // Where there is no ear, the polygon crosses itself, and any corner will do.
        if is_ear || skipped == left.len() {
            made.push(own.map(|corner| corners[corner]));
            let middle = (at + 1) % left.len();
            left.remove(middle);
            at = if middle == 0 { left.len() - 1 } else { middle } % left.len();
            skipped = 0;
        } else {
            at = (at + 1) % left.len();
            skipped += 1;
        }
    }
    made.push([left[0], left[1], left[2]].map(|corner| corners[corner]));
    Ok(())
}
