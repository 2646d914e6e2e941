//! Round a point, at one distance and one height.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use rara::Camera;

use super::ease::Ease;
use super::lens::UP;

/// An orbit: a number of cameras on a circle around a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    turns: f64,
    frames: u32,
    ease: Ease,
}

impl Orbit {
    /// Makes an orbit of this many turns and pictures. The camera moves to the right, or to the left if `turns` is below zero.
    pub fn new(turns: f64, frames: u32) -> Self {
        let ease = Ease::None;
        Self {
            turns,
            frames,
            ease,
        }
    }

    /// Returns the same orbit at another pace.
    pub fn ease(self, ease: Ease) -> Self {
        Self { ease, ..self }
    }

    /// Returns the number of pictures.
    pub fn frames(self) -> u32 {
        self.frames
    }

    /// Returns the cameras of the orbit: `camera` turned around the point `pivot`, about an axis in this direction (-y if it
    /// has no length). An orbit of whole turns is closed: the picture after the last one would be the first one.
    pub fn cameras(self, camera: Camera, (pivot, axis): (DVec3, DVec3)) -> Vec<Camera> {
        let axis = axis.normalize_or(UP);
        let closed = self.turns.fract() == 0.0;
        let places = (0..self.frames).map(|index| {
            let way = self.ease.way(super::share(index, self.frames, closed));
            let turn = self.turns * way;
            // Whole turns lead back to the very same place.
            let turned = DMat3::from_axis_angle(axis, TAU * turn.fract());
            camera
                .eye(pivot + turned * (camera.eye - pivot))
                .rotation(camera.rotation * turned.transpose())
        });
        places.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_looks_at_its_middle_from_one_distance_and_closes() {
        let (pivot, up) = (DVec3::new(1.0, -2.0, 3.0), DVec3::new(0.0, -3.0, 0.0));
        let eye = pivot + DVec3::new(0.0, -1.0, -4.0);
        let camera = Camera::look_at(eye, pivot, up, 50.0, (64, 48)).unwrap();
        let cameras = |turns, frames| Orbit::new(turns, frames).cameras(camera, (pivot, up));
        for camera in cameras(2.0, 24) {
            let away = pivot - camera.eye;
            assert!((away.length() - 17.0_f64.sqrt()).abs() < 1e-12);
            assert!((camera.rotation * away - DVec3::Z * away.length()).length() < 1e-12);
            // Its right stays level.
            assert!(camera.rotation.row(0).dot(up).abs() < 1e-12);
        }
        assert_eq!(cameras(1.0, 1)[0], camera);
        assert_eq!(cameras(3.0, 24)[8], camera, "a third of three turns");
        let right = cameras(1.0, 4)[1].eye;
        assert!((right - pivot - DVec3::new(4.0, -1.0, 0.0)).length() < 1e-12);
        let left = cameras(-0.25, 2)[1].eye;
        assert!((left - pivot - DVec3::new(-4.0, -1.0, 0.0)).length() < 1e-12);
    }
}
