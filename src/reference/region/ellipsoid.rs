//! What surfaces are asked about.

use glam::DVec3;

use crate::real::Vec3;
use rara_scene::Gaussians;

/// A Gaussian as surfaces see it.
#[derive(Debug, Clone, Copy)]
pub struct Ellipsoid<T> {
    /// Its centre, the layer's units.
    pub(super) centre: DVec3,
    /// Its half axes of one standard deviation, the layer's units.
    pub(super) axes: [Vec3<T>; 3],
}

impl<T> Ellipsoid<T> {
    /// Gaussian `index` of a scene, which has the half axes `axes`.
    pub fn new(scene: &Gaussians, index: usize, axes: [Vec3<T>; 3]) -> Self {
        let centre = scene.positions()[index].as_dvec3();
        Self { centre, axes }
    }
}
