//! Splats of extreme shape and size.

use glam::DVec3;

use super::make::{PLAIN, Setup, any_normal, between, cases, three_between};
use super::{Case, Regime};
use rara_scene::Random;

/// The cut of a splat whose eye is inside is as sharp as a pixel only where the line of sight runs along the plane.
const WIDE: &str = "splats of 1e7 px: 24 bits place a cut that runs along the line of sight to a thousandth of a pixel";

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("ordinary splats", || {
            cases(1, PLAIN, &any_normal, &|r, px| {
                px * three_between(r, 0.2, 20.0)
            })
        }),
        Regime::new("needles, aspect 1e2", || needles(1e2)),
        Regime::new("needles, aspect 1e3", || needles(1e3)),
        Regime::new("needles, aspect 1e4", || needles(1e4)),
        Regime::new("needles, aspect 1e5", || needles(1e5)),
        Regime::new("needles, aspect 1e6", || needles(1e6)),
        Regime::new("pancakes, aspect 1e3", || pancakes(1e3)),
        Regime::new("pancakes, aspect 1e4", || pancakes(1e4)),
        Regime::new("pancakes, aspect 1e5", || pancakes(1e5)),
        Regime::new("pancakes, aspect 1e6", || pancakes(1e6)),
        Regime::new("long ones in a large picture", || large(1e3, false)),
        Regime::new("flat ones in a large picture", || large(1e3, true)),
        Regime::new("sigma 1e-7", || sigma(1e-7)),
        Regime::new("sigma 1e-5", || sigma(1e-5)),
        Regime::new("sigma 1e-3", || sigma(1e-3)),
        Regime::new("sigma 1e1", || sigma(1e1)),
        Regime::new("sigma 1e3", || sigma(1e3)),
        Regime::new("sigma 1e5", || sigma(1e5)).limited(2e-3, 60.0, WIDE),
        Regime::new("sigma 1e5 seen whole", || {
            let far = Setup {
                distance: 1e6,
                ..PLAIN
            };
            cases(30, far, &any_normal, &|r, _| spread(r, 1e5))
        }),
        Regime::new("one scale zero", || zeros([true, false, false])),
        Regime::new("two scales zero", || zeros([true, true, false])),
        Regime::new("three scales zero", || zeros([true, true, true])),
    ]
}

/// Needles up to a picture long, three deviations on either side.
fn needles(aspect: f64) -> Vec<Case> {
    cases(2, PLAIN, &any_normal, &|r, px| {
        let long = px * between(r, 0.5, 60.0);
        DVec3::new(long, long / aspect, long / aspect * between(r, 0.5, 1.0))
    })
}

fn pancakes(aspect: f64) -> Vec<Case> {
    cases(3, PLAIN, &any_normal, &|r, px| {
        let long = px * between(r, 0.5, 40.0);
        DVec3::new(long, long * between(r, 0.2, 1.0), long / aspect)
    })
}

/// Splats that are hundreds of pixels long, and thinner than one.
fn large(aspect: f64, flat: bool) -> Vec<Case> {
    let stage = Setup {
        focal: 1200.0,
        size: (1024, 768),
        ..PLAIN
    };
    cases(31, stage, &any_normal, &|r, px| {
        let long = px * between(r, 20.0, 250.0);
        let thin = long / aspect;
        let middle = if flat {
            long * between(r, 0.3, 1.0)
        } else {
            thin
        };
        DVec3::new(long, middle, thin)
    })
}

/// Splats of a size in the world, whatever that is in pixels.
fn sigma(size: f64) -> Vec<Case> {
    cases(4, PLAIN, &any_normal, &|r, _| spread(r, size))
}

fn spread(random: &mut Random, size: f64) -> DVec3 {
    size * three_between(random, 0.1, 1.0)
}

fn zeros(zero: [bool; 3]) -> Vec<Case> {
    cases(5, PLAIN, &any_normal, &|r, px| {
        DVec3::from_array(zero.map(|zero| {
            if zero {
                0.0
            } else {
                px * between(r, 0.5, 20.0)
            }
        }))
    })
}
