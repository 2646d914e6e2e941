//! Round a point, at one distance and one height.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use rara::Camera;

use super::super::views::{NamedView, Orbit};

impl Orbit {
    /// The camera on its way round a point, about an axis in this direction.
    pub(in super::super) fn views(
        self,
        camera: Camera,
        (pivot, axis): (DVec3, DVec3),
    ) -> Vec<NamedView> {
        let axis = axis.normalize_or(DVec3::NEG_Y);
        let closed = self.turns.fract() == 0.0;
        let places = (0..self.frames).map(|index| {
            let turn = self.turns * super::share(index, self.frames, closed);
            // Whole turns lead back to the very same place.
            let turned = DMat3::from_axis_angle(axis, TAU * turn.fract());
            camera
                .eye(pivot + turned * (camera.eye - pivot))
                .rotation(camera.rotation * turned.transpose())
        });
        super::named("orbit", places)
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
        let views = |turns, frames| Orbit { turns, frames }.views(camera, (pivot, up));
        for view in views(2.0, 24) {
            let camera = view.camera;
            let away = pivot - camera.eye;
            assert!((away.length() - 17.0_f64.sqrt()).abs() < 1e-12);
            assert!((camera.rotation * away - DVec3::Z * away.length()).length() < 1e-12);
            // Its right stays level.
            assert!(camera.rotation.row(0).dot(up).abs() < 1e-12);
        }
        assert_eq!(views(1.0, 1)[0].camera, camera);
        assert_eq!(views(3.0, 24)[8].camera, camera, "a third of three turns");
        let right = views(1.0, 4)[1].camera.eye;
        assert!((right - pivot - DVec3::new(4.0, -1.0, 0.0)).length() < 1e-12);
        let left = views(-0.25, 2)[1].camera.eye;
        assert!((left - pivot - DVec3::new(-4.0, -1.0, 0.0)).length() < 1e-12);
        assert_eq!(views(1.0, 3)[2].name, "orbit_2");
    }
}
