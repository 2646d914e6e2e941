//! The lines by which people recognise a shape: its edges, and where its curved sides turn away from the eye.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DQuat, DVec3};

use super::Plane;
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
mod tests {
    use super::*;
    use crate::Random;
    use crate::clip::placed::tests::shapes;
    use crate::clip::{Shape, Solid};

    fn cameras(random: &mut Random) -> [Camera; 2] {
        let mut point = || DVec3::from_array([(); 3].map(|()| random.range(-6.0, 6.0)));
        let (eye, target) = (point(), point());
        [
            Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, (64, 64)).unwrap(),
            Camera::orthographic(eye, target, DVec3::NEG_Y, 3.0, (64, 64)).unwrap(),
        ]
    }

    /// True when a ball of this radius around a point has both points that are kept and points that are not.
    fn is_on_surface(shape: &Shape, point: DVec3, within: f64, random: &mut Random) -> bool {
        let clip = shape.clip();
        let mut found = [false; 2];
        for _ in 0..2_000 {
            let direction = DVec3::from_array([(); 3].map(|()| random.range(-1.0, 1.0)));
            found[usize::from(clip.keeps(point + within * direction))] = true;
            if found == [true; 2] {
                return true;
            }
        }
        false
    }

    #[test]
    fn the_ends_of_an_outline_lie_on_the_surface() {
        let mut random = Random::new(3);
        for _ in 0..12 {
            let cameras = cameras(&mut random);
            for shape in shapes(&mut random) {
                for camera in &cameras {
                    let lines = shape.outline(camera, DVec3::ONE, 2.0);
                    assert!(lines.len() >= 6, "{shape}: {} lines", lines.len());
                    for point in lines.iter().flatten() {
                        let on = is_on_surface(&shape, *point, 1e-9, &mut random);
                        assert!(on, "{shape}: {point}");
                    }
                }
            }
        }
    }

    #[test]
    fn contours_are_where_sides_turn_away_from_the_eye() {
        let mut random = Random::new(4);
        let camera = |eye: DVec3| {
            let towards = eye + DVec3::new(0.1, 0.2, 1.0);
            Camera::look_at(eye, towards, DVec3::NEG_Y, 50.0, (64, 64)).unwrap()
        };
        let flat = |eye: DVec3| camera(eye).projection(Projection::Orthographic);
        let eye = DVec3::new(0.3, -0.4, -5.0);
        for camera in [camera(eye), flat(eye)] {
            for shape in shapes(&mut random) {
                let surfaces = shape.clip().all_surfaces();
                let curved: Vec<_> = surfaces.iter().filter(|s| s.as_plane().is_none()).collect();
                if curved.is_empty() {
                    continue;
                }
                // The surface turns away where the line of sight is in its tangent plane.
                let grazes = |point: DVec3| {
                    let sight = Sight(&camera).from(point).normalize();
                    curved.iter().any(|surface| {
                        let step = |by: f64| surface.distance(point + by * sight);
                        let slope = (step(1e-5) - step(-1e-5)) / 2e-5;
                        surface.distance(point).abs() < 1e-9 && slope.abs() < 1e-6
                    })
                };
                let lines = shape.outline(&camera, DVec3::ZERO, 1.0);
                let grazing = lines.iter().filter(|line| line.iter().all(|p| grazes(*p)));
                let least = match shape.solid() {
                    Solid::Sphere { .. } | Solid::Ellipsoid { .. } => STRETCHES,
                    _ => 2,
                };
                assert!(grazing.count() >= least, "{shape}");
            }
        }
    }

    #[test]
    fn an_eye_within_still_sees_lines_and_all_are_numbers() {
        for text in [
            "sphere:0,0,0,1",
            "ellipsoid:0,0,0,1,2,3",
            "cylinder:0,0,-1,0,0,1,1",
            "capsule:0,0,-1,0,0,1,1",
            "cone:0,0,-1,0,0,1,1",
        ] {
            let shape: Shape = text.parse().unwrap();
            for eye in [DVec3::ZERO, DVec3::new(0.0, 0.0, -1.0), 5.0 * DVec3::Z] {
                let target = eye + DVec3::Z;
                let camera = Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, (64, 64)).unwrap();
                for camera in [camera, camera.projection(Projection::Orthographic)] {
                    let lines = shape.outline(&camera, DVec3::ZERO, 1.0);
                    assert!(lines.len() > STRETCHES, "{text}");
                    let finite = lines.iter().flatten().all(|p| p.is_finite());
                    assert!(finite, "{text} from {eye}");
                }
            }
        }
    }
}
