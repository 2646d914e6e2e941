//! Weights of mode `exact` by closed forms.

use super::*;
use rara_scene::Training;
use rara_scene::settings::ExactForm;

const FORMS: [ExactForm; 3] = [ExactForm::Affine, ExactForm::Beam, ExactForm::Auto];

fn exact(form: ExactForm) -> Settings {
    mode(Mode::Exact).form(form).trace_all(true)
}

/// The share of a Gaussian that planes keep, at an offset from its centre.
fn share(one: &One, op: ClipOp, planes: &[Plane], form: ExactForm, [dx, dy]: [f64; 2]) -> f64 {
    let record = cut(
        &scene(&[*one]),
        &camera(64, 64, 100.0),
        &clip(op, planes),
        &exact(form),
    );
    record.expect("traced").weight(dx, dy)
}

/// Random splats with planes through them and a pixel within their footprint. A plane that is turned around is normalised
/// anew: the last digit of its distance matters where a grazing plane cuts a thin splat, and 1e-9 allows for that.
fn cases(count: usize) -> impl Iterator<Item = (One, [Plane; 2], [f64; 2])> {
    let mut dice = Dice(11);
    (0..count).map(move |i| {
        let sigma = [0.002, 0.02, 0.3][i % 3];
        let one = dice.one(sigma, 50.0);
        let planes = [0; 2].map(|_| {
            let normal = dice.direction();
            plane_through(&one, normal, dice.between(-2.0, 2.0))
        });
        let reach = 100.0 * sigma / 4.0 + 0.5;
        (one, planes, [dice.normal() * reach, dice.normal() * reach])
    })
}

#[test]
fn a_plane_through_the_centre_halves_the_central_pixel() {
    let mut dice = Dice(1);
    for sigma in [1e-6, 0.01, 0.1, 1.0] {
        let one = dice.one(sigma, 10.0);
        for form in FORMS {
            let cutter = plane_through(&one, dice.direction(), 0.0);
            let w = share(&one, ClipOp::And, &[cutter], form, [0.0, 0.0]);
            // The plane's own distance is rounded at 1e-16 of the centre's, which is 1e-9 of the smallest splat.
            assert!((w - 0.5).abs() < 1e-8, "{form:?} {sigma}: {w}");
        }
    }
}

#[test]
fn a_plane_across_the_view_cuts_every_ray_of_a_round_splat_alike() {
    // Along z the pixel says nothing about an isotropic splat on the axis: w = Phi(distance / sigma) for every pixel.
    let one = One {
        scale: [0.05; 3],
        ..One::default()
    };
    for deviations in [-2.0, -0.3, 0.0, 1.0, 2.5] {
        let cutter = plane([0.0, 0.0, 1.0], f64::from(0.05_f32) * deviations - 4.0);
        for offset in [[0.0, 0.0], [1.0, 0.0], [-2.0, 1.5]] {
            let w = share(&one, ClipOp::And, &[cutter], ExactForm::Affine, offset);
            assert!(
                (w - f64::phi(deviations)).abs() < 1e-12,
                "{deviations} {offset:?}: {w}"
            );
        }
    }
}

#[test]
fn a_plane_along_the_view_shows_the_low_pass() {
    // A plane that contains the view axis: given the pixel, x is normal with the mean and variance of a one-dimensional
    // Gaussian of variance s^2 seen through noise of variance L: mean s^2/(s^2 + L) dx, variance s^2 L/(s^2 + L).
    let low_pass = f64::from(Training::default().low_pass);
    for pixels in [0.05_f32, 0.5, 3.0] {
        let one = One {
            scale: [pixels * 0.04; 3],
            ..One::default()
        };
        let variance = f64::from(pixels * 0.04).powi(2) * 625.0;
        let cutter = plane([1.0, 0.0, 0.0], 0.0);
        for dx in [-2.0, -0.4, 0.0, 0.1, 1.0] {
            let mean = variance / (variance + low_pass) * dx;
            let deviation = (variance * low_pass / (variance + low_pass)).sqrt();
            let w = share(&one, ClipOp::And, &[cutter], ExactForm::Affine, [dx, 0.7]);
            assert!(
                (w - f64::phi(mean / deviation)).abs() < 1e-12,
                "{pixels} {dx}: {w}"
            );
        }
    }
}

#[test]
fn complementary_halves_add_up_to_one() {
    for (one, [cutter, _], offset) in cases(200) {
        for form in FORMS {
            let [a, b] =
                [cutter, opposite(&cutter)].map(|p| share(&one, ClipOp::And, &[p], form, offset));
            assert!((a + b - 1.0).abs() < 1e-9, "{form:?}: {a} + {b}");
        }
    }
}

#[test]
fn a_plane_given_twice_is_the_plane() {
    for (one, [cutter, _], offset) in cases(200) {
        for form in FORMS {
            let single = share(&one, ClipOp::And, &[cutter], form, offset);
            for op in [ClipOp::And, ClipOp::Or] {
                let double = share(&one, op, &[cutter, cutter], form, offset);
                assert!(
                    (double - single).abs() < 1e-15,
                    "{form:?} {op:?}: {double} is not {single}"
                );
            }
        }
    }
}

#[test]
fn opposed_planes_keep_nothing_or_everything() {
    let flat = One {
        scale: [0.1, 0.1, 0.0],
        rotation: Dice(9).rotation(),
        ..One::default()
    };
    let cutter = plane_through(&flat, DVec3::new(0.6, 0.48, 0.64), 0.3);
    let flat = [(flat, [cutter; 2], [0.5, -0.25])];
    for (one, [cutter, _], offset) in cases(200).chain(flat) {
        let planes = [cutter, opposite(&cutter)];
        for form in FORMS {
            let none = share(&one, ClipOp::And, &planes, form, offset);
            let all = share(&one, ClipOp::Or, &planes, form, offset);
            assert!(
                none.abs() < 1e-9 && (all - 1.0).abs() < 1e-9,
                "{form:?}: {none} {all}"
            );
        }
    }
}

#[test]
fn a_slab_keeps_the_difference_of_its_faces() {
    for (one, [cutter, _], offset) in cases(200) {
        // A parallel plane that faces the other way, behind or before the first.
        let extent = 0.7 * f64::from(one.scale[0]);
        for form in FORMS {
            let far_face = Plane::new(-cutter.normal(), extent - cutter.offset()).unwrap();
            let alone = [cutter, far_face].map(|p| share(&one, ClipOp::And, &[p], form, offset));
            let slab = share(&one, ClipOp::And, &[cutter, far_face], form, offset);
            assert!(
                (slab - (alone[0] + alone[1] - 1.0)).abs() < 1e-12,
                "{form:?}: {slab} from {alone:?}"
            );
            assert!(slab >= 0.0);
            let union = share(&one, ClipOp::Or, &[cutter, far_face], form, offset);
            assert!(
                (union - 1.0).abs() < 1e-12,
                "{form:?}: together they keep everything, not {union}"
            );
        }
    }
}

#[test]
fn a_union_is_what_the_intersection_of_the_complements_leaves() {
    for (one, planes, offset) in cases(300) {
        for form in FORMS {
            let union = share(&one, ClipOp::Or, &planes, form, offset);
            let lost = share(
                &one,
                ClipOp::And,
                &planes.map(|p| opposite(&p)),
                form,
                offset,
            );
            assert!(
                (union + lost - 1.0).abs() < 1e-9,
                "{form:?}: {union} and {lost}"
            );
        }
    }
}

#[test]
fn the_two_forms_agree_for_small_splats() {
    let mut dice = Dice(23);
    for sigma in [0.001, 0.004] {
        let (mut error, mut mass) = (0.0, 0.0);
        for _ in 0..500 {
            let one = dice.one(sigma, 10.0);
            let cutter = plane_through(&one, dice.direction(), dice.between(-2.0, 2.0));
            let offset = [dice.normal(), dice.normal()];
            let view = ViewTransform::<f64>::new(&camera(64, 64, 100.0));
            let footprint = Footprint::new(&scene(&[one]), 0, &view);
            let Some(footprint) = footprint else { continue };
            let alpha = (-0.5 * footprint.power(offset[0], offset[1])).exp();
            let [a, b] = [ExactForm::Affine, ExactForm::Beam]
                .map(|form| share(&one, ClipOp::And, &[cutter], form, offset));
            error += alpha * (a - b).abs();
            mass += alpha;
        }
        assert!(error / mass < 0.3 * sigma, "{sigma}: {}", error / mass);
    }
}

#[test]
fn a_point_is_on_one_side_and_the_plane_itself_is_visible() {
    let point = One {
        scale: [0.0; 3],
        position: [0.0, 0.0, 4.0],
        ..One::default()
    };
    for form in FORMS {
        for (offset, expected) in [(-3.5, 1.0), (-4.0, 1.0), (-4.5, 0.0)] {
            let w = share(
                &point,
                ClipOp::And,
                &[plane([0.0, 0.0, 1.0], offset)],
                form,
                [0.3, 0.2],
            );
            assert_eq!(w, expected, "{form:?} {offset}");
        }
    }
}

#[test]
fn auto_takes_the_perspective_form_for_what_is_large_or_outside_the_picture() {
    let is_beam = |one: One, camera: &Camera, form| {
        let cutter = plane_through(&one, DVec3::new(0.6, 0.0, 0.8), 0.1);
        let record = cut(
            &scene(&[one]),
            camera,
            &clip(ClipOp::And, &[cutter]),
            &exact(form),
        );
        matches!(record, Some(SplatCut::Beam(_)))
    };
    let camera = camera(64, 64, 100.0);
    let sized = |sigma: f32| One {
        scale: [0.01, sigma, 0.01],
        ..One::default()
    };
    let switch = 4.0 * rara_base::limits::BEAM_SWITCH; // the splat is 4 away
    assert!(is_beam(sized(1.01 * switch), &camera, ExactForm::Auto));
    assert!(!is_beam(sized(0.99 * switch), &camera, ExactForm::Auto));
    assert!(!is_beam(sized(1.0), &camera, ExactForm::Affine));
    assert!(is_beam(sized(0.001), &camera, ExactForm::Beam));
    // A long lens: the picture ends at X/Z = 0.004, the clamp at 0.0052, and the splat reaches far beyond.
    let camera = camera.fx(8000.0).fy(8000.0);
    let aside = |x: f32| One {
        position: [4.0 * x, 0.0, 4.0],
        scale: [0.015; 3],
        ..One::default()
    };
    assert!(is_beam(aside(0.0053), &camera, ExactForm::Auto));
    assert!(!is_beam(aside(0.0051), &camera, ExactForm::Auto));
}
