//! Smoothly through given cameras.
//!
//! Eyes, rotations and lenses each follow cubic curves whose tangents are those of a Catmull-Rom spline with centripetal knots
//! (Yuksel, Schaefer and Keyser 2011), which neither loops nor has cusps between two cameras. Rotations do so on the sphere
//! of quaternions, their curves built by de Casteljau's construction from shortest arcs. The pace along all of it is even.

use std::ops::{Add, Mul};

use glam::{DMat3, DQuat, DVec3, DVec4};
use rara::Camera;

use super::super::views::NamedView;

/// Steps between two cameras in which the way is measured.
const STEPS: usize = 64;

/// What can go from one place to another.
trait Interpolate: Copy {
    type Step: Copy + Add<Output = Self::Step> + Mul<f64, Output = Self::Step>;
    /// The shortest way to another place.
    fn way(self, to: Self) -> Self::Step;
    fn moved(self, step: Self::Step) -> Self;
    fn mix(self, to: Self, share: f64) -> Self {
        self.moved(self.way(to) * share)
    }
}

impl Interpolate for DVec3 {
    type Step = Self;
    fn way(self, to: Self) -> Self {
        to - self
    }
    fn moved(self, step: Self) -> Self {
        self + step
    }
}

impl Interpolate for DVec4 {
    type Step = Self;
    fn way(self, to: Self) -> Self {
        to - self
    }
    fn moved(self, step: Self) -> Self {
        self + step
    }
}

/// Ways are axes times angles, in the rotation's own frame.
impl Interpolate for DQuat {
    type Step = DVec3;
    fn way(self, to: Self) -> DVec3 {
        let turn = self.inverse() * to;
        // A rotation is two quaternions; this one of them turns by half a turn at most.
        let turn = if turn.w < 0.0 { -turn } else { turn };
        turn.to_scaled_axis()
    }
    fn moved(self, step: DVec3) -> Self {
        (self * Self::from_scaled_axis(step)).normalize()
    }
}

#[derive(Debug, Clone, Copy)]
struct Key {
    eye: DVec3,
    /// Camera to world.
    turn: DQuat,
    /// Logarithms of the focal lengths, and the principal point.
    lens: DVec4,
}

impl Key {
    fn from_camera(camera: &Camera) -> Self {
        Self {
            eye: camera.eye,
            turn: DQuat::from_mat3(&camera.rotation.transpose()),
            lens: DVec4::new(camera.fx.ln(), camera.fy.ln(), camera.cx, camera.cy),
        }
    }

    /// How far the eye moves, world units, and by how much it turns, radians.
    fn apart(&self, other: &Self) -> (f64, f64) {
        (
            self.eye.distance(other.eye),
            self.turn.way(other.turn).length(),
        )
    }
}

/// A way through cameras.
#[derive(Debug)]
pub(super) struct Spline {
    keys: Vec<Key>,
    /// The knots' distances, one for each piece between two keys.
    spans: Vec<f64>,
    closed: bool,
    /// The way from the begin to each step, `STEPS` a piece.
    ways: Vec<f64>,
    /// What all cameras have in common.
    camera: Camera,
}

impl Spline {
    /// The way through the cameras of these views; back to the first where it is closed.
    pub(super) fn through(views: &[NamedView], closed: bool) -> Result<Self, String> {
        let camera = views.first().map(|view| view.camera);
        let camera = camera.ok_or("--path spline has no cameras to go through")?;
        for view in views {
            if (view.camera.width, view.camera.height) != (camera.width, camera.height) {
                return Err(
                    "the cameras of --path spline have pictures of several sizes: give --size"
                        .into(),
                );
            }
            if view.camera.projection != camera.projection {
                return Err(
                    "--path spline goes through perspective cameras or through orthographic ones: choose them, as in \
                     spline:0,3,5"
                        .into(),
                );
            }
        }
        let mut keys: Vec<Key> = Vec::new();
        for view in views {
            let key = Key::from_camera(&view.camera);
            // What stands still would have no direction.
            if keys.last().is_none_or(|last| is_apart(last, &key)) {
                keys.push(key);
            }
        }
        if closed && keys.len() > 1 && !is_apart(&keys[0], &keys[keys.len() - 1]) {
            keys.pop();
        }
        if keys.len() < 2 {
            return Err(
                "--path spline needs two cameras or more that stand in different places".into(),
            );
        }
        let pieces = keys.len() - usize::from(!closed);
        let apart: Vec<_> = (0..pieces)
            .map(|piece| keys[piece].apart(&keys[(piece + 1) % keys.len()]))
            .collect();
        // Moving and turning count as much as each other, whatever the world's unit is.
        let whole = apart
            .iter()
            .fold((0.0, 0.0), |whole, one| (whole.0 + one.0, whole.1 + one.1));
        let length = |(moved, turned): (f64, f64)| {
            let part = |one: f64, whole: f64| if whole > 0.0 { one / whole } else { 0.0 };
            part(moved, whole.0).hypot(part(turned, whole.1))
        };
        let mut spline = Self {
            spans: apart.iter().map(|one| length(*one).sqrt()).collect(),
            keys,
            closed,
            ways: vec![0.0],
            camera,
        };
        let (mut way, mut last) = (0.0, spline.at(0, 0.0));
        for step in 1..=pieces * STEPS {
            let (piece, rest) = ((step - 1) / STEPS, (step - 1) % STEPS + 1);
            let next = spline.at(piece, rest as f64 / STEPS as f64);
            way += length(last.apart(&next));
            spline.ways.push(way);
            last = next;
        }
        Ok(spline)
    }

    pub(super) fn views(&self, frames: u32) -> Vec<NamedView> {
        let place = |index| self.camera_at(super::share(index, frames, self.closed));
        super::named("spline", (0..frames).map(place))
    }

    fn camera_at(&self, share: f64) -> Camera {
        let way = share * self.ways[self.ways.len() - 1];
        let last = self.ways.len() - 2;
        let step = self.ways.partition_point(|one| *one <= way);
        let step = step.saturating_sub(1).min(last);
        let (from, to) = (self.ways[step], self.ways[step + 1]);
        let part = if to > from {
            (way - from) / (to - from)
        } else {
            0.0
        };
        let at = ((step % STEPS) as f64 + part.clamp(0.0, 1.0)) / STEPS as f64;
        let Key { eye, turn, lens } = self.at(step / STEPS, at);
        self.camera
            .eye(eye)
            .rotation(DMat3::from_quat(turn).transpose())
            .fx(lens.x.exp())
            .fy(lens.y.exp())
            .cx(lens.z)
            .cy(lens.w)
    }

    /// The place at a share of the knots between two keys.
    fn at(&self, piece: usize, share: f64) -> Key {
        Key {
            eye: self.curve(piece, share, |key| key.eye),
            turn: self.curve(piece, share, |key| key.turn),
            lens: self.curve(piece, share, |key| key.lens),
        }
    }

    fn curve<T: Interpolate>(&self, piece: usize, share: f64, of: impl Fn(&Key) -> T) -> T {
        let next = (piece + 1) % self.keys.len();
        let (from, to) = (of(&self.keys[piece]), of(&self.keys[next]));
        // The ends are the cameras themselves, without rounding.
        if share <= 0.0 || share >= 1.0 {
            return if share <= 0.0 { from } else { to };
        }
        let third = self.spans[piece] / 3.0;
        let leaves = from.moved(self.pace(piece, &of) * third);
        let comes = to.moved(self.pace(next, &of) * -third);
        let (a, b, c) = (
            from.mix(leaves, share),
            leaves.mix(comes, share),
            comes.mix(to, share),
        );
        a.mix(b, share).mix(b.mix(c, share), share)
    }

    /// How fast the way passes a key.
    fn pace<T: Interpolate>(&self, key: usize, of: &impl Fn(&Key) -> T) -> T::Step {
        let count = self.keys.len();
        let pace = |piece: usize| {
            let way = of(&self.keys[piece]).way(of(&self.keys[(piece + 1) % count]));
            way * self.spans[piece].recip()
        };
        let (before, after) = match self.closed {
            true => ((key + count - 1) % count, key),
            // An open way begins and ends along its first and last piece.
            false if key == 0 => return pace(0),
            false if key == count - 1 => return pace(key - 1),
            false => (key - 1, key),
        };
        let (earlier, later) = (self.spans[before], self.spans[after]);
        (pace(before) * later + pace(after) * earlier) * (earlier + later).recip()
    }
}

/// True for two places that are not one.
fn is_apart(a: &Key, b: &Key) -> bool {
    let (moved, turned) = a.apart(b);
    moved > 1e-9 * (a.eye.length() + b.eye.length()) || turned > 1e-7
}

#[cfg(test)]
mod tests {
    use super::*;

    fn views(eyes: &[(DVec3, DVec3)]) -> Vec<NamedView> {
        let cameras = eyes.iter().enumerate().map(|(number, (eye, target))| {
            let fov_y = 40.0 + 5.0 * number as f64;
            Camera::look_at(*eye, *target, DVec3::NEG_Y, fov_y, (64, 48)).unwrap()
        });
        super::super::named("key", cameras)
    }

    /// Places that are far apart, close together, and turned by nearly half a turn.
    fn uneven() -> Vec<NamedView> {
        let at = DVec3::new;
        views(&[
            (at(0.0, 0.0, -4.0), DVec3::ZERO),
            (at(3.0, -1.0, -3.0), DVec3::ZERO),
            (at(3.1, -1.0, -2.9), DVec3::ZERO),
            (at(9.0, 2.0, 5.0), at(9.0, 2.0, 50.0)),
            (at(-4.0, 0.5, 3.0), at(-4.0, 1.0, -50.0)),
        ])
    }

    fn difference(a: &Camera, b: &Camera) -> f64 {
        let turned = (a.rotation.transpose() - b.rotation.transpose()).to_cols_array();
        let turned = turned.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
        turned
            .max(a.eye.distance(b.eye))
            .max((a.fx / b.fx - 1.0).abs())
    }

    #[test]
    fn the_way_passes_every_camera_and_begins_and_ends_with_one() {
        for closed in [false, true] {
            let keys = uneven();
            let spline = Spline::through(&keys, closed).unwrap();
            let whole = spline.ways[spline.ways.len() - 1];
            for (number, key) in keys.iter().enumerate() {
                let passed = spline.camera_at(spline.ways[number * STEPS] / whole);
                assert!(difference(&passed, &key.camera) < 1e-12, "{number}");
            }
            let made = spline.views(9);
            assert!(difference(&made[0].camera, &keys[0].camera) < 1e-15);
            if !closed {
                assert!(difference(&made[8].camera, &keys[4].camera) < 1e-15);
            }
        }
    }

    #[test]
    fn the_pace_is_even_and_nothing_jumps() {
        for closed in [false, true] {
            let spline = Spline::through(&uneven(), closed).unwrap();
            let made = spline.views(2000);
            let apart: Vec<(f64, f64)> = made
                .windows(2)
                .map(|two| {
                    Key::from_camera(&two[0].camera).apart(&Key::from_camera(&two[1].camera))
                })
                .collect();
            let whole = apart
                .iter()
                .fold((0.0, 0.0), |whole, one| (whole.0 + one.0, whole.1 + one.1));
            // The chords' share of the whole, by which the spline weighs, is near that of the curves.
            let paces: Vec<f64> = apart
                .iter()
                .map(|one| (one.0 / whole.0).hypot(one.1 / whole.1) * 2000.0)
                .collect();
            let (least, most) = paces.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), one| {
                (a.min(*one), b.max(*one))
            });
            assert!(least > 0.6 && most < 1.8, "{least} to {most}");
            for two in paces.windows(2) {
                assert!((two[0] - two[1]).abs() < 0.2, "{two:?}");
            }
        }
    }

    #[test]
    fn cameras_on_a_circle_stay_near_it() {
        let eyes: Vec<_> = (0..8)
            .map(|number| {
                let turn = f64::from(number) / 8.0 * std::f64::consts::TAU;
                (DVec3::new(turn.sin(), 0.0, -turn.cos()) * 4.0, DVec3::ZERO)
            })
            .collect();
        let spline = Spline::through(&views(&eyes), true).unwrap();
        for view in spline.views(100) {
            let camera = view.camera;
            assert!((camera.eye.length() - 4.0).abs() < 0.04, "{}", camera.eye);
            let looks = camera.rotation * -camera.eye / camera.eye.length();
            assert!(looks.z > 0.9999, "{looks}");
        }
    }

    #[test]
    fn cameras_that_make_no_way_are_refused() {
        let one = &uneven()[..1];
        let twice = [one[0].clone(), one[0].clone()];
        for none in [&[][..], one, &twice] {
            assert!(Spline::through(none, false).is_err());
            assert!(Spline::through(none, true).is_err());
        }
        let mut sizes = uneven();
        sizes[1].camera.width = 65;
        assert!(
            Spline::through(&sizes, false)
                .unwrap_err()
                .contains("--size")
        );
        // A camera that stands twice is passed once.
        let mut still = uneven();
        still.insert(1, still[0].clone());
        assert_eq!(Spline::through(&still, true).unwrap().keys.len(), 5);
    }
}
