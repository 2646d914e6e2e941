//! Faces over vertices, and numbers that are sorted by what they have in common.

use glam::DVec3;

/// Vertices and the faces over them.
#[derive(Debug, Clone, Default, PartialEq)]
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

/// A normal of a face, as long as twice its area.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
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
