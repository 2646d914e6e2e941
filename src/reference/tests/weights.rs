//! Weights of mode `rara` against the paper's own quadratic, and the classes.

use super::*;
use glam::DMat3;
use rara_scene::settings::{ExactForm, Miss, Settings};

/// The paper's Algorithm 1 as it stands, for one plane, in f64: intersect, compare, divide. Nothing where there are not
/// two intersections in front of the eye.
fn quadratic(
    one: &One,
    plane: &Plane,
    camera: &Camera,
    pixel: [f64; 2],
    sigma: f64,
) -> Option<f64> {
    let direction = DVec3::new(
        (pixel[0] - camera.cx) / camera.fx,
        (pixel[1] - camera.cy) / camera.fy,
        1.0,
    )
    .normalize();
    let inverse = DMat3::from_diagonal(1.0 / Point::from(one.scale).as_dvec3())
        * DMat3::from_quat(one.rotation.as_dquat()).transpose();
    let start = inverse * -Point::from(one.position).as_dvec3();
    let step = inverse * direction;
    let (a, b, c) = (
        step.length_squared(),
        2.0 * start.dot(step),
        start.length_squared() - sigma * sigma,
    );
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 {
        return None;
    }
    let [t1, t2] = [-1.0, 1.0].map(|sign| (-b + sign * discriminant.sqrt()) / (2.0 * a));
    let t1 = t1.max(0.0);
    if t2 <= t1 {
        return None;
    }
    let crossing = (-plane.offset() / plane.normal().dot(direction)).clamp(t1, t2);
    let middles = [(t1, crossing), (crossing, t2)]
        .map(|(from, to)| (to - from, direction * (0.5 * (from + to))));
    let visible = middles
        .iter()
        .filter(|(_, point)| plane.distance(*point) >= 0.0)
        .map(|(length, _)| length);
    Some(visible.sum::<f64>() / (t2 - t1))
}

fn traced(miss: Miss, sigma: f32) -> Settings {
    mode(Mode::Rara).miss(miss).sigma(sigma).trace_all(true)
}

#[test]
fn the_chord_is_the_papers_quadratic() {
    let mut dice = Dice(31);
    let camera = camera(64, 64, 100.0);
    let (mut hits, mut partial) = (0, 0);
    for i in 0..3000 {
        let one = dice.one([0.05, 0.3, 1.5][i % 3], 5.0);
        let cutter = plane_through(&one, dice.direction(), dice.between(-2.0, 2.0));
        let sigma = [1.0, 2.0, 3.0][i % 3];
        let scene = scene(&[one]);
        let Some(footprint) = Footprint::<f64>::new(&scene, 0, &ViewTransform::new(&camera)) else {
            continue;
        };
        let pixel = [dice.between(0.0, 64.0), dice.between(0.0, 64.0)];
        let (dx, dy) = (
            pixel[0] - footprint.screen_centre[0],
            pixel[1] - footprint.screen_centre[1],
        );
        let cut = |miss| {
            cut(
                &scene,
                &camera,
                &clip(ClipOp::And, &[cutter]),
                &traced(miss, sigma as f32),
            )
            .unwrap()
        };
        let w = cut(Miss::Peak).weight(dx, dy);
        match quadratic(&one, &cutter, &camera, pixel, sigma) {
            Some(expected) => {
                assert!(
                    (w - expected).abs() < 1e-5,
                    "{one:?} {pixel:?}: {w} is not {expected}"
                );
                hits += 1;
                partial += usize::from(expected > 0.01 && expected < 0.99);
            }
            None => {
                assert!(w == 0.0 || w == 1.0);
                assert_eq!(cut(Miss::Keep).weight(dx, dy), 1.0);
                assert_eq!(cut(Miss::Drop).weight(dx, dy), 0.0);
            }
        }
    }
    assert!(
        hits > 500 && partial > 100,
        "the test would say nothing: {hits} {partial}"
    );
}

#[test]
fn a_miss_takes_the_side_of_the_rays_densest_point() {
    // A round splat on the axis, a plane x >= 0 through it: rays that miss pass its centre on one side or the other.
    let one = One {
        scale: [0.1; 3],
        ..One::default()
    };
    let camera = camera(64, 64, 100.0);
    let right = plane([1.0, 0.0, 0.0], 0.0);
    let weight = |op, planes: &[Plane], dx| {
        cut(
            &scene(&[one]),
            &camera,
            &clip(op, planes),
            &traced(Miss::Peak, 1.0),
        )
        .unwrap()
        .weight(dx, 0.0)
    };
    assert_eq!(weight(ClipOp::And, &[right], 5.0), 1.0);
    assert_eq!(weight(ClipOp::And, &[right], -5.0), 0.0);
    let planes = [right, opposite(&right)];
    assert_eq!(weight(ClipOp::And, &planes, 5.0), 0.0);
    assert_eq!(weight(ClipOp::Or, &planes, 5.0), 1.0);
    // And of rays that hit, opposed planes keep nothing or everything.
    assert!(weight(ClipOp::And, &planes, 0.5) < 1e-12);
    assert_eq!(weight(ClipOp::Or, &planes, 0.5), 1.0);
}

#[test]
fn flat_and_needle_splats_have_weights() {
    let camera = camera(64, 64, 100.0);
    let cutter = plane([0.6, 0.0, 0.8], -3.2); // through the centre
    for scale in [[0.1, 0.1, 0.0], [0.0, 0.1, 0.1], [0.1, 0.0, 0.0], [0.0; 3]] {
        let one = One {
            scale,
            ..One::default()
        };
        for settings in [traced(Miss::Peak, 3.0), mode(Mode::Exact).trace_all(true)] {
            let cut = cut(
                &scene(&[one]),
                &camera,
                &clip(ClipOp::And, &[cutter]),
                &settings,
            )
            .unwrap();
            for (dx, dy) in [(0.0, 0.0), (1.0, 0.5), (-1.0, -0.5), (30.0, 0.0)] {
                let w = cut.weight(dx, dy);
                assert!((0.0..=1.0).contains(&w), "{scale:?} {settings:?}: {w}");
            }
        }
    }
}

/// The class of a splat of half extent K sigma along z, K^2 = 2 ln(255 opacity), by two planes across the view.
fn class(op: ClipOp, deviations: &[f64], settings: &Settings) -> Side {
    let one = One {
        scale: [0.5, 0.5, 0.1],
        opacity: 1.0,
        ..One::default()
    };
    let planes: Vec<_> = deviations
        .iter()
        .map(|d| plane([0.0, 0.0, 2.0], 2.0 * (f64::from(0.1_f32) * d - 4.0)))
        .collect();
    let view = ViewTransform::<f64>::new(&camera(64, 64, 100.0));
    classify::classify(&scene(&[one]), &view, &clip(op, &planes), settings)[0]
}

#[test]
fn classes_follow_the_splats_extent_along_the_normal() {
    use ClipOp::{And, Or};
    use Side::{Cutoff, Invisible, Visible};
    let exact = mode(Mode::Exact);
    let affine = exact.form(ExactForm::Affine);
    let reach = (2.0 * 255.0_f64.ln()).sqrt();
    // True rays: a deviation is a fortieth of the depth.
    let wider = reach / (1.0 - reach * f64::from(0.1_f32) / 4.0);
    for (settings, reach) in [(affine, reach), (exact, wider)] {
        for (deviations, expected) in [
            (reach + 1e-6, Visible),
            (reach - 1e-6, Cutoff),
            (-reach + 1e-6, Cutoff),
            (-reach - 1e-6, Invisible),
        ] {
            assert_eq!(class(And, &[deviations], &settings), expected);
            assert_eq!(class(Or, &[deviations], &settings), expected);
        }
    }
    for (op, deviations, expected) in [
        (And, [9.0, 9.0], Visible),
        (And, [9.0, 0.0], Cutoff),
        (And, [0.0, -9.0], Invisible),
        (Or, [9.0, 0.0], Visible),
        (Or, [0.0, -9.0], Cutoff),
        (Or, [-9.0, -9.0], Invisible),
    ] {
        assert_eq!(
            class(op, &deviations, &exact),
            expected,
            "{op:?} {deviations:?}"
        );
    }
    // A traced ellipsoid larger than the footprint widens the band, a smaller one does not narrow it.
    let rara = |sigma| mode(Mode::Rara).sigma(sigma);
    assert_eq!(class(And, &[4.0], &rara(5.0)), Cutoff);
    assert_eq!(class(And, &[4.0], &rara(1.0)), Visible);
    assert_eq!(class(And, &[3.0], &rara(1.0)), Cutoff);
    // By the centre only, or not at all.
    assert_eq!(class(And, &[0.1, -0.1], &mode(Mode::Hard)), Invisible);
    assert_eq!(class(Or, &[0.1, -0.1], &mode(Mode::Hard)), Visible);
    assert_eq!(class(And, &[-9.0], &mode(Mode::None)), Visible);
    assert_eq!(class(And, &[9.0], &exact.trace_all(true)), Cutoff);
    assert_eq!(class(And, &[], &exact.trace_all(true)), Visible);
}

#[test]
fn the_plane_distance_holds_far_from_the_origin() {
    // A splat at a million units, in steps of 1/16: the plane passes it at half a deviation.
    let offset = DVec3::new(1e6, -1e6, 1e6);
    let one = One {
        position: [1e6, -1e6, 1e6 + 4.0],
        scale: [0.125; 3],
        ..One::default()
    };
    let camera = camera(64, 64, 100.0).eye(offset);
    let cutter = plane([0.0, 0.0, 1.0], -(1e6 + 4.0) + 0.0625);
    let view = ViewTransform::<f32>::new(&camera);
    let scene = scene(&[one]);
    let footprint = Footprint::new(&scene, 0, &view).unwrap();
    let record = cutoff::cutoff(
        &scene,
        0,
        &footprint,
        &view,
        &clip(ClipOp::And, &[cutter]),
        &mode(Mode::Exact),
    );
    let w = record.unwrap().weight(0.0, 0.0);
    assert!((f64::from(w) - f64::phi(0.5)).abs() < 1e-6, "{w}");
}
