//! Smoothly through given cameras.
//!
//! Eyes, rotations and lenses each follow cubic curves whose tangents are those of a Catmull-Rom spline with centripetal knots
//! (Yuksel, Schaefer and Keyser 2011), which neither loops nor has cusps between two cameras. Rotations do so on the sphere
//! of quaternions, their curves built by de Casteljau's construction from shortest arcs. The pace along all of it is even.

use std::ops::{Add, Mul};

use glam::{DMat3, DQuat, DVec3, DVec4};
use rara::{Camera, Error, Result};

use super::ease::Ease;

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

/// A smooth path through cameras.
#[derive(Debug)]
pub struct Spline {
    keys: Vec<Key>,
    /// The knots' distances, one for each piece between two keys.
    spans: Vec<f64>,
    closed: bool,
    /// The way from the begin to each step, `STEPS` a piece.
    ways: Vec<f64>,
    /// What all cameras have in common.
    camera: Camera,
    ease: Ease,
}

impl Spline {
    /// Makes the path through these cameras. A closed path returns to the first camera.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the cameras have pictures of several sizes, if some are perspective and some orthographic, or if
    /// fewer than two stand in different places.
    pub fn through(cameras: &[Camera], closed: bool) -> Result<Self> {
        let refused = |what: &str| Err(Error::Invalid(what.into()));
        let Some(&camera) = cameras.first() else {
            return refused("there are no cameras to go through");
        };
        let size = |camera: &Camera| (camera.width, camera.height);
        if cameras.iter().any(|one| size(one) != size(&camera)) {
            return refused("the cameras have pictures of several sizes");
        }
        if cameras
            .iter()
            .any(|one| one.projection != camera.projection)
        {
            return refused("some cameras are perspective and others orthographic");
        }
        let mut keys: Vec<Key> = Vec::new();
        for camera in cameras {
            let key = Key::from_camera(camera);
            // What stands still would have no direction.
            if keys.last().is_none_or(|last| is_apart(last, &key)) {
                keys.push(key);
            }
        }
        if closed && keys.len() > 1 && !is_apart(&keys[0], &keys[keys.len() - 1]) {
            keys.pop();
        }
        if keys.len() < 2 {
            return refused("two cameras or more have to stand in different places");
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
            ease: Ease::None,
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

    /// Returns the same path at another pace.
    pub fn ease(self, ease: Ease) -> Self {
        Self { ease, ..self }
    }

    /// Returns this many cameras along the path, at an even pace if no other was given. A closed path ends one picture before
    /// its beginning.
    pub fn cameras(&self, frames: u32) -> Vec<Camera> {
        let share = |index| self.ease.way(super::share(index, frames, self.closed));
        let place = |index| self.camera_at(share(index));
        (0..frames).map(place).collect()
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

/// Returns true for two places that differ.
fn is_apart(a: &Key, b: &Key) -> bool {
    let (moved, turned) = a.apart(b);
    moved > 1e-9 * (a.eye.length() + b.eye.length()) || turned > 1e-7
}

#[cfg(test)]
mod tests;
