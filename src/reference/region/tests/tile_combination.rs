//! The side of a tile in a surface of a splat's combined record: the twin of `glsl/region/tile_combination.glsl`.
//!
//! As with the other bounds of tiles, no picture depends on how close these are. The test holds them to the pixels' own shares.

use glam::{DVec2, DVec3, Vec3};

use super::super::{HalfSpace, Side, Sight, Symmetric, UnitSurface};
use super::tile_side::{Sights, TILE_REACH, pixels, vector, within};
use crate::footprint::Gradients;
use crate::real::{Vec3 as Vector, vec3};
use rara_scene::Random;

/// A surface in the unit space, in single precision.
#[derive(Debug, Clone, Copy)]
struct Surface {
    normal: Vec3,
    offset: f32,
    diagonal: Vec3,
    across: Vec3,
}

impl Surface {
    fn bent(&self, v: Vec3) -> Vec3 {
        let (d, a) = (self.diagonal, self.across);
        Vec3::new(
            d.x * v.x + a.x * v.y + a.y * v.z,
            a.x * v.x + d.y * v.y + a.z * v.z,
            a.y * v.x + a.z * v.y + d.z * v.z,
        )
    }

    fn norm(&self) -> f32 {
        (self.diagonal.length_squared() + 2.0 * self.across.length_squared()).sqrt()
    }

    /// The same in double precision.
    fn twin(&self) -> UnitSurface<f64> {
        UnitSurface {
            half_space: HalfSpace {
                normal: double(self.normal.as_dvec3()),
                offset: f64::from(self.offset),
            },
            bend: Symmetric {
                diagonal: double(self.diagonal.as_dvec3()),
                across: double(self.across.as_dvec3()),
            },
        }
    }
}

fn double(v: DVec3) -> Vector<f64> {
    vec3(v.x, v.y, v.z)
}

/// The side of the points of a splat that count in any of a tile's pixels, as far as so many deviations.
fn surface_side(sights: &Sights, surface: &Surface, deviations: f32) -> Side {
    let reach = sights.reach();
    let [det, det_least, det_most] = reach.det;
    let Sights {
        b1, b2, low_pass, ..
    } = *sights;
    let c = b1.cross(b2);
    let (move_x, move_y) = (b2.cross(c) + low_pass * b1, c.cross(b1) + low_pass * b2);
    let delta = sights.delta * sights.scale;
    let mean = (delta.x * move_x + delta.y * move_y) / det;
    let b_most = glam::Vec2::new(b1.length(), b2.length()) + reach.b;
    let moves = glam::Vec2::new(move_x.length(), move_y.length());
    let turned = |v: glam::Vec2| glam::Vec2::new(v.y, v.x);
    let moves_reach = turned(b_most) * reach.c + c.length() * turned(reach.b) + low_pass * reach.b;
    let moved = delta.abs().dot(moves_reach)
        + (TILE_REACH * sights.scale).dot(moves + moves_reach)
        + mean.length() * (det - det_least).max(det_most - det);
    let along = c / det.sqrt();
    let turns = reach.c / det_least.sqrt()
        + c.length() * (det_least.sqrt().recip() - det_most.sqrt().recip());
    let across = low_pass * (b_most.length_squared() + low_pass) / det_least;
    let aside = moved / det_least + deviations * (turns + across.sqrt());

    let gradient = surface.normal + 2.0 * surface.bent(mean);
    let value = surface.offset + surface.normal.dot(mean) + mean.dot(surface.bent(mean));
    let plane = sights.plane_range(gradient.extend(value - gradient.dot(mean)));
    let bend = surface.bent(along);
    let away = deviations * (deviations * along.dot(bend).abs() + 2.0 * aside * bend.length())
        + surface.norm() * aside * aside;
    let most = deviations * (plane.variance[1] / det_least).sqrt() + away;
    if plane.mean[0] > most * det_most {
        Side::Visible
    } else if plane.mean[1] < -most * det_most {
        Side::Invisible
    } else {
        Side::Cutoff
    }
}

/// What a pixel's share is off by at most where a tile is on a side: the share beyond so many deviations, in three dimensions.
const REST: f64 = 1.2e-4;

#[test]
fn tiles_on_a_side_of_a_surface_have_no_pixel_on_the_other() {
    let mut random = Random::new(4);
    let mut found = [[0; 2]; 8];
    for round in 0..16_000 {
        // Deviations of 1 to 128 pixels, of splats of every shape, and leans from none to that of a splat around the eye.
        let size = 2_f32.powi(round % 8);
        let flatness = [1.0, 0.1, 1e-3, 1e-6][(round / 8 % 4) as usize];
        let shape = Vec3::new(1.0, within(&mut random, 1.0).abs(), flatness);
        let sights = Sights {
            b1: shape * vector(&mut random, size),
            b2: shape * vector(&mut random, size),
            lean: shape * vector(&mut random, size) * [0.0, 1e-3, 1e-2][(round % 3) as usize],
            delta: vector(&mut random, 3.0 * size).truncate(),
            scale: 1.0,
            low_pass: rara_scene::Training::default().low_pass,
        };
        // Surfaces that bend from hardly to within a deviation.
        let bend = 10_f32.powi(-(round / 32 % 5));
        let surface = Surface {
            normal: shape * vector(&mut random, 1.0),
            offset: within(&mut random, 4.0),
            diagonal: shape * shape * vector(&mut random, bend),
            across: vec_across(shape) * vector(&mut random, bend),
        };
        let side = surface_side(&sights, &surface, 1.01 * 4.5);
        let (twin, lean) = (surface.twin(), sights.lean.as_dvec3());
        let shares: Vec<f64> = pixels()
            .map(|pixel| {
                let pixel: DVec2 = pixel.as_dvec2();
                let b1 = sights.b1.as_dvec3() - pixel.x * lean;
                let b2 = sights.b2.as_dvec3() - pixel.y * lean;
                let delta = sights.delta.as_dvec2() + pixel;
                let gradients = Gradients {
                    b: [double(b1), double(b2)],
                    low_pass: sights.low_pass.into(),
                };
                Sight::new(gradients, delta.to_array()).share(&twin)
            })
            .collect();
        let least = shares.iter().copied().fold(1.0, f64::min);
        let most = shares.iter().copied().fold(0.0, f64::max);
        match side {
            Side::Visible => assert!(
                least > 1.0 - REST,
                "{round}: {least} {sights:?} {surface:?}"
            ),
            Side::Invisible => assert!(most < REST, "{round}: {most} {sights:?} {surface:?}"),
            _ => {}
        }
        let found = &mut found[(round % 8) as usize];
        found[0] += usize::from(least > 1.0 - REST || most < REST);
        found[1] += usize::from(side != Side::Cutoff);
    }
    // Large splats cover many tiles, so that most of those that are on a side have to be found.
    let [there, settled] = found[6];
    assert!(
        2 * settled > there,
        "{found:?}: bounds so wide are of no use"
    );
}

/// The products of an axis with each other one: xy, xz, yz.
fn vec_across(v: Vec3) -> Vec3 {
    Vec3::new(v.x * v.y, v.x * v.z, v.y * v.z)
}
