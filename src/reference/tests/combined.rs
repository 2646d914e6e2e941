//! Weights of splats that curved surfaces and combinations cut, against numerical integration of the truncated Gaussian.

use super::quadrature::PixelRays;
use super::*;
use crate::region::{Combination, Ellipsoid, RegionRest, reduced};
use glam::DVec2;
use rara_scene::clip::Expression;

/// A random surface near a splat: its text. `size` is its radius in the splat's largest deviations.
fn shape(dice: &mut Dice, one: &One, size: f64) -> String {
    let centre = Point::from(one.position).as_dvec3();
    let sigma = f64::from(one.scale.into_iter().fold(0.0, f32::max));
    let normal = dice.direction();
    let local = one.rotation.as_dquat().inverse() * normal * Point::from(one.scale).as_dvec3();
    // A point of the surface, within the splat.
    let at = centre + normal * dice.normal() * local.length();
    let radius = size * sigma;
    let middle = at - normal * radius;
    let list = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
    let not = if dice.next() < 0.5 { "!" } else { "" };
    let aside = normal.cross(dice.direction()).normalize();
    match (dice.next() * 5.0) as u32 {
        0 => format!("{not}sphere:{},{radius}", list(middle)),
        1 => {
            let radii = [1.0, dice.between(1.0, 3.0), dice.between(1.0, 3.0)].map(|r| r * radius);
            let turn = glam::DQuat::from_rotation_arc(DVec3::X, normal);
            let turn = format!("{},{},{},{}", turn.w, turn.x, turn.y, turn.z);
            format!(
                "{not}ellipsoid:{},{},{},{},{turn}",
                list(middle),
                radii[0],
                radii[1],
                radii[2]
            )
        }
        2 => {
            let ends = [middle - aside * 4.0 * radius, middle + aside * 4.0 * radius];
            format!("{not}cylinder:{},{},{radius}", list(ends[0]), list(ends[1]))
        }
        3 => {
            let ends = [middle - aside * 2.0 * radius, middle];
            format!("{not}capsule:{},{},{radius}", list(ends[0]), list(ends[1]))
        }
        _ => format!("{not}plane:{},{}", list(normal), -normal.dot(at)),
    }
}

/// A random combination of so many shapes.
fn expression(dice: &mut Dice, one: &One, size: f64, count: usize) -> Expression {
    let mut parts: Vec<String> = (0..count).map(|_| shape(dice, one, size)).collect();
    while parts.len() > 1 {
        let name = if dice.next() < 0.5 { "all" } else { "any" };
        let (a, b) = (parts.remove(0), parts.remove(0));
        parts.push(format!("{name}({a}, {b})"));
    }
    parts[0].parse().unwrap()
}

/// Errors of weights in random pixels of random splats: alpha |w - truth| over alpha, and the largest such product.
#[derive(Debug, Default)]
struct Errors {
    mean: f64,
    largest: f64,
    partial: usize,
    worst: String,
}

/// Compares `cases` pixels of splats of this size in pixels, cut by so many shapes of this size in deviations.
fn study(pixels: [f64; 2], count: usize, sizes: [f64; 2], cases: usize, steps: u32) -> Errors {
    let mut dice = Dice(77 + count as u64);
    let camera = camera(640, 480, 500.0);
    let view = ViewTransform::<f64>::new(&camera);
    let (mut errors, mut mass, mut done) = (Errors::default(), 0.0, 0);
    while done < cases {
        let size = pixels[0] * (pixels[1] / pixels[0]).powf(dice.next());
        let mut one = dice.one(1.0, 10.0);
        let largest = f64::from(one.scale.into_iter().fold(0.0, f32::max));
        let factor = size * f64::from(one.position[2]) / 500.0 / largest;
        one.scale = one.scale.map(|s| (f64::from(s) * factor) as f32);
        let scene = scene(&[one]);
        let Some(footprint) = Footprint::new(&scene, 0, &view) else {
            continue;
        };
        let radius = sizes[0] * (sizes[1] / sizes[0]).powf(dice.next());
        let expression = expression(&mut dice, &one, radius, count);
        let clip = expression.clip();
        let settings = mode(Mode::Exact);
        let Some(record) = cutoff::cutoff(&scene, 0, &footprint, &view, &clip, &settings) else {
            continue;
        };
        let [k0, k1, k2] = footprint.conic;
        let dx = dice.normal() / k0;
        let dy = (dice.normal() - k1 * dx) / k2;
        let [x, y] = footprint.screen_centre;
        let position = DVec2::new(x + dx, y + dy);
        let truth = PixelRays::parallel(&camera, &clip, position, steps).share(&scene, 0);
        if !truth.is_finite() {
            continue;
        }
        let alpha = f64::from(one.opacity) * (-0.5 * footprint.power(dx, dy)).exp();
        let error = alpha * (record.weight(dx, dy) - truth).abs();
        if error > errors.largest {
            errors.worst = format!(
                "{size:.2} px, truth {truth:.4}, found {:.4}: {expression}",
                record.weight(dx, dy)
            );
        }
        errors.largest = errors.largest.max(error);
        errors.mean += error;
        errors.partial += usize::from((0.01..0.99).contains(&truth));
        mass += alpha;
        done += 1;
    }
    errors.mean /= mass;
    errors
}

#[test]
#[ignore = "prints a table"]
fn print_errors_of_shapes() {
    for count in 1..=5 {
        for sizes in [[1.0, 3.0], [3.0, 10.0], [10.0, 100.0]] {
            for pixels in [
                [0.02, 0.2],
                [0.2, 1.0],
                [1.0, 5.0],
                [5.0, 30.0],
                [30.0, 100.0],
            ] {
                let errors = study(pixels, count, sizes, 300, 48);
                println!(
                    "{count} shapes of {sizes:?} deviations, splats of {pixels:?} px: mean {:.5} largest {:.4} partial {} {}",
                    errors.mean,
                    errors.largest,
                    errors.partial,
                    errors.worst.chars().take(60).collect::<String>()
                );
            }
        }
    }
}

/// Checks so many shapes of these sizes in pixels, by the mean and the largest error that they may have.
fn check(cases: &[(usize, [f64; 2], f64, f64)]) {
    for &(count, pixels, mean, largest) in cases {
        let errors = study(pixels, count, [3.0, 100.0], 60, 48);
        assert!(
            errors.partial > 10,
            "the test would say nothing: {errors:?}"
        );
        assert!(
            errors.mean < mean && errors.largest < largest,
            "{count}, {pixels:?} px: {errors:?}"
        );
    }
}

#[test]
fn single_shapes_keep_what_integration_finds() {
    check(&[
        (1, [0.02, 0.2], 4e-3, 0.05),
        (1, [0.2, 1.0], 3e-3, 0.04),
        (1, [1.0, 5.0], 1e-3, 0.02),
        (1, [5.0, 30.0], 4e-4, 0.01),
        (1, [30.0, 100.0], 1e-4, 2e-3),
    ]);
}

#[test]
fn combinations_keep_what_integration_finds() {
    check(&[
        (2, [0.2, 1.0], 0.012, 0.1),
        (2, [5.0, 100.0], 2e-3, 0.02),
        (3, [0.2, 1.0], 0.02, 0.12),
        (3, [5.0, 100.0], 2e-3, 0.02),
    ]);
}

#[test]
fn a_region_and_its_complement_keep_the_whole() {
    let mut dice = Dice(5);
    let camera = camera(640, 480, 500.0);
    let view = ViewTransform::<f64>::new(&camera);
    let mut partial = 0;
    for round in 0..200 {
        let one = dice.one(0.02 * 3_f64.powi(round % 5), 10.0);
        let scene = scene(&[one]);
        let Some(footprint) = Footprint::new(&scene, 0, &view) else {
            continue;
        };
        let clip = expression(&mut dice, &one, 4.0, 1 + round as usize % 4).clip();
        for mode in [mode(Mode::Exact), mode(Mode::Rara)] {
            let record = |clip: &Clip| cutoff::cutoff(&scene, 0, &footprint, &view, clip, &mode);
            let (Some(kept), Some(rest)) = (record(&clip), record(&clip.complement())) else {
                continue;
            };
            let (dx, dy) = (dice.normal() / footprint.conic[0], dice.normal());
            let (kept, rest) = (kept.weight(dx, dy), rest.weight(dx, dy));
            // The chance that three half-spaces hold at once is integrated in a few steps.
            assert!(
                (kept + rest - 1.0).abs() < 5e-4,
                "{kept} + {rest}: {clip:?}"
            );
            partial += usize::from((0.01..0.99).contains(&kept));
        }
    }
    assert!(partial > 60, "{partial}");
}

/// The rest of a region for a round splat of deviation .02, as far as 3.5 of them.
fn left(clip: &Clip, position: [f32; 3]) -> RegionRest<f64> {
    let one = One {
        position,
        scale: [0.02; 3],
        ..One::default()
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| Vec3::of(axis * 0.02));
    let ellipsoid = Ellipsoid::new(&scene(&[one]), 0, axes);
    reduced(&ellipsoid, 3.5, clip, &mode(Mode::Exact)).without_implied(3.5)
}

#[test]
fn a_surface_that_changes_nothing_beside_another_is_left_out() {
    let tube = "capsule:0,0,0,1,0,0,.5";
    let far = "sphere:0,0,-9,1";
    let nested = "sphere:0,0,0,.5, sphere:0,.001,0,.52";
    for (region, position, count) in [
        (tube.into(), [0.5, 0.5, 0.0], 1),   // the tube alone
        (tube.into(), [0.1, 0.51, 0.0], 1),  // beside the ball, which lies within the tube
        (tube.into(), [-0.1, 0.49, 0.0], 1), // the ball alone
        (tube.into(), [0.0, 0.5, 0.0], 3),   // both, and the plane between them
        (format!("any({nested})"), [0.0, 0.51, 0.0], 1),
        (format!("all({nested}, !{far})"), [0.0, 0.51, 0.0], 1),
        (
            "any(sphere:0,0,0,.5, sphere:0,.2,0,.32)".into(),
            [0.0, 0.51, 0.0],
            2,
        ),
        (
            "any(sphere:0,0,0,.5, sphere:.6,0,0,.5)".into(),
            [0.3, 0.4, 0.0],
            2,
        ),
    ] {
        let clip = region.parse::<Expression>().unwrap().clip();
        let RegionRest::Cut(surfaces) = left(&clip, position) else {
            panic!("{region} does not cut {position:?}");
        };
        assert_eq!(surfaces.len(), count, "{region} {position:?}");
        assert_eq!(
            surfaces
                .iter()
                .map(|(_, operators)| operators.len())
                .sum::<usize>(),
            count - 1
        );
        let combination = Combination(surfaces);
        let mut dice = Dice(7);
        for _ in 0..2000 {
            // Within 3.5 deviations, and not where the surfaces may be apart by their rounding and by what is left out.
            let unit = dice.direction() * 3.5 * dice.next().cbrt();
            let point = DVec3::from(position.map(f64::from)) + unit * 0.02;
            if clip
                .all_surfaces()
                .iter()
                .all(|s| s.distance(point).abs() > 1e-5)
            {
                let kept = combination.keeps(Vec3::of(unit));
                assert_eq!(kept, clip.keeps(point), "{region} {point}");
            }
        }
    }
}
