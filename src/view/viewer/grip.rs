//! How the held shape is moved, turned and scaled.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec2, DVec3};
use rara::clip::{Expression, Parameter};
use rara::{Camera, Placement, Plane, Projection, Shape};

use super::action::{GripAction, Kind};
use super::cut::ClipEditor;

impl ClipEditor {
    /// Does what is asked of the held shape, in a scene of this radius.
    pub(super) fn act(&mut self, action: GripAction, camera: &Camera, radius: f64) {
        match action {
            GripAction::On(on) => self.on = on,
            GripAction::Toggle => self.on = !self.on,
            GripAction::Flip => self.flip(),
            GripAction::Next => self.next(),
            GripAction::Align(axis) => self.align(axis),
            GripAction::Set(shape) => self.set(shape),
            GripAction::Become(kind) => self.become_a(kind, camera, radius),
            GripAction::Go(by) => self.go(by, camera),
            GripAction::Step(steps) => self.go(0.01 * steps * radius, camera),
            GripAction::Drag(pixels) => self.drag(pixels, camera),
            GripAction::Tilt(degrees) => self.tilt(degrees, camera),
            GripAction::Scale(factor) => self.scale(factor),
        }
    }

    /// Moves the held shape along its normal, world units; one without a normal goes away from the eye.
    pub(super) fn go(&mut self, by: f64, camera: &Camera) {
        let along = normal(self.shape()).unwrap_or(camera.rotation.row(2));
        self.shift(by * along);
    }

    /// Moves the held shape so that it follows the mouse. A plane or slab goes along its normal; where that points towards the
    /// eye or away from it, a drag upwards moves it away.
    pub(super) fn drag(&mut self, pixels: DVec2, camera: &Camera) {
        let focal = DVec2::new(camera.fx, camera.fy);
        let mut at = camera.rotation * (self.middle() - camera.eye);
        // A point behind the eye has no place in the picture.
        at.z = at.z.max(1e-2 * at.length()).max(f64::MIN_POSITIVE);
        let is_flat = camera.projection == Projection::Orthographic;
        let Some(along) = normal(self.shape()) else {
            let depth = if is_flat { 1.0 } else { at.z };
            let by = pixels * depth / focal;
            return self.shift(camera.rotation.transpose() * by.extend(0.0));
        };
        let normal = camera.rotation * along;
        // How the middle moves in the picture, per unit along the normal, and how long a unit is there.
        let (across, unit) = match is_flat {
            true => (focal * normal.truncate(), camera.fy),
            false => (
                focal * (normal.truncate() - at.truncate() / at.z * normal.z) / at.z,
                camera.fy / at.z,
            ),
        };
        let by = if across.length() > (1.0 - FRAC_1_SQRT_2) * unit {
            pixels.dot(across) / across.length_squared()
        } else {
            -pixels.y / unit * normal.z.signum()
        };
        self.shift(by * along);
    }

    /// Turns the held shape about its middle, so that what of it points towards the eye goes right and down by so many
    /// degrees. Turning by the negative of both turns it back.
    pub(super) fn tilt(&mut self, degrees: DVec2, camera: &Camera) {
        let axes = camera.rotation.transpose();
        let about = axes.x_axis * degrees.y.to_radians() - axes.y_axis * degrees.x.to_radians();
        self.turn(DQuat::from_scaled_axis(about));
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.about_middle(DQuat::IDENTITY, factor);
    }

    /// Turns the held shape's axis to an axis of the world. A plane also goes through the middle of the scene.
    pub(super) fn align(&mut self, axis: DVec3) {
        let arc = |from: DVec3| DQuat::from_rotation_arc(from, axis);
        let mut ends = Vec::new();
        let is_plane = self.shape().and_then(Expression::as_plane).is_some();
        match self.shape() {
            Some(Expression::Prism(prism)) => return self.turn(arc(prism.along())),
            // Its own z axis.
            Some(Expression::Mesh(mesh)) => {
                let turned = mesh.inside().placement().rotation() * DVec3::Z;
                return self.turn(arc(turned));
            }
            _ => {}
        }
        for parameter in values(self.shape()) {
            match parameter {
                Parameter::Plane(_) if is_plane => return self.set(self.across(axis)),
                Parameter::Plane(plane) => return self.turn(arc(plane.normal())),
                Parameter::Rotation(rotation) => {
                    return self.turn(arc(DVec3::X) * rotation.inverse());
                }
                Parameter::Point(end) => ends.push(end),
                Parameter::Sizes(_) | Parameter::Size(_) => {}
            }
        }
        if let [from, to] = ends[..] {
            self.turn(arc((to - from).normalize()));
        }
    }

    /// Makes the held shape one of another kind, in a scene of this radius.
    fn become_a(&mut self, kind: Kind, camera: &Camera, radius: f64) {
        let (middle, size) = (self.middle(), 0.5 * radius);
        let made = match kind {
            Kind::Plane => {
                let along = camera.rotation.row(2);
                Plane::new(along, -along.dot(middle)).map(Shape::from)
            }
            Kind::Box => Shape::cuboid(middle, DVec3::splat(size), DQuat::IDENTITY),
            Kind::Sphere => Shape::sphere(middle, size),
        };
        // A scene without extent has no shape of its size.
        if let Ok(shape) = made {
            self.set(shape);
        }
    }

    fn shift(&mut self, by: DVec3) {
        if let Ok(placement) = Placement::new(by, DQuat::IDENTITY, 1.0) {
            self.place(&placement);
        }
    }

    fn turn(&mut self, turn: DQuat) {
        self.about_middle(turn, 1.0);
    }

    fn about_middle(&mut self, turn: DQuat, scale: f64) {
        let middle = self.middle();
        if let Ok(placement) = Placement::new(middle - scale * (turn * middle), turn, scale) {
            self.place(&placement);
        }
    }
}

/// The normal of what has a single one.
fn normal(shape: Option<&Expression>) -> Option<DVec3> {
    values(shape).find_map(|parameter| match parameter {
        Parameter::Plane(plane) => Some(plane.normal()),
        _ => None,
    })
}

fn values(shape: Option<&Expression>) -> impl Iterator<Item = Parameter> + use<> {
    let named = match shape {
        Some(Expression::Shape(shape)) => shape.solid().parameters(),
        _ => Vec::new(),
    };
    named.into_iter().map(|(_, parameter)| parameter)
}

#[cfg(test)]
mod tests;
