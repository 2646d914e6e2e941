//! The viewer's position, and how it moves: about a point (orbit) or about itself (fly).

use glam::{DMat3, DQuat, DVec2, DVec3};
use rara::{Camera, Projection};

/// The pivot of a turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
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
/// Who looks at a smaller angle than this along a direction, radians, sees it neither up nor down.
const ALONG: f64 = 1e-6;
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

    /// True when this axis is up.
    pub(super) fn has_up(&self, axis: DVec3) -> bool {
        self.up.dot(axis) > 1.0 - 1e-12
    }

    /// Rolls the view so that a direction is up, also in the view at the start.
    pub(super) fn set_up(&mut self, up: DVec3) {
        self.up = up.normalize();
        for pose in [&mut self.pose, &mut self.home.0] {
            pose.axes = rolled(pose.axes, self.up);
        }
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

/// The axes rolled so that a direction is up; as they are where they look along it.
fn rolled(axes: DMat3, up: DVec3) -> DMat3 {
    let forward = axes.z_axis;
    let across = forward.cross(up);
    match across.length() > ALONG {
        true => orthonormal(DMat3::from_cols(across, -up, forward)),
        false => axes,
    }
}

/// The axes without what rounding has added over many turns.
fn orthonormal(axes: DMat3) -> DMat3 {
    let forward = axes.z_axis.normalize();
    let right = (axes.x_axis - forward * axes.x_axis.dot(forward)).normalize();
    DMat3::from_cols(right, forward.cross(right), forward)
}

#[cfg(test)]
mod tests;
