//! Faces that have the same corners.

use super::edges::Edges;
use super::faces::{Buckets, Faces};
use super::report::MeshReport;
use super::sets::Sets;

/// Drops all but one of the faces that have the same three vertices, and that one too where it is of a wall: one of two that look
/// in opposite directions, with which alone the surface has edges of an odd number of faces. So two shells that share a wall are
/// one.
pub(super) fn drop_duplicates(of: &mut Faces, report: &mut MeshReport) {
    let key = |mut face: [u32; 3]| {
        face.sort_unstable();
        let [least, middle, most] = face;
        (least, (u64::from(middle) << 32) | u64::from(most))
    };
    let buckets = Buckets::new(of.vertices.len(), of.faces.iter().map(|face| key(*face)));
    let mut is_dropped = Vec::new();
    // Those that stay of as many faces in one direction as in the other.
    let mut paired = Vec::new();
    for bucket in buckets.all() {
        for same in bucket
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|same| same.len() > 1)
        {
            is_dropped.resize(of.faces.len(), false);
            let directions = same
                .iter()
                .map(|(_, face)| direction(of.faces[*face as usize]));
            if directions.sum::<i32>() == 0 {
                paired.push(same[0].1);
            }
            for (_, face) in &same[1..] {
                is_dropped[*face as usize] = true;
                report.duplicate += 1;
            }
        }
    }
    if is_dropped.is_empty() {
        return;
    }
    for face in walls(of, &is_dropped, &paired) {
        is_dropped[face as usize] = true;
        report.duplicate += 1;
    }
    let mut number = 0;
    of.faces.retain(|_| {
        number += 1;
        !is_dropped[number - 1]
    });
}

/// 1 where the numbers of a face ascend as it turns, and -1 where they descend.
fn direction([a, b, c]: [u32; 3]) -> i32 {
    match [a < b, b < c, c < a]
        .iter()
        .filter(|ascends| **ascends)
        .count()
    {
        2 => 1,
        _ => -1,
    }
}

/// Those of the paired faces that are of walls: all that are connected with one at an edge of an odd number of faces.
fn walls(of: &Faces, is_dropped: &[bool], paired: &[u32]) -> Vec<u32> {
    if paired.is_empty() {
        return Vec::new();
    }
    let mut is_paired = vec![false; of.faces.len()];
    paired
        .iter()
        .for_each(|face| is_paired[*face as usize] = true);
    let mut sets = Sets::new(of.faces.len());
    let mut odd = Vec::new();
    for edge in Edges::new(of).all() {
        let kept = || {
            edge.halves()
                .map(|half| half / 3)
                .filter(|face| !is_dropped[*face as usize])
        };
        let mut pairs = kept().filter(|face| is_paired[*face as usize]);
        let Some(first) = pairs.next() else {
            continue;
        };
        pairs.for_each(|face| {
            sets.join(first, face, false);
        });
        if kept().count() % 2 == 1 {
            odd.push(first);
        }
    }
    let mut is_wall = vec![false; of.faces.len()];
    odd.into_iter()
        .for_each(|face| is_wall[sets.find(face).0 as usize] = true);
    let walls = paired.iter().copied();
    walls
        .filter(|face| is_wall[sets.find(*face).0 as usize])
        .collect()
}
