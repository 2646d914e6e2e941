use super::*;
use crate::real::{Vec3, vec3};
use crate::threshold::Direction;
use std::f64::consts::{PI, TAU};

/// A variable whose direction is that of a vector.
fn threshold(z: f64, v: [f64; 3]) -> Threshold<f64> {
    let v = vec3(v[0], v[1], v[2]);
    Threshold {
        z,
        far: v.x >= 0.0,
        direction: Direction {
            along: v.x / v.length(),
            across: [
                vec3(v.y, v.z, 0.0) * (1.0 / v.length()),
                Vec3::zero(),
                Vec3::zero(),
            ],
        },
    }
}

/// Two of them with a given correlation.
fn pair(h: f64, k: f64, rho: f64) -> f64 {
    let turned = [rho, (1.0 - rho * rho).sqrt(), 0.0];
    orthant([threshold(h, [1.0, 0.0, 0.0]), threshold(k, turned)].into_iter())
}

#[test]
fn two_variables_have_their_known_chances() {
    for rho in [
        -1.0, -0.99999, -0.95, -0.9, -0.5, 0.0, 0.3, 0.9, 0.91, 0.999, 1.0,
    ] {
        let known = 0.25 + f64::asin(rho) / TAU;
        let found = pair(0.0, 0.0, rho);
        assert!((found - known).abs() < 1e-6, "{rho}: {found}, {known}");
    }
    // The expected chance sums up h's density times the chance that k follows, in a million steps.
    for (h, k) in [
        (0.5, -0.3),
        (1.0, 1.02),
        (-1.0, 0.9),
        (2.0, -2.1),
        (3.0, 1.0),
    ] {
        for rho in [-0.999, -0.93, -0.6, 0.2, 0.85, 0.92, 0.9999] {
            let steps = 1_000_000;
            let width = (h + 8.5) / f64::from(steps);
            let chance = |i: i32| {
                let x = -h + (f64::from(i) + 0.5) * width;
                (-0.5 * x * x).exp() * ((k + rho * x) / f64::sqrt(1.0 - rho * rho)).phi()
            };
            let sum: f64 = (0..steps).map(chance).sum::<f64>() * width / TAU.sqrt();
            assert!((pair(h, k, rho) - sum).abs() < 1e-6, "{h} {k} {rho}");
        }
    }
}

#[test]
fn three_variables_are_close_to_their_known_chances() {
    // Without means the chance is 1/8 and the sum of the correlations' arcsines over 4 pi.
    let (mut worst, mut sum) = (0.0_f64, 0.0);
    for i in 0..1000 {
        let turn = |j: i32| f64::from(i * j) * 0.618_034 * TAU;
        let v = [3, 5, 7].map(|j| [turn(j).sin(), turn(j + 1).cos(), turn(j + 20).sin()]);
        let cosine = |a: usize, b: usize| {
            let of = |v: [f64; 3]| vec3(v[0], v[1], v[2]);
            of(v[a]).dot(of(v[b])) / (of(v[a]).length() * of(v[b]).length())
        };
        let angles = cosine(0, 1).asin() + cosine(0, 2).asin() + cosine(1, 2).asin();
        let known = 0.125 + angles / (4.0 * PI);
        let found = orthant(v.map(|v| threshold(0.0, v)).into_iter());
        worst = worst.max((found - known).abs());
        sum += (found - known).abs();
    }
    assert!(
        worst < 0.03 && sum / 1000.0 < 0.01,
        "{worst}, on average {}",
        sum / 1000.0
    );
}

#[test]
fn full_correlation_is_one_threshold() {
    let (far, near) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let set = [(0.7, far), (1.5, near), (0.2, far), (1.1, near), (0.2, far)];
    let share = orthant(set.map(|(z, v)| threshold(z, v)).into_iter());
    assert!((share - (0.2.phi() + 1.1.phi() - 1.0)).abs() < 1e-15);
}
