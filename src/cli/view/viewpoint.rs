//! The viewer's position, and how it moves: about a point (orbit) or about itself (fly).

use glam::{DMat3, DQuat, DVec2, DVec3};
use rara::{Camera, Projection};

/// The pivot of a turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Walk {
    /// A point on the view's axis.
    Orbit,
    /// The eye.
    Fly,
}

/// A pose, a lens, and the ways to move. Whatever is dragged follows the mouse.
#[derive(Debug, Clone)]
pub(super) struct Viewpoint {
    pub(super) walk: Walk,
    pub(super) projection: Projection,
    pose: Pose,
    /// The world's up direction: turning sideways goes about it.
    up: DVec3,
    /// The camera at the start, for its focal lengths, in perspective, and its principal point.
    lens: Camera,
    home: (Pose, Projection),
    /// The scene's middle and radius.
    scene: (DVec3, f64),
    /// The least distance from the pivot, in this scene.
    least: f64,
}

#[derive(Debug, Clone, Copy)]
struct Pose {
    eye: DVec3,
    /// Columns: right, down and forward in the world.
    axes: DMat3,
    /// The distance from the eye to the point that it orbits.
    distance: f64,
}

/// The view's axis stays this far from straight up and down, radians.
const POLE: f64 = 0.01;
/// One step of the wheel takes the eye this share of the way nearer.
const STEP: f64 = 0.1;
/// No eye stands farther out along an axis: the squares of larger lengths are beyond single precision.
const FARTHEST: f64 = 1e18;

impl Viewpoint {
    /// A viewpoint from a camera, in a scene of this middle and radius. It orbits the point of the camera's axis that is
    /// beside the middle.
    pub(super) fn new(camera: &Camera, up: DVec3, centre: DVec3, radius: f64) -> Self {
        let axes = camera.rotation.transpose();
        let pose = Pose {
            eye: camera.eye,
            axes,
            distance: (centre - camera.eye).dot(axes.z_axis).max(0.1 * radius),
        };
        // Both projections show the pivot at one scale.
        let focal = match camera.projection {
            Projection::Orthographic => pose.distance,
            _ => 1.0,
        };
        Self {
            walk: Walk::Orbit,
            projection: camera.projection,
            pose,
            up: up.normalize(),
            lens: camera.fx(camera.fx * focal).fy(camera.fy * focal),
            home: (pose, camera.projection),
            scene: (centre, radius),
            least: 1e-3 * radius,
        }
    }

    /// The camera for a picture of this size: its height shows as much of the world as at the start.
    pub(super) fn camera(&self, (width, height): (u32, u32)) -> Camera {
        let lens = &self.lens;
        let scale = f64::from(height) / f64::from(lens.height);
        let beside = lens.cx - f64::from(lens.width) / 2.0;
        let camera = lens
            .width(width)
            .height(height)
            .fx(lens.fx * scale)
            .fy(lens.fy * scale)
            .cx(f64::from(width) / 2.0 + beside * scale)
            .cy(lens.cy * scale)
            .eye(self.pose.eye)
            .rotation(self.pose.axes.transpose())
            .projection(self.projection);
        if self.projection != Projection::Orthographic {
            return camera;
        }
        let ((centre, radius), forward) = (self.scene, self.pose.axes.z_axis);
        // The scene is seen as a whole, also the part of it that a near pivot has behind the eye.
        let back = (2.0 * radius - (centre - camera.eye).dot(forward)).max(0.0);
        let farther = |depth: f64| depth + back;
        camera
            .clip_near(camera.clip_near.map(farther))
            .clip_far(camera.clip_far.map(farther))
            .near_cut(camera.near_cut.map(farther))
            .fx(camera.fx / self.pose.distance)
            .fy(camera.fy / self.pose.distance)
            .eye(camera.eye - forward * back)
    }

    /// Changes between perspective and an orthographic view, which show the pivot at one scale.
    pub(super) fn other_projection(&mut self) {
        self.projection = match self.projection {
            Projection::Orthographic => Projection::Perspective,
            _ => Projection::Orthographic,
        };
    }

    /// Turns so that what is in front goes right and down by so many degrees.
    pub(super) fn turn(&mut self, degrees: DVec2) {
        let mut pose = self.pose;
        // Orbiting moves the eye to the other side; looking about turns the view there.
        let sign = match self.walk {
            Walk::Orbit => -1.0,
            Walk::Fly => 1.0,
        };
        let (across, along) = (sign * degrees.x.to_radians(), sign * degrees.y.to_radians());
        let polar = pose.axes.z_axis.dot(self.up).clamp(-1.0, 1.0).acos();
        let steeper = polar - (polar - along).clamp(POLE, std::f64::consts::PI - POLE);
        let turn = DQuat::from_axis_angle(self.up, across)
            * DQuat::from_axis_angle(pose.axes.x_axis, steeper);
        let pivot = pose.pivot();
        pose.axes = orthonormal(DMat3::from_quat(turn) * pose.axes);
        if self.walk == Walk::Orbit {
            pose.eye = pivot - pose.axes.z_axis * pose.distance;
        }
        self.place(pose);
    }

    /// Moves the eye sideways, so that what is as far away as the pivot moves by so many pixels of a picture of this
    /// height.
    pub(super) fn shift(&mut self, pixels: DVec2, height: u32) {
        let focal = self.lens.fy * f64::from(height) / f64::from(self.lens.height);
        let by = -pixels * self.pose.distance / focal;
        self.go(DVec3::new(by.x, by.y, 0.0));
    }

    /// Moves so many steps nearer to the pivot, or farther where the number is negative.
    pub(super) fn zoom(&mut self, steps: f64) {
        let mut pose = self.pose;
        let distance = pose.distance * (1.0 - STEP).powf(steps);
        pose.distance = distance.clamp(self.least, 1e6 * self.least);
        pose.eye = self.pose.pivot() - pose.axes.z_axis * pose.distance;
        self.place(pose);
    }

    /// Moves right, down and forward, world units; the pivot goes along.
    pub(super) fn go(&mut self, by: DVec3) {
        let eye = self.pose.eye + self.pose.axes * by;
        self.place(Pose { eye, ..self.pose });
    }

    pub(super) fn reset(&mut self) {
        (self.pose, self.projection) = self.home;
    }

    fn place(&mut self, pose: Pose) {
        // An eye whose numbers overflow stays where it was.
        if pose.eye.abs().cmple(DVec3::splat(FARTHEST)).all() {
            self.pose = pose;
        }
    }
}

impl Pose {
    fn pivot(&self) -> DVec3 {
        self.eye + self.axes.z_axis * self.distance
    }
}

/// The axes without what rounding has added over many turns.
fn orthonormal(axes: DMat3) -> DMat3 {
    let forward = axes.z_axis.normalize();
    let right = (axes.x_axis - forward * axes.x_axis.dot(forward)).normalize();
    DMat3::from_cols(right, forward.cross(right), forward)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (800, 600);

    /// A viewpoint four units before the origin, level.
    fn start() -> Viewpoint {
        let eye = DVec3::new(0.0, 0.0, -4.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, SIZE).unwrap();
        Viewpoint::new(&camera, DVec3::NEG_Y, DVec3::new(0.3, 0.1, 0.0), 1.0)
    }

    fn pixel(view: &Viewpoint, point: DVec3) -> DVec2 {
        let c = view.camera(SIZE);
        let p = c.rotation * (point - c.eye);
        DVec2::new(c.fx * p.x / p.z + c.cx, c.fy * p.y / p.z + c.cy)
    }

    #[test]
    fn the_first_camera_is_the_one_given() {
        let eye = DVec3::new(0.0, 1.0, -4.0);
        let given = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, SIZE).unwrap();
        let view = Viewpoint::new(&given, DVec3::NEG_Y, DVec3::ZERO, 1.0);
        assert_eq!(view.camera(SIZE), given);
    }

    #[test]
    fn orbiting_keeps_the_pivot_in_the_middle_and_takes_what_is_in_front_along() {
        let mut view = start();
        let near = DVec3::new(0.0, 0.0, -1.0);
        let before = pixel(&view, near);
        view.turn(DVec2::new(10.0, 0.0));
        assert!(pixel(&view, near).x > before.x + 10.0);
        view.turn(DVec2::new(0.0, 10.0));
        assert!(pixel(&view, near).y > before.y + 10.0);
        assert!((view.camera(SIZE).eye.length() - 4.0).abs() < 1e-12);
        assert!((pixel(&view, DVec3::ZERO) - DVec2::new(400.0, 300.0)).length() < 1e-9);
    }

    #[test]
    fn looking_about_keeps_the_eye_and_takes_what_is_in_front_along() {
        let mut view = start();
        view.walk = Walk::Fly;
        let before = pixel(&view, DVec3::ZERO);
        view.turn(DVec2::new(5.0, 5.0));
        let after = pixel(&view, DVec3::ZERO);
        assert!(
            after.x > before.x + 10.0 && after.y > before.y + 10.0,
            "{after}"
        );
        assert_eq!(view.camera(SIZE).eye, DVec3::new(0.0, 0.0, -4.0));
    }

    #[test]
    fn no_turn_goes_over_a_pole_or_rolls_the_view() {
        for walk in [Walk::Orbit, Walk::Fly] {
            for direction in [1.0, -1.0] {
                let mut view = start();
                view.walk = walk;
                for _ in 0..1000 {
                    view.turn(DVec2::new(3.7, direction * 2.9));
                }
                let axes = view.camera(SIZE).rotation.transpose();
                assert!(axes.x_axis.y.abs() < 1e-9, "rolled: {axes}");
                assert!(axes.y_axis.y > 0.0, "upside down: {axes}");
                let product = axes.transpose() * axes;
                assert!(
                    (product - DMat3::IDENTITY)
                        .to_cols_array()
                        .iter()
                        .all(|e| e.abs() < 1e-12)
                );
            }
        }
    }

    #[test]
    fn what_is_dragged_sideways_follows_the_mouse() {
        let mut view = start();
        let by = DVec2::new(30.0, -17.0);
        let before = pixel(&view, DVec3::ZERO);
        view.shift(by, SIZE.1);
        assert!((pixel(&view, DVec3::ZERO) - before - by).length() < 1e-9);
    }

    #[test]
    fn zooming_there_and_back_is_no_change_and_never_passes_the_pivot() {
        let mut view = start();
        view.zoom(5.0);
        assert!(view.camera(SIZE).eye.z > -4.0);
        view.zoom(-5.0);
        assert!((view.camera(SIZE).eye.z + 4.0).abs() < 1e-12);
        view.zoom(1e4);
        assert!(view.camera(SIZE).eye.z < 0.0);
        view.reset();
        assert_eq!(view.camera(SIZE).eye.z, -4.0);
    }

    #[test]
    fn an_orthographic_view_shows_the_pivot_at_the_scale_of_perspective_and_zooms() {
        let mut view = start();
        let aside = DVec3::new(0.5, -0.2, 0.0);
        let before = pixel(&view, aside);
        view.other_projection();
        let flat = |view: &Viewpoint, point: DVec3| {
            let c = view.camera(SIZE);
            let p = c.rotation * (point - c.eye);
            assert!(p.z > 0.2 && c.projection == Projection::Orthographic);
            DVec2::new(c.fx * p.x + c.cx, c.fy * p.y + c.cy)
        };
        assert!(flat(&view, aside).distance(before) < 1e-9);
        assert!(flat(&view, aside + DVec3::Z).distance(before) < 1e-9);
        let again = Viewpoint::new(&view.camera(SIZE), DVec3::NEG_Y, view.scene.0, view.scene.1);
        assert!(flat(&again, aside).distance(before) < 1e-9);
        view.zoom(20.0);
        let middle = DVec2::new(400.0, 300.0);
        let nearer = (flat(&view, aside) - middle).length() / (before - middle).length();
        assert!((nearer - 0.9_f64.powi(-20)).abs() < 1e-9, "{nearer}");
        view.reset();
        assert_eq!(view.camera(SIZE).projection, Projection::Perspective);
    }

    #[test]
    fn flying_goes_along_the_view() {
        let mut view = start();
        view.go(DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(view.camera(SIZE).eye, DVec3::new(1.0, 2.0, -1.0));
    }

    #[test]
    fn an_eye_beyond_all_numbers_stays_where_it_was() {
        for walk in [Walk::Orbit, Walk::Fly] {
            let mut view = start();
            view.walk = walk;
            let before = view.camera(SIZE);
            for _ in 0..3 {
                view.go(DVec3::new(1e308, 0.0, 0.0));
                view.go(DVec3::new(0.0, -1e30, 1e30));
                view.go(DVec3::splat(f64::NAN));
                view.shift(DVec2::new(-1e308, 0.0), SIZE.1);
                view.shift(DVec2::new(0.0, f64::INFINITY), SIZE.1);
            }
            assert_eq!(view.camera(SIZE), before);
            for _ in 0..3 {
                view.go(DVec3::Z * 9e17);
                view.turn(DVec2::splat(1e308));
                view.zoom(-1e308);
            }
            let camera = view.camera(SIZE);
            assert!(camera.eye.abs().max_element() <= FARTHEST, "{camera:?}");
            assert!(camera.world_to_camera().is_finite(), "{camera:?}");
        }
    }

    #[test]
    fn a_wider_window_shows_more_at_the_sides_and_as_much_in_height() {
        let view = start();
        let (narrow, wide) = (view.camera(SIZE), view.camera((1600, 600)));
        assert_eq!((narrow.fy, narrow.fx), (wide.fy, wide.fx));
        assert_eq!((wide.cx, wide.cy), (800.0, 300.0));
        assert_eq!(view.camera((400, 300)).fy, narrow.fy / 2.0);
    }
}
