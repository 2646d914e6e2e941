//! How far points are from a mesh, and which faces come near an ellipsoid.

use glam::{DMat3, DVec3};

use super::Mesh;
use super::faces::normal;
use super::tree::Node;

/// The point of a mesh that is nearest to another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Where it is.
    pub point: DVec3,
    /// The face that it is on, one of several that share it.
    pub face: u32,
    /// How far it is, squared.
    pub distance_squared: f64,
}

/// The point of a face that is nearest to the origin. It is on the face, however its numbers are rounded, so that no distance is
/// too small.
pub(super) fn nearest_to_origin([a, b, c]: [DVec3; 3]) -> DVec3 {
    let on_edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let share = (-from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        // An edge without a length has no share.
        if share.is_nan() {
            from
        } else {
            from + along * share
        }
    };
    let mut nearest = on_edge(a, b);
    for other in [on_edge(b, c), on_edge(c, a)] {
        if other.length_squared() < nearest.length_squared() {
            nearest = other;
        }
    }
    let up = normal([a, b, c]);
    let shares = [b.cross(c).dot(up), c.cross(a).dot(up), a.cross(b).dot(up)];
    let sum = shares.iter().sum::<f64>();
    if sum > 0.0 && shares.iter().all(|share| *share >= 0.0) {
        let inner = (a * shares[0] + b * shares[1] + c * shares[2]) / sum;
        if inner.length_squared() < nearest.length_squared() {
            nearest = inner;
        }
    }
    nearest
}

/// The square of how far a point is from a box.
fn box_distance_squared(node: &Node, point: DVec3) -> f64 {
    let beyond = (node.low - point).max(point - node.high).max(DVec3::ZERO);
    beyond.length_squared()
}

impl Mesh {
    /// The nearest point of the mesh; none of a mesh without faces.
    pub fn nearest(&self, point: DVec3) -> Option<Nearest> {
        let nodes = self.tree().nodes();
        let mut best: Option<Nearest> = None;
        let mut open = vec![(0.0, 0_usize)];
        if nodes.is_empty() {
            open.clear();
        }
        while let Some((least, at)) = open.pop() {
            if best.is_some_and(|best| least > best.distance_squared) {
                continue;
            }
            let node = &nodes[at];
            if node.count == 0 {
                let second = nodes[at + 1].skip as usize;
                let mut both =
                    [at + 1, second].map(|at| (box_distance_squared(&nodes[at], point), at));
                if both[0].0 < both[1].0 {
                    both.swap(0, 1);
                }
                open.extend(both); // the nearer one is looked at first
                continue;
            }
            for face in node.first..node.first + node.count {
                let from = nearest_to_origin(self.corners(face).map(|corner| corner - point));
                let distance_squared = from.length_squared();
                if best.is_none_or(|best| distance_squared < best.distance_squared) {
                    best = Some(Nearest {
                        point: point + from,
                        face,
                        distance_squared,
                    });
                }
            }
        }
        best
    }

    /// How far a point is inside of the mesh; negative outside.
    pub fn signed_distance(&self, point: DVec3) -> f64 {
        let distance = self
            .nearest(point)
            .map_or(f64::INFINITY, |nearest| nearest.distance_squared.sqrt());
        if self.keeps(point) {
            distance
        } else {
            -distance
        }
    }

    /// The unit vector along which [`signed_distance`](Self::signed_distance) grows fastest; at a face the normal that points
    /// into the mesh, and zero for a mesh without faces.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        let Some(nearest) = self.nearest(point) else {
            return DVec3::ZERO;
        };
        let away = point - nearest.point;
        let corners = self.corners(nearest.face);
        let size = corners
            .iter()
            .fold(point.abs().max_element(), |size, corner| {
                size.max(corner.abs().max_element())
            });
        // Nearer than this its direction is one of rounding.
        if away.length() <= 16.0 * f64::EPSILON * size {
            return -normal(corners).normalize_or_zero();
        }
        let away = away.normalize_or_zero();
        if self.keeps(point) { away } else { -away }
    }

    /// True where a face comes into the ellipsoid {centre + axes u: |u| <= deviations}, or touches it. An ellipsoid that is flat,
    /// or a line or a point, counts as a billionth as thick as it is long.
    pub fn touches_ball(&self, centre: DVec3, axes: DMat3, deviations: f64) -> bool {
        self.visit_ball(centre, axes, deviations, |_| true)
    }

    /// Adds the faces that come into the ellipsoid of [`touches_ball`](Self::touches_ball), in ascending order.
    pub fn faces_in_ball(&self, centre: DVec3, axes: DMat3, deviations: f64, found: &mut Vec<u32>) {
        self.visit_ball(centre, axes, deviations, |face| {
            found.push(face);
            false
        });
    }

    fn visit_ball(
        &self,
        centre: DVec3,
        axes: DMat3,
        deviations: f64,
        mut visit: impl FnMut(u32) -> bool,
    ) -> bool {
        let axes = thick(axes);
        let inverse = axes.inverse();
        let rows = [axes.row(0), axes.row(1), axes.row(2)];
        let reach = deviations * DVec3::from(rows.map(|row| row.length()));
        let (low, high) = (centre - reach, centre + reach);
        let sizes = DMat3::from_cols(
            inverse.x_axis.abs(),
            inverse.y_axis.abs(),
            inverse.z_axis.abs(),
        );
        let enters = |node: &Node| {
            if (node.low.cmpgt(high) | node.high.cmplt(low)).any() {
                return false;
            }
            // The same seen from the ellipsoid: how near the box comes along its axes.
            let half = 0.5 * (node.high - node.low);
            let from = inverse * (node.low + half - centre);
            let reach = deviations * (1.0 + 1e-9) + 1e-12;
            let beyond = (from.abs() - sizes * half * (1.0 + 1e-9)).max(DVec3::ZERO);
            beyond.length_squared() <= reach * reach
        };
        let touches = |face: u32| {
            let corners = self.corners(face).map(|corner| inverse * (corner - centre));
            nearest_to_origin(corners).length() <= deviations
        };
        self.tree()
            .walk(enters, |face| touches(face) && visit(face))
    }
}

/// The axes of an ellipsoid that has some thickness.
fn thick(axes: DMat3) -> DMat3 {
    const LEAST: f64 = 1e-9;
    let mut columns = [axes.x_axis, axes.y_axis, axes.z_axis];
    // The longest first, and each with what the longer ones do not have of it.
    columns.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    let least = (LEAST * columns[0].length()).max(1e-60);
    let x = columns[0].try_normalize().unwrap_or(DVec3::X);
    let rest = columns[1] - x * x.dot(columns[1]);
    let y = match rest.length() < least {
        true => x.any_orthonormal_vector(),
        false => rest.normalize(),
    };
    let z = x.cross(y);
    let along = z.dot(columns[2]);
    if columns[0].length() >= least && rest.length() >= least && along.abs() >= least {
        return axes;
    }
    columns[0] = x * columns[0].length().max(least);
    if rest.length() < least {
        columns[1] = x * x.dot(columns[1]) + y * least;
    }
    if along.abs() < least {
        columns[2] += z * (least - along);
    }
    DMat3::from_cols_array_2d(&columns.map(|column| column.to_array()))
}
