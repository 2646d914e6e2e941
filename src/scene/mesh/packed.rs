//! A mesh as shaders have it: single precision, in quads of four words, with a twin of what shaders do with it.
//!
//! - Quad 0: the number of nodes n, that of faces, the first quad of faces (1 + 2 n), and 1 where these may cut each other, else 0.
//! - Quad 1 + 2 i, of node i: x, y and z of the low corner of its box, and the node behind all that are below it, its *skip*.
//! - Quad 2 + 2 i, of node i: x, y and z of the high corner of its box, and for a leaf its first face times 8 plus the number of
//!   its faces, 1 to 6; for other nodes 0.
//! - From quad 1 + 2 n on: the faces in the order of the leaves, nine words each without gaps: x, y and z of three corners, which
//!   turn to the left as seen from the front.
//!
//! Numbers with a point are bits of floats. They are relative: (place - [`Mesh::centre`]) / [`Mesh::scale`], from -1 to 1. Boxes
//! are rounded outward, so that they hold both the corners here and the exact ones. A walk begins at node 0; where it enters node
//! i it looks at its faces and goes on at i + 1, and where it does not it goes on at the node's skip; it ends at n. A closed mesh
//! takes at most 58 bytes a face and 16 beside.

use glam::Vec3;

use super::{Mesh, MeshRule};

/// Bits of a leaf's number of faces.
const COUNT_BITS: u32 = 3;
/// What rounding moves a crossing by across the line at most, of the distance of the box that it is in.
const ROUNDING: f32 = 32.0 * f32::EPSILON;

/// A mesh in the words that shaders read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedMesh {
    /// The words, as the module describes them.
    pub quads: Vec<[u32; 4]>,
}

/// A node of a packed mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackedNode {
    /// The low corner of its box.
    pub low: Vec3,
    /// The high corner of its box.
    pub high: Vec3,
    /// The node behind all that are below it.
    pub skip: u32,
    /// The first face of a leaf.
    pub first: u32,
    /// The number of faces of a leaf; 0 for other nodes.
    pub count: u32,
}

impl Mesh {
    /// The mesh as shaders read it, which is made once for all copies.
    pub fn packed(&self) -> &PackedMesh {
        self.0.packed.get_or_init(|| self.pack())
    }

    fn pack(&self) -> PackedMesh {
        let nodes = self.tree().nodes();
        let (count, faces) = (nodes.len(), self.faces().len());
        let first = 1 + 2 * count;
        let mut quads = vec![[0; 4]; first + (9 * faces).div_ceil(4)];
        let may_overlap = self.rule() == MeshRule::Winding;
        quads[0] = [count as u32, faces as u32, first as u32, may_overlap.into()];
        for (node, quads) in nodes.iter().zip(quads[1..].chunks_exact_mut(2)) {
            let low = self.to_unit(node.low).to_array().map(rounded_down);
            let high = self
                .to_unit(node.high)
                .to_array()
                .map(|at| -rounded_down(-at));
            let [low, high] = [low, high].map(|corner| corner.map(f32::to_bits));
            let leaf = match node.count {
                0 => 0,
                faces => (node.first << COUNT_BITS) | faces,
            };
            quads[0] = [low[0], low[1], low[2], node.skip];
            quads[1] = [high[0], high[1], high[2], leaf];
        }
        let words = quads[first..].as_flattened_mut();
        for (face, words) in (0..faces as u32).zip(words.chunks_exact_mut(9)) {
            let corners = self
                .corners(face)
                .map(|corner| self.to_unit(corner).as_vec3());
            for (word, number) in words
                .iter_mut()
                .zip(corners.iter().flat_map(Vec3::to_array))
            {
                *word = number.to_bits();
            }
        }
        PackedMesh { quads }
    }
}

/// The largest single-precision number that is not larger.
fn rounded_down(number: f64) -> f32 {
    let nearest = number as f32;
    match f64::from(nearest) > number {
        true => nearest.next_down(),
        false => nearest,
    }
}

impl PackedMesh {
    /// The number of its faces.
    pub fn faces(&self) -> u32 {
        self.quads[0][1]
    }

    /// A node; none behind the last one.
    pub fn node(&self, at: u32) -> Option<PackedNode> {
        if at >= self.quads[0][0] {
            return None;
        }
        let [low, high] = [1, 2].map(|quad| self.quads[quad + 2 * at as usize]);
        let corner = |quad: [u32; 4]| Vec3::from([quad[0], quad[1], quad[2]].map(f32::from_bits));
        Some(PackedNode {
            low: corner(low),
            high: corner(high),
            skip: low[3],
            first: high[3] >> COUNT_BITS,
            count: high[3] & ((1 << COUNT_BITS) - 1),
        })
    }

    /// The corners of a face.
    pub fn corners(&self, face: u32) -> [Vec3; 3] {
        let words = self.quads[self.quads[0][2] as usize..].as_flattened();
        let first = 9 * face as usize;
        [0, 3, 6].map(|corner| {
            let at = first + corner;
            Vec3::from([words[at], words[at + 1], words[at + 2]].map(f32::from_bits))
        })
    }

    /// Calls `visit` for each face of the leaves that `enters` and all nodes above do. It ends early where `visit` returns true.
    pub fn walk(
        &self,
        mut enters: impl FnMut(&PackedNode) -> bool,
        mut visit: impl FnMut(u32) -> bool,
    ) -> bool {
        let mut at = 0;
        while let Some(node) = self.node(at) {
            if !enters(&node) {
                at = node.skip;
                continue;
            }
            if (node.first..node.first + node.count).any(&mut visit) {
                return true;
            }
            at += 1;
        }
        false
    }

    /// Adds all crossings of the line {origin + t direction}, in no order: each as its t, and by how much the winding number
    /// changes there. They add up to 0 exactly. The origin should be near the mesh, since its distance rounds all places.
    pub fn crossings(&self, origin: Vec3, direction: Vec3, found: &mut Vec<(f32, f32)>) {
        let z = direction.abs().max_position();
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let speed = direction[z];
        if speed == 0.0 {
            return;
        }
        let slopes = [direction[axes[0]] / speed, direction[axes[1]] / speed];
        let relative = |point: Vec3| axes.map(|axis| point[axis] - origin[axis]);
        let enters = |node: &PackedNode| {
            let (low, high) = (relative(node.low), relative(node.high));
            let interval = |axis: usize| {
                let ends = [low[2], high[2]].map(|z| slopes[axis] * z);
                [
                    low[axis] - ends[0].max(ends[1]),
                    high[axis] - ends[0].min(ends[1]),
                ]
            };
            let ([left, right], [bottom, top]) = (interval(0), interval(1));
            if left >= 0.0 || right < 0.0 || bottom > 0.0 || top < 0.0 {
                return false;
            }
            let [x, y] = slopes;
            let (a, b) = ([x * low[1], x * high[1]], [y * low[0], y * high[0]]);
            let far = (0..3).fold(0.0_f32, |far, axis| {
                far.max(low[axis].abs()).max(high[axis].abs())
            });
            a[0].min(a[1]) - b[0].max(b[1]) <= ROUNDING * far
                && a[0].max(a[1]) - b[0].min(b[1]) >= -ROUNDING * far
        };
        self.walk(enters, |face| {
            let across = |point: Vec3| {
                let [x, y, z] = relative(point);
                [x - slopes[0] * z, y - slopes[1] * z, z]
            };
            let crossing = crossing(self.corners(face).map(across));
            found.extend(crossing.map(|(z, turns)| (z / speed, -turns * speed.signum())));
            false
        });
    }

    /// How often the mesh winds around a point.
    pub fn winding(&self, point: Vec3) -> i32 {
        let mut found = Vec::new();
        self.crossings(point, Vec3::Z, &mut found);
        let ahead = found.iter().filter(|crossing| crossing.0 > 0.0);
        -ahead.map(|crossing| crossing.1).sum::<f32>() as i32
    }
}

/// Where the line along z through the origin crosses a face, and how often the face turns around it: 1 where its front looks
/// along z.
fn crossing(corners: [[f32; 3]; 3]) -> Option<(f32, f32)> {
    let is_left = corners.map(|corner| corner[0] < 0.0);
    let mut turns = 0.0;
    let mut passes = [[0.0; 2]; 2];
    for at in 0..3 {
        let (from, to) = (at, (at + 1) % 3);
        if is_left[from] == is_left[to] {
            continue;
        }
        let (left, right, turn) = match is_left[from] {
            true => (corners[from], corners[to], -1.0),
            false => (corners[to], corners[from], 1.0),
        };
        let share = left[0] / (left[0] - right[0]);
        let mix = |axis: usize| {
            let (a, b) = (left[axis], right[axis]);
            (a + (b - a) * share).max(a.min(b)).min(a.max(b))
        };
        let is_above = mix(1) >= 0.0;
        passes[usize::from(!is_above)] = [mix(1), mix(2)];
        if is_above {
            turns += turn;
        }
    }
    let [[top, upper], [bottom, lower]] = passes;
    let share = bottom / (bottom - top);
    let z = lower + (upper - lower) * share;
    (turns != 0.0).then(|| (z.max(lower.min(upper)).min(lower.max(upper)), turns))
}
