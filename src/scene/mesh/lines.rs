//! Where lines cross the faces of a mesh, and how often these wind around a point.
//!
//! Both look along a line at the mesh: each vertex has two coordinates across the line, x and y, and lies left of the line where
//! its x is below 0, and right of it otherwise. An edge from left to right passes above the line or below it, and *passes* is
//! said by a function of the edge's two ends in that order, which all its faces share. A face is crossed as often as its edges
//! pass above the line from right to left, less as often as they do from left to right: once, never, or -1 times. Each edge of a
//! closed mesh has as many faces that have it in one direction as in the other, so that the sum over all faces is zero *whatever
//! the function says*: no line slips through an edge or a vertex, and none crosses there twice, however its numbers are rounded.

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::{Mesh, tree::Node};

/// What rounding moves a crossing by across the line at most, of the distance of the box that it is in.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The exact sign of how far a point is left of a line across z.
fn side(from: DVec3, to: DVec3, point: DVec3) -> f64 {
    let [from, to, point] = [from, to, point].map(|at| Coord { x: at.x, y: at.y });
    orient2d(from, to, point)
}

/// The exact sign of how far a point is below the plane through three others, which turn to the left as seen from above it.
pub(super) fn below([a, b, c]: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c, point] = [a, b, c, point].map(|at| Coord3D {
        x: at.x,
        y: at.y,
        z: at.z,
    });
    orient3d(a, b, c, point)
}

/// How often a face is crossed by the line along z through a point that lies below it: 1 where its front looks up, and -1 where
/// it looks down. The point counts as a bit lower than it is, much less farther back in y, and again much less in x (simulation
/// of simplicity), so that it is on no face, edge or vertex.
pub(super) fn crossed_above(corners: [DVec3; 3], point: DVec3) -> i32 {
    let is_left = corners.map(|corner| corner.x < point.x);
    let mut turns = 0;
    for at in 0..3 {
        let (from, to) = (at, (at + 1) % 3);
        if is_left[from] == is_left[to] {
            continue;
        }
        let (left, right, turn) = match is_left[from] {
            true => (corners[from], corners[to], -1),
            false => (corners[to], corners[from], 1),
        };
        if side(left, right, point) <= 0.0 {
            turns += turn;
        }
    }
    match turns != 0 && f64::from(turns) * below(corners, point) >= 0.0 {
        true => turns,
        false => 0,
    }
}

/// True where [`crossed_above`] may be other than 0 for a face in the box.
pub(super) fn may_be_above(node: &Node, point: DVec3) -> bool {
    let (low, high) = (node.low, node.high);
    low.x < point.x
        && point.x <= high.x
        && low.y <= point.y
        && point.y <= high.y
        && point.z <= high.z
}

impl Mesh {
    /// How often the mesh winds around a point: 1 in the inside of a closed mesh, and 0 outside of it. It is exact; a point on a
    /// face has the number of one of its sides.
    pub fn winding(&self, point: DVec3) -> i32 {
        let mut winding = 0;
        self.tree().walk(
            |node| may_be_above(node, point),
            |face| {
                winding += crossed_above(self.corners(face), point);
                false
            },
        );
        winding
    }

    /// True for a point inside: one that the mesh winds around.
    pub fn keeps(&self, point: DVec3) -> bool {
        self.winding(point) != 0
    }

    /// Adds all crossings of the line {origin + t direction} with the mesh, in no order: each as its t, and by how much the
    /// winding number changes there, 1 where the line goes in and -1 where it comes out. The changes of a line add up to 0
    /// exactly. A direction that is zero or not finite crosses nothing.
    pub fn crossings(&self, origin: DVec3, direction: DVec3, found: &mut Vec<(f64, f64)>) {
        let Some(line) = Line::new(origin, direction) else {
            return;
        };
        self.tree().walk(
            |node| line.may_cross(node),
            |face| {
                found.extend(line.crossing(self.corners(face)));
                false
            },
        );
    }
}

/// A line, along which points have coordinates x and y across it and z along the axis that it is closest to.
pub(super) struct Line {
    origin: DVec3,
    /// The axes of x, y and z, in the order of a right-handed frame.
    axes: [usize; 3],
    /// How much x and y grow with z along the line.
    slopes: [f64; 2],
    /// How much z grows with t.
    speed: f64,
}

impl Line {
    pub(super) fn new(origin: DVec3, direction: DVec3) -> Option<Self> {
        let z = direction.abs().max_position();
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let speed = direction[z];
        let is_line = speed != 0.0 && direction.is_finite() && origin.is_finite();
        is_line.then(|| Self {
            origin,
            axes,
            slopes: [direction[axes[0]] / speed, direction[axes[1]] / speed],
            speed,
        })
    }

    fn across(&self, point: DVec3) -> [f64; 3] {
        let [x, y, z] = self.axes.map(|axis| point[axis] - self.origin[axis]);
        [x - self.slopes[0] * z, y - self.slopes[1] * z, z]
    }

    /// True where a face in the box may be crossed. Rounding keeps the order of numbers, so that the intervals of x and y have
    /// all that [`across`](Self::across) makes of points in the box, and nothing need be added to them.
    fn may_cross(&self, node: &Node) -> bool {
        let [low, high] = [node.low, node.high]
            .map(|corner| self.axes.map(|axis| corner[axis] - self.origin[axis]));
        let interval = |axis: usize| {
            let ends = [low[2], high[2]].map(|z| self.slopes[axis] * z);
            [
                low[axis] - ends[0].max(ends[1]),
                high[axis] - ends[0].min(ends[1]),
            ]
        };
        let ([left, right], [bottom, top]) = (interval(0), interval(1));
        if left >= 0.0 || right < 0.0 || bottom > 0.0 || top < 0.0 {
            return false;
        }
        // The box is narrower across its own edges along z than its interval in x and y is.
        let [x, y] = self.slopes;
        let (a, b) = ([x * low[1], x * high[1]], [y * low[0], y * high[0]]);
        let least = a[0].min(a[1]) - b[0].max(b[1]);
        let most = a[0].max(a[1]) - b[0].min(b[1]);
        let far = (0..3).fold(0.0_f64, |far, axis| {
            far.max(low[axis].abs()).max(high[axis].abs())
        });
        least <= ROUNDING * far && most >= -ROUNDING * far
    }

    /// Where the line crosses a face, and how the winding number changes there.
    pub(super) fn crossing(&self, corners: [DVec3; 3]) -> Option<(f64, f64)> {
        let corners = corners.map(|corner| self.across(corner));
        let is_left = corners.map(|corner| corner[0] < 0.0);
        if is_left == [is_left[0]; 3] {
            return None;
        }
        let mut turns = 0.0;
        // How far above the line the edges pass that cross its plane, the upper one first, and their z there.
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
            // Within the ends, as exact numbers would be.
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
        if turns == 0.0 {
            return None;
        }
        let [[top, upper], [bottom, lower]] = passes;
        let share = bottom / (bottom - top);
        let z = lower + (upper - lower) * share;
        let z = z.max(lower.min(upper)).min(lower.max(upper));
        Some((z / self.speed, -turns * self.speed.signum()))
    }
}
