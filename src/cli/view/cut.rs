//! The clip that is shown, and the one of its planes that is moved.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec2, DVec3};
use rara::clip::{Expression, Solid};
use rara::{Camera, Clip, ClipOp, Plane, Projection, Shape};

/// The planes, which of them is held, whether they cut at all, and the other surfaces of the clip.
#[derive(Debug, Clone)]
pub(super) struct Cut {
    pub(super) on: bool,
    planes: Vec<Plane>,
    /// The rest of the clip, which stays where it is.
    rest: Vec<Expression>,
    op: ClipOp,
    held: usize,
    /// The scene's middle.
    centre: DVec3,
}

impl Cut {
    /// The clip of the command line; without one a plane through the middle of the scene, which is off at first.
    pub(super) fn new(clip: Vec<Expression>, op: ClipOp, centre: DVec3) -> Self {
        let plane = |expression: &Expression| match expression {
            Expression::Shape(shape) => match shape.solid() {
                Solid::Plane(plane) if shape.is_outside() => Some(plane.flipped()),
                Solid::Plane(plane) => Some(plane),
                _ => None,
            },
            _ => None,
        };
        let planes: Vec<Plane> = clip.iter().filter_map(plane).collect();
        let mut rest = clip;
        rest.retain(|expression| plane(expression).is_none());
        let mut this = Self {
            on: !planes.is_empty(),
            planes,
            rest,
            op,
            held: 0,
            centre,
        };
        if !this.on {
            this.planes.push(this.middle(DVec3::X));
        }
        this
    }

    /// The clip in force.
    pub(super) fn clip(&self) -> Clip {
        match &self.expressions()[..] {
            [] => Clip::default(),
            all => Clip::joined(all.iter().map(Expression::clip), self.op),
        }
    }

    /// The same as shapes and expressions.
    pub(super) fn expressions(&self) -> Vec<Expression> {
        let planes = self.planes.iter().filter(|_| self.on);
        let planes = planes.map(|&plane| Expression::Shape(Shape::from(plane)));
        self.rest.iter().cloned().chain(planes).collect()
    }

    /// How they combine.
    pub(super) fn op(&self) -> ClipOp {
        self.op
    }

    /// The plane that is held.
    pub(super) fn plane(&self) -> Plane {
        self.planes[self.held]
    }

    /// Holds the next plane.
    pub(super) fn next(&mut self) {
        self.held = (self.held + 1) % self.planes.len();
    }

    /// Puts another plane in the held one's place.
    pub(super) fn set(&mut self, plane: Plane) {
        self.planes[self.held] = plane;
        self.on = true;
    }

    /// Keeps the other side of the held plane.
    pub(super) fn flip(&mut self) {
        self.set(self.plane().flipped());
    }

    /// Puts the held plane through the middle of the scene, across an axis.
    pub(super) fn align(&mut self, axis: DVec3) {
        self.set(self.middle(axis));
    }

    /// Moves the held plane along its normal, world units.
    pub(super) fn go(&mut self, by: f64) {
        let plane = self.plane();
        self.place(plane.normal(), plane.offset() - by);
    }

    /// Moves the held plane along its normal so that it follows the mouse; where its normal points towards the eye or
    /// away from it, a drag upwards moves it away.
    pub(super) fn drag(&mut self, pixels: DVec2, camera: &Camera) {
        let normal = camera.rotation * self.plane().normal();
        let mut at = camera.rotation * (self.foot() - camera.eye);
        // A point behind the eye has no place in the picture.
        at.z = at.z.max(1e-2 * at.length()).max(f64::MIN_POSITIVE);
        let focal = DVec2::new(camera.fx, camera.fy);
        // How the foot moves in the picture, per unit along the normal, and how long a unit is there.
        let (across, unit) = match camera.projection {
            Projection::Orthographic => (focal * normal.truncate(), camera.fy),
            _ => (
                focal * (normal.truncate() - at.truncate() / at.z * normal.z) / at.z,
                camera.fy / at.z,
            ),
        };
        let by = if across.length() > (1.0 - FRAC_1_SQRT_2) * unit {
            pixels.dot(across) / across.length_squared()
        } else {
            -pixels.y / unit * normal.z.signum()
        };
        self.go(by);
    }

    /// Turns the held plane about its point nearest to the middle of the scene, so that the tip of a normal that points
    /// towards the eye goes right and down by so many degrees.
    pub(super) fn tilt(&mut self, degrees: DVec2, camera: &Camera) {
        let axes = camera.rotation.transpose();
        let turn = DQuat::from_axis_angle(-axes.y_axis, degrees.x.to_radians())
            * DQuat::from_axis_angle(axes.x_axis, degrees.y.to_radians());
        let foot = self.foot();
        let normal = turn * self.plane().normal();
        self.place(normal, -normal.dot(foot));
    }

    /// The plane's point nearest to the middle of the scene.
    fn foot(&self) -> DVec3 {
        let plane = self.plane();
        self.centre - plane.normal() * plane.distance(self.centre)
    }

    fn middle(&self, axis: DVec3) -> Plane {
        Plane::new(axis, -axis.dot(self.centre)).expect("an axis is finite and not zero")
    }

    fn place(&mut self, normal: DVec3, offset: f64) {
        // A plane whose numbers overflow stays where it was.
        if let Ok(plane) = Plane::new(normal, offset) {
            self.set(plane);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CENTRE: DVec3 = DVec3::new(1.0, 2.0, 3.0);

    fn cut() -> Cut {
        Cut::new(Vec::new(), ClipOp::And, CENTRE)
    }

    fn camera(from: DVec3) -> Camera {
        let eye = CENTRE + 5.0 * from;
        Camera::look_at(eye, CENTRE, DVec3::NEG_Y, 50.0, (800, 600)).unwrap()
    }

    #[test]
    fn without_a_clip_nothing_is_cut_until_a_plane_is_touched() {
        let mut cut = cut();
        assert_eq!(cut.clip(), Clip::default());
        cut.go(0.25);
        let surfaces = cut.clip().surfaces;
        assert_eq!(surfaces.len(), 1);
        assert!(
            (surfaces[0].distance(CENTRE) + 0.25).abs() < 1e-12,
            "{surfaces:?}"
        );
    }

    #[test]
    fn planes_that_were_typed_are_held_in_turn() {
        let planes = [
            Plane::new(DVec3::X, 0.0).unwrap(),
            Plane::new(DVec3::Y, 0.0).unwrap(),
        ];
        let clip = Clip::of(planes, ClipOp::Or);
        let typed = planes.map(|plane| Expression::Shape(plane.into()));
        let mut cut = Cut::new(typed.into(), ClipOp::Or, CENTRE);
        assert_eq!(cut.clip(), clip);
        cut.next();
        cut.flip();
        assert_eq!(
            cut.clip(),
            Clip::of([planes[0], planes[1].flipped()], ClipOp::Or)
        );
        cut.next();
        assert_eq!(cut.plane(), planes[0]);
    }

    #[test]
    fn a_dragged_plane_follows_the_mouse() {
        let camera = camera(DVec3::new(0.2, -0.1, -1.0).normalize());
        let mut cut = cut();
        let pixel = |point: DVec3| {
            let p = camera.rotation * (point - camera.eye);
            DVec2::new(camera.fx * p.x / p.z, camera.fy * p.y / p.z)
        };
        let before = pixel(cut.foot());
        cut.drag(DVec2::new(2.0, 0.0), &camera);
        let along = pixel(cut.foot()) - before;
        assert!((along.x - 2.0).abs() < 0.1, "{along}");
    }

    #[test]
    fn a_plane_that_faces_the_eye_goes_away_when_dragged_up() {
        for normal in [DVec3::Z, -DVec3::Z] {
            let camera = camera(-DVec3::Z);
            let mut cut = cut();
            cut.align(normal);
            cut.drag(DVec2::new(40.0, -10.0), &camera);
            let depth = (camera.rotation * (cut.foot() - camera.eye)).z;
            assert!((depth - 5.0 - 50.0 / camera.fy).abs() < 1e-9, "{depth}");
        }
    }

    #[test]
    fn a_plane_behind_the_eye_can_be_dragged_too() {
        let mut camera = camera(-DVec3::Z);
        camera.eye += DVec3::Z * 20.0;
        let mut cut = cut();
        cut.drag(DVec2::new(5.0, 5.0), &camera);
        assert!(cut.plane().offset().is_finite());
        camera.eye = cut.foot();
        cut.drag(DVec2::new(5.0, 5.0), &camera);
        assert!(cut.plane().offset().is_finite());
    }

    #[test]
    fn tilting_turns_about_the_point_nearest_to_the_middle() {
        let camera = camera(-DVec3::Z);
        let mut cut = cut();
        cut.align(-DVec3::Z);
        cut.go(0.5);
        let foot = cut.foot();
        cut.tilt(DVec2::new(30.0, 0.0), &camera);
        assert!(cut.plane().distance(foot).abs() < 1e-12);
        // The normal pointed at the eye; now also to the right.
        let normal = cut.plane().normal();
        assert!(
            (normal - DVec3::new(0.5, 0.0, -0.75_f64.sqrt())).length() < 1e-12,
            "{normal}"
        );
        cut.tilt(DVec2::new(0.0, 30.0), &camera);
        assert!(
            cut.plane().normal().y > 0.1,
            "down: {}",
            cut.plane().normal()
        );
    }
}
