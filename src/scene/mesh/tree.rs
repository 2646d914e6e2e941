//! The hierarchy of boxes over the faces of a mesh: a flat list, depth first, that is walked without a stack.

use glam::{DVec3, Vec3};

/// The most faces of a leaf.
pub const LEAF: usize = 6;
/// The fewest faces of either side of a division, and so of a leaf of all but the smallest meshes.
const LEAST: usize = 3;
/// Places along each axis at which a division may be.
const BINS: usize = 16;
/// Divisions above a node from which on it is divided in the middle, so that no mesh makes a deep tree.
const DEEP: usize = 40;

/// A box of the hierarchy and what is in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The least coordinates of its faces.
    pub low: DVec3,
    /// Their greatest coordinates.
    pub high: DVec3,
    /// The node behind all that are below this one.
    pub skip: u32,
    /// The first face of a leaf.
    pub first: u32,
    /// The number of faces of a leaf; 0 for a node that has two others below it, of which the first stands right behind it.
    pub count: u32,
}

/// The hierarchy over the faces of a mesh, whose order is that of the leaves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshTree {
    nodes: Vec<Node>,
}

/// A face while the tree is built: its box, relative to the mesh's.
#[derive(Clone, Copy)]
struct Item {
    low: Vec3,
    high: Vec3,
    face: u32,
}

impl Item {
    /// Twice its middle.
    fn middle(&self) -> Vec3 {
        self.low + self.high
    }
}

/// A box that holds others.
#[derive(Clone, Copy)]
struct Hull(Vec3, Vec3);

impl Hull {
    const EMPTY: Self = Self(Vec3::INFINITY, Vec3::NEG_INFINITY);

    fn with(self, low: Vec3, high: Vec3) -> Self {
        Self(self.0.min(low), self.1.max(high))
    }

    /// Half of its surface.
    fn area(self) -> f32 {
        let size = self.1 - self.0;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

impl MeshTree {
    /// Builds the hierarchy over faces, and says in which order it has them.
    pub(super) fn build(vertices: &[DVec3], faces: &[[u32; 3]]) -> (Self, Vec<u32>) {
        let corners = |face: u32| faces[face as usize].map(|vertex| vertices[vertex as usize]);
        let used = || (0..faces.len() as u32).flat_map(corners);
        let low = used().fold(DVec3::INFINITY, DVec3::min);
        let high = used().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = low + 0.5 * (high - low);
        // Sizes of single precision, whatever those of the mesh are.
        let scale = (0.5 * (high - low).max_element()).max(f64::MIN_POSITIVE);
        let item = |face: u32| {
            let [a, b, c] = corners(face).map(|corner| ((corner - centre) / scale).as_vec3());
            Item {
                low: a.min(b).min(c),
                high: a.max(b).max(c),
                face,
            }
        };
        let mut items: Vec<Item> = (0..faces.len() as u32).map(item).collect();
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * faces.len() / LEAST + 1),
        };
        if !items.is_empty() {
            tree.divide(&mut items, 0, 0);
        }
        let order: Vec<u32> = items.iter().map(|item| item.face).collect();
        tree.fit(|at| corners(order[at as usize]));
        (tree, order)
    }

    /// Adds the nodes of faces, of which the first has a number, so many divisions below the first node.
    fn divide(&mut self, items: &mut [Item], first: u32, depth: usize) {
        let at = self.nodes.len();
        let is_leaf = items.len() <= LEAF;
        self.nodes.push(Node {
            low: DVec3::ZERO,
            high: DVec3::ZERO,
            skip: 0,
            first: if is_leaf { first } else { 0 },
            count: if is_leaf { items.len() as u32 } else { 0 },
        });
        if !is_leaf {
            let split = division(items, depth);
            let (left, right) = items.split_at_mut(split);
            self.divide(left, first, depth + 1);
            self.divide(right, first + split as u32, depth + 1);
        }
        self.nodes[at].skip = self.nodes.len() as u32;
    }

    /// Gives all nodes the boxes of their faces.
    fn fit(&mut self, corners: impl Fn(u32) -> [DVec3; 3]) {
        for at in (0..self.nodes.len()).rev() {
            let node = self.nodes[at];
            let (low, high) = match node.count {
                0 => {
                    let left = self.nodes[at + 1];
                    let right = self.nodes[left.skip as usize];
                    (left.low.min(right.low), left.high.max(right.high))
                }
                count => {
                    let all = || (node.first..node.first + count).flat_map(&corners);
                    (
                        all().fold(DVec3::INFINITY, DVec3::min),
                        all().fold(DVec3::NEG_INFINITY, DVec3::max),
                    )
                }
            };
            self.nodes[at].low = low;
            self.nodes[at].high = high;
        }
    }

    /// All nodes, depth first.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Calls `visit` for each face of the leaves that `enters` and all nodes above do. It ends early where `visit` returns true,
    /// and says whether it did.
    #[inline]
    pub fn walk(&self, enters: impl FnMut(&Node) -> bool, visit: impl FnMut(u32) -> bool) -> bool {
        self.walk_from(0, enters, visit)
    }

    /// The part of [`walk`](Self::walk) that begins at a node, whatever is above it.
    #[inline]
    pub(super) fn walk_from(
        &self,
        mut at: usize,
        mut enters: impl FnMut(&Node) -> bool,
        mut visit: impl FnMut(u32) -> bool,
    ) -> bool {
        while let Some(node) = self.nodes.get(at) {
            if !enters(node) {
                at = node.skip as usize;
                continue;
            }
            if (node.first..node.first + node.count).any(&mut visit) {
                return true;
            }
            at += 1;
        }
        false
    }
}

/// Orders faces such that those before a number are one side of a division and the others the other, and returns the number.
fn division(items: &mut [Item], depth: usize) -> usize {
    let hull = items.iter().fold(Hull::EMPTY, |hull, item| {
        hull.with(item.middle(), item.middle())
    });
    let size = hull.1 - hull.0;
    let best = (depth < DEEP).then(|| cheapest(items, hull)).flatten();
    if let Some((axis, last)) = best {
        let place = places(hull, axis);
        return partition(items, |item| place(item.middle()[axis]) <= last);
    }
    let axis = size.max_position();
    let half = items.len() / 2;
    let middle = |item: &Item| item.middle()[axis];
    items.select_nth_unstable_by(half, |a, b| {
        middle(a).total_cmp(&middle(b)).then(a.face.cmp(&b.face))
    });
    half
}

/// In which of the places along an axis a middle lies.
fn places(hull: Hull, axis: usize) -> impl Fn(f32) -> usize {
    let size = hull.1[axis] - hull.0[axis];
    let (low, scale) = (hull.0[axis], BINS as f32 / size);
    move |middle| (((middle - low) * scale) as usize).min(BINS - 1)
}

/// The division of least cost by the surface area heuristic: an axis, and the last place that is on its first side.
fn cheapest(items: &[Item], hull: Hull) -> Option<(usize, usize)> {
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        let size = hull.1[axis] - hull.0[axis];
        if size.is_nan() || size <= f32::MIN_POSITIVE {
            continue;
        }
        let place = places(hull, axis);
        let mut bins = [(Hull::EMPTY, 0_usize); BINS];
        for item in items {
            let bin = &mut bins[place(item.middle()[axis])];
            *bin = (bin.0.with(item.low, item.high), bin.1 + 1);
        }
        let join = |a: (Hull, usize), b: &(Hull, usize)| (a.0.with(b.0.0, b.0.1), a.1 + b.1);
        let mut behind = [(Hull::EMPTY, 0); BINS];
        let mut all = (Hull::EMPTY, 0);
        for at in (1..BINS).rev() {
            all = join(all, &bins[at]);
            behind[at] = all;
        }
        let mut before = (Hull::EMPTY, 0);
        for last in 0..BINS - 1 {
            before = join(before, &bins[last]);
            let after = behind[last + 1];
            if before.1.min(after.1) < LEAST {
                continue;
            }
            let cost = before.0.area() * before.1 as f32 + after.0.area() * after.1 as f32;
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, last));
            }
        }
    }
    best.map(|(_, axis, last)| (axis, last))
}

/// Moves the items that are of the first side to the front, and counts them.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let mut count = 0;
    for at in 0..items.len() {
        if is_first(&items[at]) {
            items.swap(at, count);
            count += 1;
        }
    }
    count
}
