//! Whole frames by closed forms: footprints, blending, order, colours.

use super::*;
use glam::Vec3 as Point;
use rara_scene::Training;

#[test]
fn an_isotropic_splat_on_the_axis_is_a_round_gaussian() {
    let one = One {
        opacity: 0.9,
        colour: [0.25, 0.5, 1.5],
        ..One::default()
    };
    let camera = camera(65, 65, 200.0);
    let picture = whole(&scene(&[one]), &camera);
    // 0.1 units at 4 units through a focal length of 200 pixels, and the low-pass.
    let variance = 25.0_f64 + f64::from(Training::default().low_pass);
    for y in 0..65 {
        for x in 0..65 {
            let squared = f64::from(x as i32 - 32).powi(2) + f64::from(y as i32 - 32).powi(2);
            let alpha = f64::from(0.9_f32) * (-0.5 * squared / variance).exp();
            let alpha = if alpha < 1.0 / 255.0 { 0.0 } else { alpha };
            let expected = [0.25 * alpha, 0.5 * alpha, 1.5 * alpha, alpha];
            for (value, expected) in picture.at(x, y).iter().zip(expected) {
                assert!(
                    (f64::from(*value) - expected).abs() < 2e-7,
                    "{x},{y}: {value} is not {expected}"
                );
            }
        }
    }
}

#[test]
fn alpha_peaks_at_the_limit_and_ends_at_one_in_255() {
    let camera = camera(1, 1, 100.0);
    let alpha = |opacity| {
        let frame = render::<f64>(
            &scene(&[One {
                opacity,
                ..One::default()
            }]),
            &camera,
            &NO_CLIP,
            &Settings::default(),
        );
        (frame.picture.at(0, 0)[3], frame.counts.culled)
    };
    assert_eq!(alpha(1.0), (0.99, 0));
    assert_eq!(alpha(0.5), (0.5, 0));
    assert_eq!(alpha(1.001 / 255.0), (1.001 / 255.0, 0));
    assert_eq!(alpha(0.999 / 255.0), (0.0, 1));
}

#[test]
fn what_is_out_of_view_is_culled_and_counted() {
    let at = |x: f32, z: f32| One {
        position: [x, 0.0, z],
        ..One::default()
    };
    // The last centre is at pixel 32 + 50 = 82; half a box of 3.24 x 2.56 pixels does not reach back to pixel 63.
    let ones = [at(0.0, 4.0), at(0.0, 0.19), at(0.0, -4.0), at(2.0, 4.0)];
    let frame = render::<f64>(
        &scene(&ones),
        &camera(64, 64, 100.0),
        &NO_CLIP,
        &Settings::default(),
    );
    let expected = Counts {
        visible: 1,
        culled: 3,
        drawn: 1,
        ..Counts::default()
    };
    assert_eq!(frame.counts, expected);
}

#[test]
fn two_splats_composite_in_order_of_depth_over_the_background() {
    let near = One {
        position: [0.0, 0.0, 3.0],
        opacity: 0.5,
        colour: [1.0, 0.0, 0.0],
        ..One::default()
    };
    let far = One {
        position: [0.0, 0.0, 5.0],
        opacity: 0.25,
        colour: [0.0, 1.0, 0.0],
        ..One::default()
    };
    let camera = camera(1, 1, 100.0);
    let pixel = |ones: &[One], background| {
        let settings = Settings::default().background(background);
        render::<f64>(&scene(ones), &camera, &NO_CLIP, &settings)
            .picture
            .at(0, 0)
    };
    for ones in [[near, far], [far, near]] {
        assert_close(pixel(&ones, None), [0.5, 0.125, 0.0, 0.625]);
        assert_close(
            pixel(&ones, Some([0.0, 0.5, 1.0])),
            [0.5, 0.125 + 0.375 * 0.5, 0.375, 1.0],
        );
    }
    // At the same depth the first in the file is in front.
    let level = One {
        position: near.position,
        ..far
    };
    assert_close(pixel(&[near, level], None), [0.5, 0.125, 0.0, 0.625]);
    assert_close(pixel(&[level, near], None), [0.375, 0.25, 0.0, 0.625]);
}

fn assert_close(pixel: [f32; 4], expected: [f32; 4]) {
    let error = pixel
        .iter()
        .zip(expected)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    assert!(error < 3e-7, "{pixel:?} is not {expected:?}");
}

#[test]
fn harmonics_are_orthonormal_and_have_the_known_values_on_the_axes() {
    // A product rule that is exact for polynomials of degree 6 on the sphere: 4 Gauss-Legendre heights by 8 angles.
    let heights = [
        (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
    ];
    let mut gram = [[0.0; 16]; 16];
    for (height, weight) in heights.into_iter().flat_map(|(h, w)| [(h, w), (-h, w)]) {
        for step in 0..8 {
            let angle = std::f64::consts::TAU * f64::from(step) / 8.0;
            let radius = (1.0_f64 - height * height).sqrt();
            let basis = harmonics::basis(vec3(radius * angle.cos(), radius * angle.sin(), height));
            for i in 0..16 {
                for j in 0..16 {
                    gram[i][j] += basis[i] * basis[j] * weight * std::f64::consts::TAU / 8.0;
                }
            }
        }
    }
    for (i, row) in gram.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            assert!(
                (value - f64::from(i == j)).abs() < 1e-12,
                "<{i}, {j}> = {value}"
            );
        }
    }
    let up = harmonics::basis(vec3(0.0_f64, 0.0, 1.0));
    let known = [
        (0, 0.282_094_791_8),
        (2, 0.488_602_511_9),
        (6, 0.630_783_130_5),
        (12, 0.746_352_665_2),
    ];
    for (i, value) in up.iter().enumerate() {
        let expected = known.iter().find(|(k, _)| *k == i).map_or(0.0, |k| k.1);
        assert!((value - expected).abs() < 1e-9, "{i}: {value}");
    }
    // Odd orders are negative along +x and +y.
    let basis = harmonics::basis(vec3(1.0_f64, 0.0, 0.0));
    assert!(
        (basis[3] + 0.488_602_511_9).abs() < 1e-9 && (basis[15] + 0.590_043_589_9).abs() < 1e-9
    );
    assert!((harmonics::basis(vec3(0.0_f64, 1.0, 0.0))[1] + 0.488_602_511_9).abs() < 1e-9);
}

#[test]
fn colours_see_from_the_eye_to_the_centre_and_are_not_negative() {
    let mut scene = scene(&[One {
        position: [0.0, 0.0, 4.0],
        opacity: 0.5,
        ..One::default()
    }]);
    scene.set_sh_degree(1);
    scene.sh_mut().fill(0.0);
    (scene.sh_mut()[6], scene.sh_mut()[7]) = (1.0, -2.0); // z band: red up, green down, seen along +z
    let camera = camera(1, 1, 100.0);
    let pixel = whole(&scene, &camera).at(0, 0);
    assert_close(pixel, [0.5 * (0.5 + 0.488_602_5), 0.0, 0.25, 0.5]);
    let settings = Settings::default().sh_degree(Some(0));
    assert_close(
        render::<f64>(&scene, &camera, &NO_CLIP, &settings)
            .picture
            .at(0, 0),
        [0.25, 0.25, 0.25, 0.5],
    );
}

#[test]
fn the_footprint_is_the_published_ewa_projection_with_matrices() {
    let mut dice = Dice(41);
    let (mut clamped, mut compared) = (0, 0);
    for _ in 0..2000 {
        // A turned camera with a principal point off the middle; splats inside and outside the view.
        let camera = camera(100, 80, 1.0)
            .fx(110.0)
            .fy(90.0)
            .cx(40.0)
            .cy(60.0)
            .eye(dice.direction())
            .rotation(DMat3::from_quat(dice.rotation().as_dquat().normalize()));
        let one = dice.one(1.0, 10.0);
        let depth = dice.between(1.0, 4.0);
        let local = DVec3::new(
            dice.between(-1.5, 1.5) * depth,
            dice.between(-1.5, 1.5) * depth,
            depth,
        );
        let world = (camera.rotation.transpose() * local + camera.eye).as_vec3();
        let one = One {
            position: world.to_array(),
            ..one
        };
        let view = ViewTransform::<f64>::new(&camera);
        let Some(footprint) = Footprint::new(&scene(&[one]), 0, &view) else {
            continue;
        };

        let t = camera.rotation * (world.as_dvec3() - camera.eye);
        let axes = DMat3::from_quat(one.rotation.as_dquat());
        let squares = DMat3::from_diagonal(Point::from(one.scale).as_dvec3().powf(2.0));
        let covariance =
            camera.rotation * axes * squares * axes.transpose() * camera.rotation.transpose();
        let limits = [[-15.0 - 40.0, 115.0 - 40.0], [-12.0 - 60.0, 92.0 - 60.0]];
        let tx = (t.x / t.z).clamp(limits[0][0] / 110.0, limits[0][1] / 110.0) * t.z;
        let ty = (t.y / t.z).clamp(limits[1][0] / 90.0, limits[1][1] / 90.0) * t.z;
        clamped += usize::from((tx - t.x).abs().max((ty - t.y).abs()) > 1e-9);
        let rows = [
            DVec3::new(110.0 / t.z, 0.0, -110.0 * tx / (t.z * t.z)),
            DVec3::new(0.0, 90.0 / t.z, -90.0 * ty / (t.z * t.z)),
        ];
        let entry =
            |i: usize, j: usize| rows[i].dot(covariance * rows[j]) + if i == j { 0.3 } else { 0.0 };
        let (xx, xy, yy) = (entry(0, 0), entry(0, 1), entry(1, 1));
        let (dx, dy) = (dice.normal() * xx.sqrt(), dice.normal() * yy.sqrt());
        let expected = (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / (xx * yy - xy * xy);
        let q = footprint.power(dx, dy);
        assert!(
            (q - expected).abs() < 1e-5 * (1.0 + expected),
            "{one:?}: {q} is not {expected}"
        );
        let reach = (2.0 * (255.0 * f64::from(one.opacity)).ln()).sqrt();
        let expected = [
            110.0 * t.x / t.z + 40.0,
            90.0 * t.y / t.z + 60.0,
            reach * xx.sqrt(),
            reach * yy.sqrt(),
        ];
        let [x, y] = footprint.screen_centre;
        for (value, expected) in [x, y, footprint.half_sides[0], footprint.half_sides[1]]
            .into_iter()
            .zip(expected)
        {
            assert!(
                (value - expected).abs() < 1e-5 * (1.0 + expected.abs()),
                "{value} is not {expected}"
            );
        }
        compared += 1;
    }
    assert!(
        clamped > 100 && compared > 500,
        "the test would say nothing: {clamped} of {compared}"
    );
}
