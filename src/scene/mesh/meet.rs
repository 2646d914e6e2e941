//! Faces of a mesh that cut each other, found exactly.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{BVec3, DVec3};
use robust::{Coord, orient2d};
use smallvec::SmallVec;

use super::faces::{Faces, normal, place};
use super::lines::below;
use super::tree::{LEAF, MeshTree};
use rara_base::counted::grouped;
use rara_base::parallel::in_parallel;

/// Nodes of the tree that one task looks at.
const TASK: usize = 1 << 12;
/// Pairs of faces that a task looks at before it gives up, in a second or two. Those of real meshes look at some 100 000.
pub(super) const MOST_PAIRS: u64 = 1 << 24;

/// What a task found.
#[derive(Default)]
struct Found {
    first: Option<[u32; 2]>,
    count: u64,
    /// True where it gave up.
    is_unfinished: bool,
}

/// Refuses faces that cut each other, or lie in each other. Those that touch in corners or edges that they share may.
pub(super) fn check(of: &Faces, tree: &MeshTree, most_pairs: u64) -> Result<(), String> {
    let nodes = tree.nodes().len();
    let starts = (0..nodes).step_by(TASK);
    let has_given_up = AtomicBool::new(false);
    let found = in_parallel(starts, |start| {
        let end = (start + TASK).min(nodes);
        look(of, tree, [start, end], most_pairs, &has_given_up)
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

/// Looks at the faces of the leaves among some nodes, with those behind them.
fn look(
    of: &Faces,
    tree: &MeshTree,
    [start, end]: [usize; 2],
    mut left: u64,
    has_given_up: &AtomicBool,
) -> Found {
    let mut found = Found::default();
    for at in start..end {
        let leaf = tree.nodes()[at];
        if leaf.count == 0 {
            continue;
        }
        if has_given_up.load(Ordering::Relaxed) {
            break;
        }
        let own = leaf.first..leaf.first + leaf.count;
        let hulls: SmallVec<[_; LEAF]> = own
            .clone()
            .map(|face| hull(of.corners(face as usize)))
            .collect();
        found.is_unfinished |= tree.walk_from(
            at,
            |node| overlap([node.low, node.high], [leaf.low, leaf.high]),
            |other| {
                let others = of.corners(other as usize);
                let hull = hull(others);
                for (face, own) in own.clone().zip(&hulls) {
                    if face >= other || !overlap(hull, *own) {
                        continue;
                    }
                    left = left.saturating_sub(1);
                    let vertices = [face, other].map(|face| of.faces[face as usize]);
                    if meet(vertices, [of.corners(face as usize), others]) {
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

/// On which side of the plane of a face the corners of another one are, exactly: how far, more or less, and 0 for those that are
/// in it, as the corners that both have are.
fn sides(own: [DVec3; 3], is_shared: [bool; 3], other: [DVec3; 3]) -> [f64; 3] {
    let edges = [other[1] - other[0], other[2] - other[0]];
    let up = edges[0].cross(edges[1]);
    let size = edges[0].abs().max_element() * edges[1].abs().max_element();
    [0, 1, 2].map(|at| {
        if is_shared[at] {
            return 0.0;
        }
        let from = other[0] - own[at];
        let height = up.dot(from);
        // Most are farther than rounding can make up.
        match height.abs() > 64.0 * f64::EPSILON * size * from.abs().max_element() {
            true => height,
            false => below(other, own[at]),
        }
    })
}

/// True where two faces have points in common beside corners and edges that they share. A corner that only touches the other face
/// is nothing that they cut.
fn meet(vertices: [[u32; 3]; 2], corners: [[DVec3; 3]; 2]) -> bool {
    let [is_shared, is_shared_of_other] =
        [0, 1].map(|own| vertices[own].map(|vertex| vertices[1 - own].contains(&vertex)));
    let shared = is_shared.iter().filter(|shared| **shared).count();
    // All that they do not share is on one side of the other's plane.
    let is_apart = |sides: [f64; 3]| {
        let count = |is: fn(&f64) -> bool| sides.iter().filter(|side| is(side)).count();
        let (above, below) = (count(|side| *side > 0.0), count(|side| *side < 0.0));
        above.max(below) == 3 - shared && above.min(below) == 0
    };
    let first = sides(corners[0], is_shared, corners[1]);
    if first == [0.0; 3] {
        return lie_in_each_other(corners);
    }
    if is_apart(first) {
        return false;
    }
    let second = sides(corners[1], is_shared_of_other, corners[0]);
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
        let around = |at_other: usize| {
            let edge = [other[at_other], other[(at_other + 1) % 3]];
            below([own[at], own[next], edge[0]], edge[1])
        };
        let (first, second) = (around(0), around(1));
        if first.min(second) < 0.0 && first.max(second) > 0.0 {
            return false;
        }
        let third = around(2);
        let [least, most] = [first.min(second).min(third), first.max(second).max(third)];
        least >= 0.0 || most <= 0.0
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
