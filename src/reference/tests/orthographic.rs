//! Orthographic views: lines of sight along the view axis, by closed forms and as the limit of perspective.

use super::truth::{STUDY, Study};
use super::*;
use rara_scene::settings::{ExactForm, Settings};

/// A camera before the origin, of which a unit is 25 pixels, and one in perspective `factor` times as far away that
/// shows the plane through the origin at the same scale.
fn pair(factor: f64) -> [Camera; 2] {
    let at = |distance: f64| DVec3::new(0.3, -0.5, -1.0).normalize() * distance;
    let flat = Camera::orthographic(at(8.0), DVec3::ZERO, DVec3::NEG_Y, 4.0, (120, 100));
    let flat = flat.expect("a view");
    let far = 8.0 * factor;
    let deep = flat.eye(at(far)).projection(Projection::Perspective);
    [flat, deep.fx(25.0 * far).fy(25.0 * far)]
}

/// Splats about the origin of 0.02 to 20 pixels; colours depend on the direction.
fn cloud(count: usize) -> Gaussians {
    let mut dice = Dice(5);
    let mut scene = Gaussians::default();
    scene.set_sh_degree(3);
    for _ in 0..count {
        let sigma = 1e-3 * 1e3_f64.powf(dice.next());
        let scale = Point::from([0; 3].map(|_| (sigma * 10_f64.powf(-dice.next())) as f32));
        let coefficients: Vec<f32> = (0..48).map(|_| 0.4 * dice.normal() as f32).collect();
        let position = [0; 3].map(|_| dice.between(-1.3, 1.3) as f32);
        let (rotation, opacity) = (dice.rotation(), dice.between(0.1, 1.0) as f32);
        scene.push(position.into(), scale, rotation, opacity, &coefficients);
    }
    scene
}

#[test]
fn perspective_from_far_away_converges_to_the_orthographic_picture() {
    let scene = cloud(300);
    let cut = clip(ClipOp::And, &[plane([0.3, -0.2, 0.9], 0.1)]);
    for mode in [Mode::None, Mode::Hard, Mode::Rara, Mode::Exact] {
        let settings = Settings::default().mode(mode);
        let [near, far] = [20.0, 2000.0].map(|factor| {
            let [flat, deep] = pair(factor);
            let [flat, deep] =
                [flat, deep].map(|camera| render::<f64>(&scene, &camera, &cut, &settings));
            let apart = flat.picture.pixels.iter().zip(&deep.picture.pixels);
            let channels = apart.flat_map(|(a, b)| (0..4).map(|i| (a[i] - b[i]).abs()));
            channels.map(f64::from).sum::<f64>() / (4.0 * 120.0 * 100.0)
        });
        // What perspective adds falls with the distance.
        assert!(
            near > 1e-4 && far < 2e-2 * near,
            "{mode:?}: {near:.1e}, {far:.1e}"
        );
    }
}

#[test]
fn the_footprint_is_the_projected_covariance_wherever_the_centre_is() {
    let mut dice = Dice(41);
    let camera = camera(100, 80, 1.0)
        .fx(11.0)
        .fy(9.0)
        .cx(40.0)
        .cy(60.0)
        .eye(dice.direction())
        .rotation(DMat3::from_quat(dice.rotation().as_dquat().normalize()));
    let camera = camera.projection(Projection::Orthographic);
    let view = ViewTransform::<f64>::new(&camera);
    let mut compared = 0;
    for _ in 0..1000 {
        let local = DVec3::new(
            dice.between(-9.0, 9.0),
            dice.between(-9.0, 9.0),
            dice.between(0.3, 90.0),
        );
        let world = (camera.rotation.transpose() * local + camera.eye).as_vec3();
        let one = One {
            position: world.to_array(),
            ..dice.one(1.0, 10.0)
        };
        let Some(footprint) = Footprint::new(&scene(&[one]), 0, &view) else {
            continue;
        };
        let t = camera.rotation * (world.as_dvec3() - camera.eye);
        let axes = camera.rotation * DMat3::from_quat(one.rotation.as_dquat());
        let squares = DMat3::from_diagonal(Point::from(one.scale).as_dvec3().powf(2.0));
        let covariance = axes * squares * axes.transpose();
        let entry = |i: usize, j: usize| {
            let focal = [11.0, 9.0];
            focal[i] * focal[j] * covariance.col(i)[j] + if i == j { 0.3 } else { 0.0 }
        };
        let (xx, xy, yy) = (entry(0, 0), entry(0, 1), entry(1, 1));
        let (dx, dy) = (dice.normal() * xx.sqrt(), dice.normal() * yy.sqrt());
        let expected = (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / (xx * yy - xy * xy);
        let q = footprint.power(dx, dy);
        assert!((q - expected).abs() < 1e-5 * (1.0 + expected), "{one:?}");
        let [x, y] = footprint.screen_centre;
        assert!((x - (11.0 * t.x + 40.0)).abs() < 1e-9 && (y - (9.0 * t.y + 60.0)).abs() < 1e-9);
        assert!(!footprint.clamped && !footprint.holds_the_eye());
        compared += 1;
    }
    assert!(compared > 200, "the test would say nothing: {compared}");
}

#[test]
fn the_chord_of_mode_rara_runs_along_the_view_axis() {
    let mut dice = Dice(31);
    let camera = camera(64, 64, 20.0).projection(Projection::Orthographic);
    let (mut hits, mut partial) = (0, 0);
    for i in 0..3000 {
        // The largest reach far behind the eye.
        let one = dice.one([0.05, 0.3, 5.0][i % 3], 5.0);
        let cutter = plane_through(&one, dice.direction(), dice.between(-2.0, 2.0));
        let scene = scene(&[one]);
        let Some(footprint) = Footprint::<f64>::new(&scene, 0, &ViewTransform::new(&camera)) else {
            continue;
        };
        let [dx, dy] = footprint.conic.map(|k| dice.between(-2.0, 2.0) / k)[..2] else {
            unreachable!("a conic has three numbers");
        };
        let settings = mode(Mode::Rara).trace_all(true);
        let record = cut(&scene, &camera, &clip(ClipOp::And, &[cutter]), &settings);
        let weight = record.expect("every splat is traced").weight(dx, dy);

        // In unit space |start + t step| = 3 at both ends of the chord; where the plane's function is 0 it is cut.
        let turn = DMat3::from_quat(one.rotation.as_dquat()).transpose();
        let inverse = DMat3::from_diagonal(1.0 / Point::from(one.scale).as_dvec3()) * turn;
        let foot = DVec3::new(dx / 20.0, dy / 20.0, 0.0);
        let (start, step) = (inverse * foot, inverse * DVec3::Z);
        let (a, b) = (step.length_squared(), start.dot(step));
        let root = b * b - a * (start.length_squared() - 9.0);
        if root <= 0.0 {
            assert!(weight == 0.0 || weight == 1.0);
            continue;
        }
        let (first, last) = ((-b - root.sqrt()) / a, (-b + root.sqrt()) / a);
        let point = Point::from(one.position).as_dvec3() + foot;
        let crossing = -cutter.distance(point) / cutter.normal().z;
        let part = ((crossing - first) / (last - first)).clamp(0.0, 1.0);
        let kept = if cutter.normal().z > 0.0 {
            1.0 - part
        } else {
            part
        };
        assert!((weight - kept).abs() < 1e-5, "{one:?}: {weight}, {kept}");
        hits += 1;
        partial += usize::from(kept > 0.01 && kept < 0.99);
    }
    assert!(
        hits > 500 && partial > 100,
        "the test would say nothing: {hits} {partial}"
    );
}

#[test]
fn nothing_depends_on_where_along_the_axis_the_eye_stands() {
    let scene = cloud(200);
    let cut = clip(
        ClipOp::Or,
        &[plane([0.3, -0.2, 0.9], 0.1), plane([1.0, 0.0, 0.0], -0.2)],
    );
    let [camera, _] = pair(1.0);
    let forward = camera.rotation.transpose().z_axis;
    let away = camera.eye(camera.eye - 50.0 * forward);
    for form in [ExactForm::Auto, ExactForm::Affine, ExactForm::Beam] {
        let settings = Settings::default().form(form);
        let [here, there] =
            [camera, away].map(|camera| render::<f64>(&scene, &camera, &cut, &settings));
        assert_eq!(here.counts, there.counts);
        let pixels = here.picture.pixels.iter().zip(&there.picture.pixels);
        for (a, b) in pixels {
            assert!((0..4).all(|i| (a[i] - b[i]).abs() < 1e-6), "{a:?} {b:?}");
        }
    }
}

/// Where lines of sight are parallel, the affine form is the integral for splats of every size, and has no eye.
#[test]
fn orthographic_shares_are_the_integral_for_splats_of_every_size() {
    for (pixels, aspect) in [
        ([0.02, 0.2], 10.0),
        ([0.2, 5.0], 1000.0),
        ([5.0, 100.0], 30.0),
        ([100.0, 3000.0], 30.0),
    ] {
        for form in [ExactForm::Auto, ExactForm::Beam] {
            let errors = Study {
                pixels,
                aspect,
                form,
                projection: Projection::Orthographic,
                steps: 128,
                ..STUDY
            }
            .run();
            errors.assert_partial(15);
            errors.assert_within(1e-4, 5e-4, format_args!("{form:?} {pixels:?}"));
        }
    }
}

#[test]
fn orthographic_shares_of_several_planes_are_as_exact_as_of_one() {
    for op in [ClipOp::And, ClipOp::Or] {
        for planes in [2, 3] {
            for pixels in [[0.02, 0.2], [1.0, 5.0], [30.0, 300.0]] {
                let errors = Study {
                    pixels,
                    planes,
                    op,
                    projection: Projection::Orthographic,
                    steps: 112,
                    ..STUDY
                }
                .run();
                assert!(errors.mean < 1e-4, "{op:?} {planes} {pixels:?}: {errors:?}");
            }
        }
    }
}

/// A splat around the point that depths count from is seen as a whole, also the part of it behind that point.
#[test]
fn an_orthographic_splat_around_the_eye_is_seen_as_a_whole() {
    for inside in [[0.1, 1.0], [1.0, 2.5]] {
        let errors = Study {
            pixels: [300.0, 3000.0],
            inside: Some(inside),
            projection: Projection::Orthographic,
            ..STUDY
        }
        .run();
        errors.assert_partial(10);
        errors.assert_within(1e-4, 1e-3, format_args!("{inside:?}"));
    }
}
