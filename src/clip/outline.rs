//! The lines by which people recognise a shape: its edges, and where its curved sides turn away from the eye.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DQuat, DVec3};

use super::{Plane, Shape, Solid};
use crate::camera::{Camera, Projection};

/// Stretches of a circle: they leave it by less than 1/1800 of its radius.
const STRETCHES: usize = 96;

/// A line between two points of a surface.
type Stretch = [DVec3; 2];

impl Shape {
    /// Lines on its surface as a camera sees it, world units, whose ends lie on the surface: the edges of boxes; three great
    /// ellipses of spheres and ellipsoids, and where they turn away from the eye; the circles of cylinders, cones and capsules,
    /// and the lines of their sides where those turn away. An eye within such a side sees four of its lines. Planes are
    /// squares of half the size `reach` around the point nearest to `near`.
    ///
    /// ```
    /// use rara::{Camera, Shape, glam::DVec3};
    ///
    /// let eye = DVec3::new(3.0, 2.0, -4.0);
    /// let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64))?;
    /// let block: Shape = "box:0,0,0,1,1,1".parse()?;
    /// assert_eq!(block.outline(&camera, DVec3::ZERO, 1.0).len(), 12);
    /// # Ok::<(), rara::Error>(())
    /// ```
    pub fn outline(&self, camera: &Camera, near: DVec3, reach: f64) -> Vec<[DVec3; 2]> {
        let sight = Sight(camera);
        let mut lines = Vec::new();
        match self.solid() {
            Solid::Plane(plane) => {
                square(&mut lines, &plane, near, reach);
                cross(&mut lines, &plane, near, reach);
            }
            Solid::Slab { plane, thickness } => {
                square(&mut lines, &plane, near, reach);
                // The other side is as far along the normal as the slab is thick.
                for at in 0..lines.len() {
                    lines.push(lines[at].map(|p| p + thickness * plane.normal()));
                }
            }
            Solid::Cuboid {
                centre,
                half,
                rotation,
            } => edges(&mut lines, centre, half, rotation),
            Solid::Sphere { centre, radius } => {
                let axes = DMat3::from_diagonal(DVec3::splat(radius));
                ellipsoid(&mut lines, centre, axes, sight);
            }
            Solid::Ellipsoid {
                centre,
                radii,
                rotation,
            } => {
                let axes = DMat3::from_quat(rotation) * DMat3::from_diagonal(radii);
                ellipsoid(&mut lines, centre, axes, sight);
            }
            Solid::Cylinder { from, to, radius } => {
                tube(&mut lines, &Tube::new(from, to, radius), sight);
            }
            Solid::Capsule { from, to, radius } => {
                let side = Tube::new(from, to, radius);
                tube(&mut lines, &side, sight);
                cap(&mut lines, &side, sight);
                cap(&mut lines, &Tube::new(to, from, radius), sight);
            }
            Solid::Cone { apex, base, radius } => {
                let around = Tube::new(base, apex, radius);
                around.circle(&mut lines, base);
                let slope = radius / around.length;
                let to_eye = sight.from(apex);
                // A cone's axis leads away from its apex, where the tube's leads to it.
                let sides = around.angles(to_eye, -slope * to_eye.dot(around.axis));
                lines.extend(sides.map(|angle| [apex, base + around.radial(angle)]));
            }
        }
        lines
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

/// The circle around a centre that goes through `centre + right` and `centre + up`, from one angle to another.
fn arc(
    lines: &mut Vec<Stretch>,
    (centre, right, up): (DVec3, DVec3, DVec3),
    [from, to]: [f64; 2],
    stretches: usize,
) {
    let point = |step: usize| {
        let angle = from + (to - from) * step as f64 / stretches as f64;
        centre + right * angle.cos() + up * angle.sin()
    };
    lines.extend((0..stretches).map(|step| [point(step), point(step + 1)]));
}

fn circle(lines: &mut Vec<Stretch>, around: (DVec3, DVec3, DVec3)) {
    arc(lines, around, [0.0, TAU], STRETCHES);
}

/// The sides of a square on a plane.
fn square(lines: &mut Vec<Stretch>, plane: &Plane, near: DVec3, reach: f64) {
    let [right, up] = <[DVec3; 2]>::from(plane.normal().any_orthonormal_pair());
    let middle = near - plane.normal() * plane.distance(near);
    let corner = |[x, y]: [f64; 2]| middle + reach * (x * right + y * up);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner);
    lines.extend((0..4).map(|at| [corners[at], corners[(at + 1) % 4]]));
}

/// A small cross in the middle of that square, where a plane is turned about.
fn cross(lines: &mut Vec<Stretch>, plane: &Plane, near: DVec3, reach: f64) {
    let [right, up] = <[DVec3; 2]>::from(plane.normal().any_orthonormal_pair());
    let middle = near - plane.normal() * plane.distance(near);
    let arm = 0.05 * reach;
    lines.extend([right, up].map(|along| [middle - arm * along, middle + arm * along]));
}

/// The twelve edges of a box.
fn edges(lines: &mut Vec<Stretch>, centre: DVec3, half: DVec3, rotation: DQuat) {
    let corner = |bits: usize| {
        let side = |axis: usize| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
        centre + rotation * (half * DVec3::new(side(0), side(1), side(2)))
    };
    for axis in 0..3 {
        let lows = (0..8).filter(|bits| bits >> axis & 1 == 0);
        lines.extend(lows.map(|bits| [corner(bits), corner(bits | 1 << axis)]));
    }
}

/// Three great ellipses, and the contour. `axes` takes the unit ball to the ellipsoid around its centre.
fn ellipsoid(lines: &mut Vec<Stretch>, centre: DVec3, axes: DMat3, sight: Sight<'_>) {
    for axis in 0..3 {
        let (right, up) = (axes.col((axis + 1) % 3), axes.col((axis + 2) % 3));
        circle(lines, (centre, right, up));
    }
    // Of the unit ball the contour is a circle across the line to the eye, at one over the eye's distance.
    let eye = axes.inverse() * sight.from(centre);
    let squared = eye.length_squared();
    let (ahead, radius) = match sight.is_parallel() {
        true => (0.0, 1.0),
        false => (1.0 / squared, (1.0 - 1.0 / squared).sqrt()),
    };
    // An eye within sees no contour: its radius is no number.
    if let Some(towards) = eye.try_normalize().filter(|_| radius > 0.0) {
        let (right, up) = towards.any_orthonormal_pair();
        let middle = centre + axes * (ahead * eye);
        circle(
            lines,
            (middle, axes * (radius * right), axes * (radius * up)),
        );
    }
}

/// A stretch of a line, and a distance around it.
struct Tube {
    ends: [DVec3; 2],
    /// From the first end to the other, of length one.
    axis: DVec3,
    /// Two directions across the axis.
    across: [DVec3; 2],
    length: f64,
    radius: f64,
}

impl Tube {
    fn new(from: DVec3, to: DVec3, radius: f64) -> Self {
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

    fn circle(&self, lines: &mut Vec<Stretch>, at: DVec3) {
        let [right, up] = self.across.map(|direction| self.radius * direction);
        circle(lines, (at, right, up));
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

/// The circles at both ends, and lines of the side.
fn tube(lines: &mut Vec<Stretch>, tube: &Tube, sight: Sight<'_>) {
    for at in tube.ends {
        tube.circle(lines, at);
    }
    let product = match sight.is_parallel() {
        true => 0.0,
        false => tube.radius,
    };
    let [from, to] = tube.ends;
    let angles = tube.angles(sight.from(from), product);
    lines.extend(angles.map(|angle| [from, to].map(|end| end + tube.radial(angle))));
}

/// The half ball at the tube's first end: two half circles over its pole, and what of the ball's contour is on this half.
fn cap(lines: &mut Vec<Stretch>, tube: &Tube, sight: Sight<'_>) {
    let centre = tube.ends[0];
    let pole = -tube.radius * tube.axis;
    for across in tube.across {
        let around = (centre, tube.radius * across, pole);
        arc(lines, around, [0.0, TAU / 2.0], STRETCHES / 2);
    }
    let mut ball = Vec::new();
    let axes = DMat3::from_diagonal(DVec3::splat(tube.radius));
    ellipsoid(&mut ball, centre, axes, sight);
    let is_outer = |line: &Stretch| line.iter().all(|p| (p - centre).dot(tube.axis) <= 0.0);
    lines.extend(ball.into_iter().skip(3 * STRETCHES).filter(is_outer));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::placed::tests::shapes;
    use crate::scene::Random;

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
