//! Faces of a mesh that cut each other, found exactly.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{BVec3, DVec3};
use robust::{Coord, orient2d};

use super::lines::below;
use super::orient::normal;
use super::tree::MeshTree;
use super::weld::{Faces, place};
use rara_base::counted::grouped;
use rara_base::parallel::in_parallel;

/// Faces that one task looks at.
const TASK: usize = 1 << 13;
/// Pairs of faces that a task looks at for each of its faces before it gives up: real meshes have some tens.
const MOST_PAIRS: u64 = 2048;

/// What a task found.
#[derive(Default)]
struct Found {
    first: Option<[u32; 2]>,
    count: u64,
    /// True where it gave up.
    is_unfinished: bool,
}

/// Refuses faces that cut each other, or lie in each other. Those that touch in corners or edges that they share may.
pub(super) fn check(of: &Faces, tree: &MeshTree) -> Result<(), String> {
    let starts = (0..of.faces.len()).step_by(TASK);
    let has_given_up = AtomicBool::new(false);
    let found = in_parallel(starts, |start| {
        let end = (start + TASK).min(of.faces.len());
        look(of, tree, [start, end], &has_given_up)
    });
    if found.iter().any(|found| found.is_unfinished) {
        return Err(
            "so many faces of the mesh lie beside each other that it takes too long to see whether it cuts itself; give it fewer \
             faces, or have its inside decided by the winding number, which does not ask"
                .into(),
        );
    }
    let count: u64 = found.iter().map(|found| found.count).sum();
    if let Some([a, b]) = found.iter().find_map(|found| found.first) {
        let places = [a, b].map(|face| {
            let [a, b, c] = of.corners(face as usize).map(place);
            format!("{a}, {b}, {c}")
        });
        let rest = match count {
            1 => String::new(),
            _ => format!("; it is the first of {} such pairs", grouped(count)),
        };
        return Err(format!(
            "the mesh cuts itself: the face with the corners {} meets that with {}{rest}; mend it there, or have its inside \
             decided by the winding number",
            places[0], places[1]
        ));
    }
    Ok(())
}

/// Looks at some faces, each with those behind it.
fn look(of: &Faces, tree: &MeshTree, [start, end]: [usize; 2], has_given_up: &AtomicBool) -> Found {
    let mut found = Found::default();
    let mut left = MOST_PAIRS * (end - start) as u64;
    for face in start as u32..end as u32 {
        if has_given_up.load(Ordering::Relaxed) {
            break;
        }
        let corners = of.corners(face as usize);
        let [low, high] = hull(corners);
        found.is_unfinished |= tree.walk(
            |node| {
                let is_behind = node.count == 0 || node.first + node.count > face + 1;
                is_behind && overlap([node.low, node.high], [low, high])
            },
            |other| {
                if other <= face {
                    return false;
                }
                let others = of.corners(other as usize);
                if overlap(hull(others), [low, high]) {
                    left = left.saturating_sub(1);
                    let vertices = [face, other].map(|face| of.faces[face as usize]);
                    if meet(vertices, [corners, others]) {
                        found.count += 1;
                        found.first.get_or_insert([face, other]);
                    }
                }
                left == 0
            },
        );
        if found.is_unfinished {
            has_given_up.store(true, Ordering::Relaxed);
        }
    }
    found
}

fn hull([a, b, c]: [DVec3; 3]) -> [DVec3; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

fn overlap(a: [DVec3; 2], b: [DVec3; 2]) -> bool {
    let apart: BVec3 = a[0].cmpgt(b[1]) | b[0].cmpgt(a[1]);
    !apart.any()
}

/// True where two faces have points in common beside corners and edges that they share. A corner that only touches the other face
/// is nothing that they cut.
fn meet(vertices: [[u32; 3]; 2], corners: [[DVec3; 3]; 2]) -> bool {
    let is_shared = vertices[0].map(|vertex| vertices[1].contains(&vertex));
    let shared = is_shared.iter().filter(|shared| **shared).count();
    // On which side of the other face's plane the corners of a face are; those that they share are in it.
    let sides = |own: usize| {
        let other = 1 - own;
        [0, 1, 2].map(|at| match vertices[other].contains(&vertices[own][at]) {
            true => 0.0,
            false => below(corners[other], corners[own][at]),
        })
    };
    let first = sides(0);
    if first == [0.0; 3] {
        return lie_in_each_other(corners);
    }
    let is_apart = |sides: [f64; 3]| {
        sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
    };
    if shared > 1 || is_apart(first) {
        return false;
    }
    let second = sides(1);
    if is_apart(second) {
        return false;
    }
    pierces(corners[0], first, corners[1]) || pierces(corners[1], second, corners[0])
}

/// True where an edge of a face has its ends on both sides of another one's plane, and goes through that.
fn pierces(own: [DVec3; 3], sides: [f64; 3], other: [DVec3; 3]) -> bool {
    (0..3).any(|at| {
        let next = (at + 1) % 3;
        let is_through = sides[at].min(sides[next]) < 0.0 && sides[at].max(sides[next]) > 0.0;
        if !is_through {
            return false;
        }
        let around = [0, 1, 2].map(|at_other| {
            let edge = [other[at_other], other[(at_other + 1) % 3]];
            below([own[at], own[next], edge[0]], edge[1])
        });
        around.iter().all(|side| *side >= 0.0) || around.iter().all(|side| *side <= 0.0)
    })
}

/// True where two faces of one plane have some of it in common: no edge of either parts them.
fn lie_in_each_other(corners: [[DVec3; 3]; 2]) -> bool {
    let across = normal(corners[0]).abs();
    if across == DVec3::ZERO || normal(corners[1]) == DVec3::ZERO {
        return false;
    }
    let z = across.max_position();
    let flat = corners.map(|face| {
        face.map(|corner| Coord {
            x: corner[(z + 1) % 3],
            y: corner[(z + 2) % 3],
        })
    });
    (0..2).all(|own| {
        (0..3).all(|at| {
            let (from, to) = (flat[own][at], flat[own][(at + 1) % 3]);
            let inner = orient2d(from, to, flat[own][(at + 2) % 3]);
            let beyond = |corner| orient2d(from, to, corner) * inner.signum() <= 0.0;
            !flat[1 - own].into_iter().all(beyond)
        })
    })
}
