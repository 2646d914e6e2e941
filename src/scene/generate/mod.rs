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

/// The kind of scene to generate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Kind {
    /// Objects made of flat splats on surfaces, with the statistics of a trained scene; degree 3.
    General,
    /// Hair: needles 20 times as long as thick, thinner than a pixel; degree 3.
    Strands,
    /// Anatomy: filled shells inside each other, so that a cut shows rings; degree 0.
    Layers,
}

/// A scene of exactly `count` Gaussians, which depends on nothing but the arguments. Splats of surfaces and volumes
/// get smaller as `count` grows, so that coverage stays the same; hair gets denser.
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
mod tests {
    use super::*;

    const KINDS: [Kind; 3] = [Kind::General, Kind::Strands, Kind::Layers];

    #[test]
    fn the_count_is_exact_and_everything_is_sound() {
        for kind in KINDS {
            for count in [0, 1, 2, 5, 23, 25, 1000] {
                let scene = generate(kind, count, 7);
                assert_eq!(scene.len(), count, "{kind:?}");
                assert_eq!(scene.sh().len(), 3 * count * scene.sh_coefficients());
                assert!(scene.positions().iter().all(|p| p.length() < 1.1));
                assert!(
                    scene
                        .scales()
                        .iter()
                        .all(|s| s.is_finite() && s.min_element() > 0.0)
                );
                assert!(
                    scene
                        .rotations()
                        .iter()
                        .all(|q| (q.length() - 1.0).abs() < 1e-5)
                );
                assert!(scene.opacities().iter().all(|o| *o > 0.0 && *o <= 1.0));
                assert!(scene.sh().iter().all(|v| v.is_finite() && v.abs() < 3.0));
            }
        }
    }

    #[test]
    fn the_seed_decides() {
        for kind in KINDS {
            assert_eq!(generate(kind, 500, 1), generate(kind, 500, 1));
            assert_ne!(
                generate(kind, 500, 1).positions(),
                generate(kind, 500, 2).positions()
            );
        }
    }

    #[test]
    fn hair_is_made_of_thin_needles() {
        let hair = generate(Kind::Strands, 2400, 3);
        // A pixel at 1024^2, 60 degrees, distance 2.6.
        let pixel = 2.0 * 2.6 * 30_f32.to_radians().tan() / 1024.0;
        for scale in hair.scales() {
            assert!((scale.max_element() / scale.min_element() - 20.0).abs() < 0.1);
            assert!(scale.min_element() < pixel);
        }
    }

    #[test]
    fn splats_shrink_with_their_number() {
        let median = |kind, count| {
            let mut sizes: Vec<_> = generate(kind, count, 1)
                .scales()
                .iter()
                .map(|s| s.max_element())
                .collect();
            sizes.sort_by(f32::total_cmp);
            sizes[count / 2]
        };
        let surfaces = median(Kind::General, 1000) / median(Kind::General, 100_000);
        assert!((7.0..14.0).contains(&surfaces), "{surfaces}");
        let volumes = median(Kind::Layers, 1000) / median(Kind::Layers, 64_000);
        assert!((3.0..5.0).contains(&volumes), "{volumes}");
    }

    #[test]
    fn splitting_loses_none() {
        assert_eq!(split(10, [1.0, 1.0]), [5, 5]);
        assert_eq!(split(7, [0.1, 0.0, 3.0, 0.1]).iter().sum::<usize>(), 7);
        assert_eq!(split(0, [1.0, 2.0]), [0, 0]);
    }
}
