//! The lines by which people recognise a shape: its edges, and where its curved sides turn away from the eye.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DQuat, DVec3};

use super::{Inside, Plane};
use crate::camera::{Camera, Projection};

/// Stretches of a circle: they leave it by less than 1/1800 of its radius.
const STRETCHES: usize = 96;

/// A line between two points of a surface.
type Stretch = [DVec3; 2];

/// Draws lines as a camera sees them.
pub(super) struct Pen<'a> {
    pub(super) lines: Vec<Stretch>,
    sight: Sight<'a>,
    /// The middle of what is drawn of a plane is the point nearest to it.
    near: DVec3,
    /// Half the size of what is drawn of a plane.
    reach: f64,
}

impl<'a> Pen<'a> {
    pub(super) fn new(camera: &'a Camera, near: DVec3, reach: f64) -> Self {
        Self {
            lines: Vec::new(),
            sight: Sight(camera),
            near,
            reach,
        }
    }

    /// A square on a plane, and a small cross in its middle, where the plane is turned about.
    pub(super) fn plane(&mut self, plane: &Plane) {
        self.square(plane);
        let [right, up] = <[DVec3; 2]>::from(plane.normal().any_orthonormal_pair());
        let (middle, arm) = (self.middle(plane), 0.05 * self.reach);
        let line = |along| [middle - arm * along, middle + arm * along];
        self.lines.extend([right, up].map(line));
    }

    /// Squares on a plane and on the one that is so far along its normal.
    pub(super) fn slab(&mut self, plane: &Plane, thickness: f64) {
        self.square(plane);
        for at in 0..self.lines.len() {
            let line = self.lines[at].map(|p| p + thickness * plane.normal());
            self.lines.push(line);
        }
    }

    /// The twelve edges of a box.
    pub(super) fn cuboid(&mut self, centre: DVec3, half: DVec3, rotation: DQuat) {
        let corner = |bits: usize| {
            let side = |axis: usize| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
            centre + rotation * (half * DVec3::new(side(0), side(1), side(2)))
        };
        for axis in 0..3 {
            let lows = (0..8).filter(|bits| bits >> axis & 1 == 0);
            let edges = lows.map(|bits| [corner(bits), corner(bits | 1 << axis)]);
            self.lines.extend(edges);
        }
    }

    /// Three great ellipses of an ellipsoid, and its contour.
    pub(super) fn ellipsoid(&mut self, centre: DVec3, radii: DVec3, rotation: DQuat) {
        let axes = DMat3::from_quat(rotation) * DMat3::from_diagonal(radii);
        for axis in 0..3 {
            self.circle([centre, axes.col((axis + 1) % 3), axes.col((axis + 2) % 3)]);
        }
        // The contour of the unit ball is a circle across the line to the eye, at one over the eye's distance.
        let eye = axes.inverse() * self.sight.from(centre);
        let squared = eye.length_squared();
        let (ahead, radius) = match self.sight.is_parallel() {
            true => (0.0, 1.0),
            false => (1.0 / squared, (1.0 - 1.0 / squared).sqrt()),
        };
        // An eye within sees no contour: its radius is no number.
        if let Some(towards) = eye.try_normalize().filter(|_| radius > 0.0) {
            let (right, up) = towards.any_orthonormal_pair();
            let middle = centre + axes * (ahead * eye);
            self.circle([middle, axes * (radius * right), axes * (radius * up)]);
        }
    }

    /// The edges of a mesh that are seen.
    pub(super) fn mesh(&mut self, inside: &Inside) {
        let there = inside.placement();
        let back = there.rotation().inverse();
        let to_eye = |place: DVec3| back * self.sight.from(there.to_world(place));
        let lines = inside.mesh().outline(to_eye);
        self.lines.extend(
            lines
                .into_iter()
                .map(|ends| ends.map(|end| there.to_world(end))),
        );
    }

    /// The side of a tube, and a half ball at each end.
    pub(super) fn capsule(&mut self, tube: &Tube) {
        let [from, to] = tube.ends;
        self.side(tube);
        self.cap(tube);
        self.cap(&Tube::new(to, from, tube.radius));
    }

    /// The circle at the first end of a tube, and lines from there to the other end, which is the tip of a cone.
    pub(super) fn cone(&mut self, tube: &Tube) {
        let [base, apex] = tube.ends;
        self.around(tube, base);
        let slope = tube.radius / tube.length;
        let to_eye = self.sight.from(apex);
        // A cone's axis leads away from its apex, where the tube's leads to it.
        let sides = tube.angles(to_eye, -slope * to_eye.dot(tube.axis));
        let sides = sides.map(|angle| [apex, base + tube.radial(angle)]);
        self.lines.extend(sides);
    }

    /// The circle around a centre that goes through `centre + right` and `centre + up`, from its start to an angle.
    fn arc(&mut self, [centre, right, up]: [DVec3; 3], angle: f64, stretches: usize) {
        let point = |step: usize| {
            let angle = angle * step as f64 / stretches as f64;
            centre + right * angle.cos() + up * angle.sin()
        };
        let arc = (0..stretches).map(|step| [point(step), point(step + 1)]);
        self.lines.extend(arc);
    }

    fn circle(&mut self, around: [DVec3; 3]) {
        self.arc(around, TAU, STRETCHES);
    }

    fn middle(&self, plane: &Plane) -> DVec3 {
        self.near - plane.normal() * plane.distance(self.near)
    }

    /// The sides of a square on a plane.
    fn square(&mut self, plane: &Plane) {
        let [right, up] = <[DVec3; 2]>::from(plane.normal().any_orthonormal_pair());
        let (middle, reach) = (self.middle(plane), self.reach);
        let corner = |[x, y]: [f64; 2]| middle + reach * (x * right + y * up);
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner);
        let sides = (0..4).map(|at| [corners[at], corners[(at + 1) % 4]]);
        self.lines.extend(sides);
    }

    /// The circle around a tube's axis at a point of it.
    fn around(&mut self, tube: &Tube, at: DVec3) {
        let [right, up] = tube.across.map(|direction| tube.radius * direction);
        self.circle([at, right, up]);
    }

    /// The circles at both ends, and lines of the side.
    pub(super) fn side(&mut self, tube: &Tube) {
        for at in tube.ends {
            self.around(tube, at);
        }
        let product = match self.sight.is_parallel() {
            true => 0.0,
            false => tube.radius,
        };
        let angles = tube.angles(self.sight.from(tube.ends[0]), product);
        let lines = angles.map(|angle| tube.ends.map(|end| end + tube.radial(angle)));
        self.lines.extend(lines);
    }

    /// The half ball at the tube's first end: two half circles over its pole, and what of the ball's contour is on this half.
    fn cap(&mut self, tube: &Tube) {
        let centre = tube.ends[0];
        let pole = -tube.radius * tube.axis;
        for across in tube.across {
            self.arc(
                [centre, tube.radius * across, pole],
                TAU / 2.0,
                STRETCHES / 2,
            );
        }
        let begin = self.lines.len();
        self.ellipsoid(centre, DVec3::splat(tube.radius), DQuat::IDENTITY);
        let is_outer = |line: &Stretch| line.iter().all(|p| (p - centre).dot(tube.axis) <= 0.0);
        let ball = self.lines.split_off(begin).into_iter().skip(3 * STRETCHES);
        self.lines.extend(ball.filter(is_outer));
    }
}

/// A camera as something that is seen from.
#[derive(Clone, Copy)]
struct Sight<'a>(&'a Camera);

impl Sight<'_> {
    fn is_parallel(self) -> bool {
        self.0.projection == Projection::Orthographic
    }

    /// The direction from a point to the eye, as long as that is far in perspective.
    fn from(self, point: DVec3) -> DVec3 {
        match self.is_parallel() {
            true => -self.0.rotation.row(2),
            false => self.0.eye - point,
        }
    }
}

/// A stretch of a line, and a distance around it.
pub(super) struct Tube {
    ends: [DVec3; 2],
    /// From the first end to the other, of length one.
    axis: DVec3,
    /// Two directions across the axis.
    across: [DVec3; 2],
    length: f64,
    radius: f64,
}

impl Tube {
    pub(super) fn new(from: DVec3, to: DVec3, radius: f64) -> Self {
        // A shape that was accepted has an axis.
        let axis = (to - from).try_normalize().unwrap_or(DVec3::Z);
        Self {
            ends: [from, to],
            axis,
            across: axis.any_orthonormal_pair().into(),
            length: from.distance(to),
            radius,
        }
    }

    /// From the axis to the side, at an angle around it.
    fn radial(&self, angle: f64) -> DVec3 {
        let [right, up] = self.across;
        self.radius * (angle.cos() * right + angle.sin() * up)
    }

    /// The angles around the axis whose direction has this product with the one to the eye: there the side turns away. Four
    /// angles where there are none.
    fn angles(&self, to_eye: DVec3, product: f64) -> impl Iterator<Item = f64> + use<> {
        let [x, y] = self.across.map(|direction| to_eye.dot(direction));
        let (towards, aside) = (y.atan2(x), (product / x.hypot(y)).acos());
        let angles = match aside.is_nan() {
            true => [0.0, 1.0, 2.0, 3.0]
                .map(|quarter| quarter * FRAC_PI_2)
                .to_vec(),
            false => vec![towards - aside, towards + aside],
        };
        angles.into_iter()
    }
}

#[cfg(test)]
mod tests;
