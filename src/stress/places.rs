//! Cameras and worlds at extreme places.

use glam::DVec3;

use super::make::{PLAIN, Stage, any_normal, between, cases};
use super::{Case, Regime};
use crate::scene::Random;

pub(super) fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("camera 1e4 away, focal length 2e6 px", || {
            mixed(Stage {
                distance: 1e4,
                focal: 2e6,
                ..PLAIN
            })
        }),
        Regime::new("world at 1e4", || {
            mixed(Stage {
                centre: DVec3::new(1e4, -2.3e4, 0.7e4),
                ..PLAIN
            })
        }),
        Regime::new("world at 1e6", || {
            mixed(Stage {
                centre: DVec3::new(1e6, -2.3e6, 0.7e6),
                distance: 50.0,
                ..PLAIN
            })
        }),
        Regime::new("camera inside splats", || {
            cases(11, PLAIN, &any_normal, &|r, _| {
                DVec3::from_array([(); 3].map(|()| PLAIN.distance * between(r, 0.1, 2.0)))
            })
        }),
        Regime::new("straddling the near plane", || {
            let near = Stage {
                distance: 0.3,
                ..PLAIN
            };
            cases(12, near, &any_normal, &|r, _| {
                DVec3::from_array([(); 3].map(|()| between(r, 0.002, 0.3)))
            })
        }),
        Regime::new("150 degree view", || {
            mixed(Stage {
                distance: 2.0,
                focal: 128.0 / 75.0_f64.to_radians().tan(),
                ..PLAIN
            })
        }),
        Regime::new("picture 2048 px wide", || {
            let mut cases = mixed(Stage {
                focal: 2400.0,
                size: (2048, 512),
                ..PLAIN
            });
            cases.truncate(3);
            cases
        }),
    ]
}

/// Ordinary splats, needles and pancakes.
pub(super) fn mixed(stage: Stage) -> Vec<Case> {
    cases(10, stage, &any_normal, &mix)
}

/// A splat of 0.2 to 20 px, up to a thousand times as long as thick.
pub(super) fn mix(random: &mut Random, px: f64) -> DVec3 {
    let long = px * between(random, 0.2, 20.0);
    let thin = long / between(random, 1.0, 1e3);
    let middle = if random.unit() < 0.5 { long } else { thin };
    DVec3::new(long, middle, thin)
}
