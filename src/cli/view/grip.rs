//! How the held shape is moved, turned and scaled.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec2, DVec3};
use rara::clip::Parameter;
use rara::{Camera, Placement, Projection, Shape};

use super::action::GripAction;
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
            GripAction::Go(by) => self.go(by, camera),
            GripAction::Step(steps) => self.go(0.01 * steps * radius, camera),
            GripAction::Drag(pixels) => self.drag(pixels, camera),
            GripAction::Tilt(degrees) => self.tilt(degrees, camera),
            GripAction::Scale(factor) => self.scale(factor),
        }
    }

    /// Moves the held shape along its normal, world units; one without a normal goes away from the eye.
    pub(super) fn go(&mut self, by: f64, camera: &Camera) {
        let along = normal(&self.shape()).unwrap_or(camera.rotation.row(2));
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
        let Some(along) = normal(&self.shape()) else {
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
        for parameter in values(&self.shape()) {
            match parameter {
                Parameter::Plane(_) if self.shape().as_plane().is_some() => {
                    return self.set(self.across(axis));
                }
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
fn normal(shape: &Shape) -> Option<DVec3> {
    values(shape).find_map(|parameter| match parameter {
        Parameter::Plane(plane) => Some(plane.normal()),
        _ => None,
    })
}

fn values(shape: &Shape) -> impl Iterator<Item = Parameter> {
    let named = shape.solid().parameters().into_iter();
    named.map(|(_, parameter)| parameter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rara::ClipOp;
    use rara::clip::Expression;

    const CENTRE: DVec3 = DVec3::new(1.0, 2.0, 3.0);
    const SHAPES: [&str; 8] = [
        "plane:0.6,0,0.8,-1",
        "slab:0,0.6,0.8,-3,0.75",
        "box:1,2,3,1,2,0.5,0.9,0.1,0.3,0.2",
        "sphere:1,0,3,1.5",
        "ellipsoid:1,2,2,1,2,0.5,0.5,0.5,0.1,0.2",
        "cylinder:0,1,2,1,3,4,0.75",
        "capsule:0,1,2,1,3,4,0.75",
        "cone:0,1,2,1,3,4,0.75",
    ];

    /// A clip of which a shape is held that is alone, outside, or within an expression.
    fn cuts(text: &str) -> [ClipEditor; 3] {
        let nested = format!("any(sphere:0,0,0,1, not(all({text}, plane:1,0,0,0)))");
        [text.into(), format!("!{text}"), nested].map(|typed| {
            let mut cut = ClipEditor::new(vec![typed.parse().unwrap()], ClipOp::And, CENTRE);
            if typed.starts_with("any") {
                cut.next();
            }
            cut
        })
    }

    fn plane(normal: DVec3) -> ClipEditor {
        let mut cut = ClipEditor::new(Vec::new(), ClipOp::And, CENTRE);
        cut.align(normal);
        cut
    }

    fn camera(from: DVec3) -> Camera {
        let eye = CENTRE + 5.0 * from;
        Camera::look_at(eye, CENTRE, DVec3::NEG_Y, 50.0, (800, 600)).unwrap()
    }

    fn cameras() -> [Camera; 2] {
        let camera = camera(DVec3::new(0.2, -0.1, -1.0).normalize());
        let flat = camera.projection(Projection::Orthographic);
        [camera, flat.fx(90.0).fy(90.0)]
    }

    fn pixel(camera: &Camera, point: DVec3) -> DVec2 {
        let p = camera.rotation * (point - camera.eye);
        let depth = match camera.projection {
            Projection::Orthographic => 1.0,
            _ => p.z,
        };
        DVec2::new(camera.fx, camera.fy) * p.truncate() / depth
    }

    /// The numbers of all its shapes. Quaternions of either sign are one rotation.
    fn numbers(cut: &ClipEditor) -> Vec<f64> {
        let mut numbers = Vec::new();
        for shape in cut.expressions().iter().flat_map(Expression::shapes) {
            let text = shape.to_string();
            let list = text.split_once(':').unwrap().1.split(',');
            let mut list: Vec<f64> = list.map(|v| v.parse().unwrap()).collect();
            if list.len() == 6 {
                list.extend([1.0, 0.0, 0.0, 0.0]);
            }
            if list.len() == 10 && list[6] < 0.0 {
                list[6..].iter_mut().for_each(|v| *v = -*v);
            }
            numbers.extend(list);
        }
        numbers
    }

    fn apart(a: &ClipEditor, b: &ClipEditor) -> f64 {
        let (a, b) = (numbers(a), numbers(b));
        assert_eq!(a.len(), b.len());
        a.iter()
            .zip(&b)
            .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    }

    #[test]
    fn every_shape_comes_back_from_where_it_was_moved_turned_and_scaled_to() {
        let degrees = DVec2::new(25.0, -40.0);
        let there_and_back: [[GripAction; 2]; 4] = [
            [GripAction::Go(0.7), GripAction::Go(-0.7)],
            [GripAction::Step(30.0), GripAction::Step(-30.0)],
            [GripAction::Tilt(degrees), GripAction::Tilt(-degrees)],
            [GripAction::Scale(1.7), GripAction::Scale(1.0 / 1.7)],
        ];
        for camera in cameras() {
            for text in SHAPES {
                for cut in cuts(text) {
                    for [there, back] in there_and_back {
                        let mut moved = cut.clone();
                        moved.act(there, &camera, 2.0);
                        let is_flat = text.starts_with("plane");
                        let is_round = text.starts_with("sphere");
                        let stays = matches!(there, GripAction::Scale(_)) && is_flat
                            || matches!(there, GripAction::Tilt(_)) && is_round;
                        assert_eq!(apart(&moved, &cut) < 1e-12, stays, "{text}: {there:?}");
                        moved.act(back, &camera, 2.0);
                        let off = apart(&moved, &cut);
                        assert!(off < 1e-14 * 64.0, "{text}: {there:?} and back: {off}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_dragged_shape_follows_the_mouse() {
        for camera in cameras() {
            for text in &SHAPES[2..] {
                for mut cut in cuts(text) {
                    let before = pixel(&camera, cut.middle());
                    let pixels = DVec2::new(31.0, -17.0);
                    cut.drag(pixels, &camera);
                    let by = pixel(&camera, cut.middle()) - before;
                    assert!((by - pixels).length() < 1e-9, "{text}: {by}");
                    cut.drag(-pixels, &camera);
                    let by = pixel(&camera, cut.middle()) - before;
                    assert!(by.length() < 1e-9, "{text}: {by}");
                }
            }
            // Planes and slabs go along their normals.
            for text in ["plane:1,0,0,-1", "slab:1,0,0,0,2"] {
                let [mut cut, ..] = cuts(text);
                let before = cut.middle();
                cut.drag(DVec2::new(2.0, 0.0), &camera);
                let along = pixel(&camera, cut.middle()) - pixel(&camera, before);
                assert!((along.x - 2.0).abs() < 0.1, "{text}: {along}");
                assert!((cut.middle() - before).reject_from(DVec3::X).length() < 1e-12);
            }
        }
    }

    #[test]
    fn a_plane_that_faces_the_eye_goes_away_when_dragged_up() {
        for normal in [DVec3::Z, -DVec3::Z] {
            let camera = camera(-DVec3::Z);
            let mut cut = plane(normal);
            cut.drag(DVec2::new(40.0, -10.0), &camera);
            let depth = (camera.rotation * (cut.middle() - camera.eye)).z;
            assert!((depth - 5.0 - 50.0 / camera.fy).abs() < 1e-9, "{depth}");
        }
    }

    #[test]
    fn a_shape_behind_the_eye_can_be_dragged_too() {
        for text in SHAPES {
            let mut camera = camera(-DVec3::Z);
            camera.eye += DVec3::Z * 20.0;
            let [mut cut, ..] = cuts(text);
            cut.drag(DVec2::new(5.0, 5.0), &camera);
            camera.eye = cut.middle();
            cut.drag(DVec2::new(5.0, 5.0), &camera);
            assert!(numbers(&cut).iter().all(|v| v.is_finite()), "{text}");
        }
    }

    #[test]
    fn tilting_turns_about_the_middle() {
        let camera = camera(-DVec3::Z);
        let mut cut = plane(-DVec3::Z);
        cut.go(0.5, &camera);
        let middle = cut.middle();
        let towards = |cut: &ClipEditor| normal(&cut.shape()).unwrap();
        cut.tilt(DVec2::new(30.0, 0.0), &camera);
        assert!(cut.shape().clip().surfaces[0].distance(middle).abs() < 1e-12);
        // The normal pointed at the eye; now also to the right.
        let right = DVec3::new(0.5, 0.0, -0.75_f64.sqrt());
        assert!((towards(&cut) - right).length() < 1e-12);
        cut.tilt(DVec2::new(0.0, 30.0), &camera);
        assert!(towards(&cut).y > 0.1, "down: {}", towards(&cut));
        for text in &SHAPES[2..] {
            let [mut cut, ..] = cuts(text);
            let before = cut.middle();
            cut.tilt(DVec2::new(20.0, 50.0), &camera);
            assert!(cut.middle().distance(before) < 1e-12, "{text}");
        }
    }

    #[test]
    fn shapes_align_with_axes() {
        for (text, aligned) in [
            ("box:1,2,3,1,2,0.5,0.9,0.1,0.3,0.2", "box:1,2,3,1,2,0.5"),
            ("cylinder:0,0,0,0,2,0,1", "cylinder:-1,1,0,1,1,0,1"),
            ("cone:0,0,0,0,0,2,1", "cone:-1,0,1,1,0,1,1"),
            ("plane:0,0,1,5", "plane:1,0,0,-1"),
            ("sphere:0,0,1,5", "sphere:0,0,1,5"),
        ] {
            let [mut cut, ..] = cuts(text);
            cut.align(DVec3::X);
            let [expected, ..] = cuts(aligned);
            assert!(apart(&cut, &expected) < 1e-12, "{text}: {}", cut.shape());
        }
    }
}
