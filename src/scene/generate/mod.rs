//! Synthetic scenes of the three kinds that clipping is about: surfaces, strands and layered volumes.
//!
//! They serve where no real scene is at hand: tests, measurements, a first look. Each is the same for the same seed;
//! all lie in about the unit ball round the origin, with y down.

mod general;
mod layers;
mod random;
mod spherical;
mod strands;

use glam::{DMat3, DQuat, DVec3, Vec3};

#[doc(hidden)]
pub use self::random::Random;
use super::gaussians::MAX_SH_DEGREE;
use super::{Gaussians, sh_coefficients};
use rara_base::named;

named! {
    /// The kind of scene to generate.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Kind {
        /// Objects made of flat splats on surfaces, with the statistics of a trained scene; degree 3.
        General = "general",
        /// Hair: needles 20 times as long as thick, thinner than a pixel; degree 3.
        Strands = "strands",
        /// Anatomy: filled shells inside each other, so that a cut shows rings; degree 0.
        Layers = "layers",
    }
}

/// Generates a scene of exactly `count` Gaussians, which depends only on the arguments. Splats of surfaces and volumes get
/// smaller as `count` grows, so that coverage stays the same; hair gets denser.
pub fn generate(kind: Kind, count: usize, seed: u64) -> Gaussians {
    let random = Random::new(seed);
    match kind {
        Kind::General => general::generate(count, random),
        Kind::Strands => strands::generate(count, random),
        Kind::Layers => layers::generate(count, random),
    }
}

/// One Gaussian in the units it is thought in.
struct Draft {
    position: DVec3,
    /// Orthonormal and right-handed: the Gaussian's own axes in the world.
    axes: DMat3,
    scales: DVec3,
    opacity: f64,
}

/// Collects splats.
struct Builder(Gaussians);

impl Builder {
    fn new(count: usize, sh_degree: u32) -> Self {
        Self(Gaussians::with_room(count, sh_degree).expect("memory for a scene"))
    }

    /// `colours` are the coefficients in order; missing ones are zero.
    fn push(&mut self, splat: &Draft, colours: &[DVec3]) {
        let rotation = DQuat::from_mat3(&splat.axes).normalize();
        let mut sh = [Vec3::ZERO; sh_coefficients(MAX_SH_DEGREE)];
        for (to, colour) in sh.iter_mut().zip(colours) {
            *to = colour.as_vec3();
        }
        self.0.push(
            splat.position.as_vec3(),
            splat.scales.as_vec3(),
            rotation.as_quat().normalize(),
            splat.opacity as f32,
            bytemuck::cast_slice(&sh[..self.0.sh_coefficients()]),
        );
    }
}

/// Axes whose third is `normal`, turned about it by `angle`.
fn axes_about(normal: DVec3, angle: f64) -> DMat3 {
    let (u, v) = normal.any_orthonormal_pair();
    let x = angle.cos() * u + angle.sin() * v;
    DMat3::from_cols(x, normal.cross(x), normal)
}

/// Splits `count` in proportion to `weights`, exactly.
fn split<const N: usize>(count: usize, weights: [f64; N]) -> [usize; N] {
    let total: f64 = weights.iter().sum();
    let mut before = 0.0;
    let mut given = 0;
    weights.map(|weight| {
        before += weight;
        // The last end is `count`, but for rounding.
        let end = (count as f64 * (before / total)).round() as usize;
        let part = end.clamp(given, count) - given;
        given += part;
        part
    })
}

/// A smooth pattern between -1 and 1: three waves across each other, about `frequency` periods a unit.
fn pattern(p: DVec3, frequency: f64) -> f64 {
    let p = p * (frequency * std::f64::consts::TAU);
    let a = (p.x + 0.7 * (0.9 * p.y).sin()).sin();
    let b = (0.8 * p.y + 0.9 * (0.7 * p.z).sin() + 1.3).sin();
    let c = (0.9 * p.z + 0.8 * (1.1 * p.x).sin() + 2.1).sin();
    (a * b + b * c + c * a) / 3.0
}

#[cfg(test)]
mod tests;
