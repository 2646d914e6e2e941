//! Which side of each face is its front: that of its shell is outside, and in the hollow of a cavity.

use super::edges::{Edge, Edges, NONE};
use super::faces::{Faces, normal, place};
use super::lines::{crossed_above, may_be_above};
use super::report::MeshReport;
use super::sets::Sets;
use super::tree::MeshTree;

/// The shell of each face, and whether the face was turned.
pub(super) struct Shells {
    pub(super) of: Vec<u32>,
    pub(super) is_turned: Vec<bool>,
    count: u32,
}

const REMEDY: &str = "mend it there, or have its inside decided by the winding number, which keeps the faces as they are";

impl Shells {
    /// Turns faces such that neighbours have their fronts on one side, and finds which of them are one shell.
    pub(super) fn connect(of: &mut Faces, edges: &Edges) -> Result<Self, String> {
        let mut shells = Self {
            of: vec![NONE; of.faces.len()],
            is_turned: vec![false; of.faces.len()],
            count: 0,
        };
        shells.spread(of, edges)?;
        shells.join(of, edges)?;
        Ok(shells)
    }

    /// Spreads from faces over the edges that have two.
    fn spread(&mut self, of: &mut Faces, edges: &Edges) -> Result<(), String> {
        let twins = edges.twins(of.faces.len());
        let from = |half: u32| of.faces[half as usize / 3][half as usize % 3];
        let mut open = Vec::new();
        for first in 0..of.faces.len() as u32 {
            if self.of[first as usize] != NONE {
                continue;
            }
            self.of[first as usize] = self.count;
            open.push(first);
            while let Some(face) = open.pop() {
                let own = self.is_turned[face as usize];
                for half in 3 * face..3 * face + 3 {
                    let twin = twins[half as usize];
                    if twin == NONE {
                        continue;
                    }
                    let other = (twin / 3) as usize;
                    // Neighbours go along their edge in opposite directions.
                    let turned = own ^ (from(half) == from(twin));
                    if self.of[other] == NONE {
                        self.of[other] = self.count;
                        self.is_turned[other] = turned;
                        open.push(other as u32);
                    } else if self.is_turned[other] != turned {
                        let end = of.faces[half as usize / 3][(half as usize + 1) % 3];
                        let [a, b] = [from(half), end].map(|at| place(of.vertices[at as usize]));
                        return Err(format!(
                            "the mesh has one side only, as a Moebius strip has: its faces cannot all be turned alike, for \
                             example at the edge from {a} to {b}; {REMEDY}"
                        ));
                    }
                }
            }
            self.count += 1;
        }
        for (face, _) in of.faces.iter_mut().zip(&self.is_turned).filter(|of| *of.1) {
            face.swap(1, 2);
        }
        Ok(())
    }

    /// Joins parts that are closed only together, where they share an edge of more than two faces.
    fn join(&mut self, of: &mut Faces, edges: &Edges) -> Result<(), String> {
        let mut sets = Sets::new(self.count as usize);
        let mut joins = false;
        for edge in edges.all().filter(|edge| edge.count() > 2) {
            let open: Vec<_> = self
                .parts(of, &edge)
                .into_iter()
                .filter(|part| part.1 != 0)
                .collect();
            match open[..] {
                [] => continue,
                [(a, balance), (b, other)] => {
                    // What cannot be is found below.
                    sets.join(a, b, (balance > 0) == (other > 0));
                }
                _ => {
                    for pair in open.windows(2) {
                        sets.join(pair[0].0, pair[1].0, false);
                    }
                }
            }
            joins = true;
        }
        if !joins {
            return Ok(());
        }
        for (face, part) in self.of.iter_mut().enumerate() {
            let (set, is_turned) = sets.find(*part);
            *part = set;
            if is_turned {
                of.faces[face].swap(1, 2);
                self.is_turned[face] ^= true;
            }
        }
        match edges.all().find(|edge| edge.balance(&of.faces) != 0) {
            None => Ok(()),
            Some(edge) => Err(format!(
                "the mesh has {} faces at the edge {}, which cannot be turned such that they bound an inside; {REMEDY}",
                edge.count(),
                edge.name(&of.vertices)
            )),
        }
    }

    /// The parts that have faces at an edge, each with how many more of its half-edges go forward than back.
    fn parts(&self, of: &Faces, edge: &Edge<'_>) -> Vec<(u32, i64)> {
        let of_half = |half| (self.of[half as usize / 3], edge.direction(&of.faces, half));
        let mut parts: Vec<(u32, i64)> = edge.halves().map(of_half).collect();
        parts.sort_unstable();
        parts.dedup_by(|next, part| {
            let is_same = next.0 == part.0;
            if is_same {
                part.1 += next.1;
            }
            is_same
        });
        parts
    }

    /// Turns whole shells: those that lie in an even number of others have their fronts outside, and the others, which are
    /// cavities, inside. The faces are in the order of the tree, and so is what is known of them.
    pub(super) fn face_outward(
        &mut self,
        of: &mut Faces,
        tree: &MeshTree,
        report: &mut MeshReport,
    ) {
        let mut is_inverted = vec![false; self.count as usize];
        let mut found = Vec::new();
        for (shell, face) in self.faces_that_look_up(of) {
            let corners = of.corners(face as usize);
            let point = corners[0] + ((corners[1] - corners[0]) + (corners[2] - corners[0])) / 3.0;
            found.clear();
            tree.walk(
                |node| may_be_above(node, point),
                |other| {
                    let crossed = crossed_above(of.corners(other as usize), point);
                    if crossed != 0 && other != face {
                        found.push((self.of[other as usize], crossed));
                    }
                    false
                },
            );
            found.sort_unstable();
            let (mut above, mut others) = (0, 0);
            for of_shell in found.chunk_by(|a, b| a.0 == b.0) {
                let winding: i32 = of_shell.iter().map(|crossed| crossed.1).sum();
                match of_shell[0].0 == shell {
                    true => above = winding,
                    false => others += u64::from(winding != 0),
                }
            }
            // The shell winds so often around what is above its face, and around what is below it. Around its inside it does once
            // where its fronts are outside, and once the other way round where they are not.
            let is_up = normal(corners).z > 0.0;
            let sum = 2 * above + if is_up { 1 } else { -1 };
            let is_cavity = others % 2 == 1;
            is_inverted[shell as usize] = (sum < 0) != is_cavity;
            report.shells += 1;
            report.cavities += u64::from(is_cavity);
        }
        for (face, shell) in self.of.iter().enumerate() {
            if is_inverted[*shell as usize] {
                of.faces[face].swap(1, 2);
                self.is_turned[face] ^= true;
            }
        }
        report.turned = self.is_turned.iter().filter(|turned| **turned).count() as u64;
    }

    /// The face of each shell that is largest as seen along z.
    fn faces_that_look_up(&self, of: &Faces) -> impl Iterator<Item = (u32, u32)> + use<> {
        let mut largest = vec![(0.0, NONE); self.count as usize];
        for (face, shell) in self.of.iter().enumerate() {
            let size = normal(of.corners(face)).z.abs();
            let largest = &mut largest[*shell as usize];
            if size > largest.0 || largest.1 == NONE {
                *largest = (size, face as u32);
            }
        }
        let known = largest.into_iter().enumerate();
        let known = known.map(|(shell, (_, face))| (shell as u32, face));
        known.filter(|(_, face)| *face != NONE)
    }

    /// Puts what is known of the faces in another order of them.
    pub(super) fn reorder(&mut self, order: &[u32]) {
        self.of = order.iter().map(|face| self.of[*face as usize]).collect();
        self.is_turned = order
            .iter()
            .map(|face| self.is_turned[*face as usize])
            .collect();
    }
}
