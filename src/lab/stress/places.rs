//! Cameras and worlds at extreme places.

use glam::DVec3;

use super::make::{
    PLAIN, Setup, any_normal, axes, between, cases, orientation, push, set_colour, strewn,
    three_between,
};
use super::{Case, Regime};
use rara::Projection;
use rara_scene::Random;

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("camera 1e4 away, focal length 2e6 px", || {
            mixed(Setup {
                distance: 1e4,
                focal: 2e6,
                ..PLAIN
            })
        }),
        Regime::new("world at 1e4", || {
            mixed(Setup {
                centre: DVec3::new(1e4, -2.3e4, 0.7e4),
                ..PLAIN
            })
        }),
        Regime::new("world at 1e6", || {
            mixed(Setup {
                centre: DVec3::new(1e6, -2.3e6, 0.7e6),
                distance: 50.0,
                ..PLAIN
            })
        }),
        Regime::new("camera inside splats", || {
            let inside = |seed: u64| {
                cases(seed, PLAIN, &any_normal, &|r, _| {
                    PLAIN.distance * three_between(r, 0.1, 2.0)
                })
            };
            (100..106).flat_map(inside).collect()
        }),
        Regime::new("orthographic", || {
            mixed(Setup {
                projection: Projection::Orthographic,
                ..PLAIN
            })
        }),
        // Depths, which order splats, count from the eye: a hundred times as far away single precision has too few of them.
        Regime::new("orthographic, 1e3 away", || {
            mixed(Setup {
                projection: Projection::Orthographic,
                distance: 1e3,
                focal: 3e5,
                ..PLAIN
            })
        }),
        Regime::new("orthographic, splats to behind the eye", || {
            let flat = Setup {
                projection: Projection::Orthographic,
                ..PLAIN
            };
            let around = |seed: u64| {
                cases(seed, flat, &any_normal, &|r, _| {
                    PLAIN.distance * three_between(r, 0.1, 20.0)
                })
            };
            (100..103).flat_map(around).collect()
        }),
        Regime::new("straddling the near plane", || {
            let near = Setup {
                distance: 0.3,
                ..PLAIN
            };
            cases(12, near, &any_normal, &|r, _| three_between(r, 0.002, 0.3))
        }),
        Regime::new("centres to 3e3 px beside the picture", || beside(1e1)),
        Regime::new("centres to 3e4 px beside the picture", || beside(1e2)),
        Regime::new("centres to 3e6 px beside the picture", || beside(1e4)),
        Regime::new("150 degree view", || {
            mixed(Setup {
                distance: 2.0,
                focal: 128.0 / 75.0_f64.to_radians().tan(),
                ..PLAIN
            })
        }),
        Regime::new("picture 2048 px wide", || {
            let mut cases = mixed(Setup {
                focal: 2400.0,
                size: (2048, 512),
                ..PLAIN
            });
            cases.truncate(3);
            cases
        }),
    ]
}

/// Centres up to 300 px times `aside` beside the picture, and splats so large that they reach into it.
fn beside(aside: f64) -> Vec<Case> {
    let mut random = Random::new(13);
    let mut one = |index: usize| {
        let mut case = strewn(&mut random, PLAIN, &any_normal, &mix, 0, true);
        let count = if index == 0 { 60 } else { 1 };
        while case.scene.len() < count {
            let depth = random.range(0.3, 8.0);
            let aside = depth * between(&mut random, 0.5, aside);
            let turn = random.range(0.0, std::f64::consts::TAU);
            let at = DVec3::new(aside * turn.cos(), aside * turn.sin(), depth);
            let at = case.camera.eye + axes(&case.camera) * at;
            let scales = aside * three_between(&mut random, 0.3, 1.0);
            let turned = orientation(&mut random);
            push(&mut case.scene, at.as_vec3(), scales, turned, 0.7);
            set_colour(&mut case.scene, &mut random);
        }
        Case {
            apart: index > 0,
            ..case
        }
    };
    (0..25).map(&mut one).collect()
}

/// Ordinary splats, needles and pancakes.
pub(super) fn mixed(stage: Setup) -> Vec<Case> {
    cases(10, stage, &any_normal, &mix)
}

/// A splat of 0.2 to 20 px, up to a thousand times as long as thick.
pub(super) fn mix(random: &mut Random, px: f64) -> DVec3 {
    let long = px * between(random, 0.2, 20.0);
    let thin = long / between(random, 1.0, 1e3);
    let middle = if random.unit() < 0.5 { long } else { thin };
    DVec3::new(long, middle, thin)
}
