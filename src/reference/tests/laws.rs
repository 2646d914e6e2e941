//! Laws of cutting for random splats, planes and pixels, in double precision and in the twin's single precision.

use super::properties::{Case, cases, directions, splats};
use super::*;
use glam::Quat;
use proptest::prelude::*;
use rara_scene::Training;
use rara_scene::settings::{Decay, Miss};

/// How far two halves may be from the whole, as alpha or as weight. Doubles: rounding. Singles: each half is rounded
/// to 6e-8 of itself, and so is what it is computed from. Where the eye is within the splat a plane's distance counts
/// against how fast the tail in front of it falls.
fn tolerance<T: Real>(cut: &SplatCut<T>) -> f64 {
    let rounding = if size_of::<T>() == 4 { 2e-7 } else { 1e-14 };
    match cut {
        SplatCut::Beam(beam) if beam.front.is_some() => 1e4 * rounding,
        _ => rounding,
    }
}

/// The other readings of a missed ray keep, or drop, what lies on either side.
fn by_peak(mut case: Case) -> Case {
    case.settings.miss = Miss::Peak;
    case
}

fn flipped(planes: &[Plane]) -> Vec<Plane> {
    planes.iter().map(Plane::flipped).collect()
}

/// Checks that each half's alpha, the other blended behind it, is the whole's.
fn halves_compose<T: Real>(case: &Case) -> Result<(), TestCaseError> {
    let planes = case.planes();
    let settings = case.settings.decay(Some(Decay::Depth));
    let (scene, view) = (scene(&[case.one]), case.view::<T>());
    let Some(whole) = project::project(&scene, 0, &view, &settings) else {
        return Ok(());
    };
    let (dx, dy) = case.pixel(&whole.footprint);
    let alpha = |planes: Vec<Plane>| {
        let mut splat = whole.clone();
        let clip = clip(case.op, &planes);
        splat.cut = cutoff::cutoff(&scene, 0, &splat.footprint, &view, &clip, &settings);
        let alpha = splat::alpha(&splat, dx, dy, Decay::Depth).map_or(0.0, T::wide);
        (alpha, splat.cut.as_ref().map_or(0.0, tolerance))
    };
    let Some(expected) = splat::alpha(&whole, dx, dy, Decay::Depth).map(T::wide) else {
        return Ok(());
    };
    let ((a, limit), (b, _)) = (alpha(planes.clone()), alpha(flipped(&planes)));
    let joined = 1.0 - (1.0 - a) * (1.0 - b);
    let on_the_plane = a == expected && b == expected;
    prop_assert!(
        (joined - expected).abs() <= limit || on_the_plane,
        "{a} and {b} make {joined}, not {expected}"
    );
    Ok(())
}

/// Checks that what planes keep and what the opposite planes keep, joined the other way, are everything.
fn complements_add_up<T: Real>(case: &Case) -> Result<(), TestCaseError> {
    let planes = case.planes();
    let other = Case {
        op: case.op.dual(),
        ..case.clone()
    };
    let (Some(kept), Some(lost)) = (case.cut::<T>(&planes), other.cut::<T>(&flipped(&planes)))
    else {
        return Ok(());
    };
    let ((kept, record), (lost, _)) = (kept, lost);
    // A plane itself is visible: a splat without any thickness that lies in it belongs to both sides.
    let both = |plane: &Plane| {
        let sides = [*plane, plane.flipped()].map(|p| case.weight::<T>(&[p]));
        sides == [Some(1.0); 2]
    };
    prop_assert!(
        (kept + lost - 1.0).abs() <= tolerance(&record) || planes.iter().any(both),
        "{kept} and {lost}: {record:?}"
    );
    Ok(())
}

/// The 12 rotations whose matrices are made of 0 and 1: exact in any precision, and so are their quaternions.
fn exact_turns() -> impl Strategy<Value = DMat3> {
    let parts = (0..3_usize, any::<bool>(), any::<bool>());
    parts.prop_map(|(step, x, y)| {
        let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
        let signs = [sign(x), sign(y), sign(x) * sign(y)];
        let column = |i: usize| DVec3::AXES[(i + step) % 3] * signs[i];
        DMat3::from_cols(column(0), column(1), column(2))
    })
}

/// To a grid of 1/4096, on which positions and steps add up exactly in single precision.
fn on_grid(v: DVec3) -> DVec3 {
    (v * 4096.0).round() / 4096.0
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn halves_blended_over_each_other_are_the_whole(case in cases(1..2).prop_map(by_peak)) {
        halves_compose::<f64>(&case)?;
        halves_compose::<f32>(&case)?;
    }

    #[test]
    fn what_planes_keep_and_what_they_cut_away_is_everything(case in cases(1..5).prop_map(by_peak)) {
        complements_add_up::<f64>(&case)?;
        complements_add_up::<f32>(&case)?;
    }

    /// In single precision too: every step from the plane's distance to the weight is monotone as rounded, and the
    /// last place of a weight is 6e-8.
    #[test]
    fn weights_and_classes_grow_as_a_plane_retreats(case in cases(1..4), step in 0.0..2.0_f64) {
        let mut moved = case.clone();
        moved.planes[0].1 += step;
        let [before, after] = [&case, &moved].map(|c| c.weight::<f32>(&c.planes()));
        if let (Some(before), Some(after)) = (before, after) {
            prop_assert!(after >= before - 1.2e-7, "{before}, then {after}");
        }
        let rank = |case: &Case| {
            let settings = case.settings.trace_all(false);
            let clip = clip(case.op, &case.planes());
            match classify::classify(&scene(&[case.one]), &case.view::<f32>(), &clip, &settings)[0] {
                Side::Culled => None,
                Side::Invisible => Some(0),
                Side::Cutoff => Some(1),
                Side::Visible => Some(2),
            }
        };
        prop_assert!(rank(&moved) >= rank(&case));
    }

    /// Turns and steps that single precision holds exactly leave the rounding of doubles: 1e-13 of the coordinates in
    /// a plane's distance, and 1e-7 for aspects of up to 1e8, which the footprint's inverse sees.
    #[test]
    fn a_rigid_motion_of_the_world_changes_no_weight(
        case in cases(1..4).prop_map(by_peak),
        pose in (directions(), -3.0..3.0_f64, [-20.0..20.0_f64, -20.0..20.0, -20.0..20.0]),
        turn in exact_turns(),
        step in [-60.0..60.0_f64, -60.0..60.0, -60.0..60.0],
    ) {
        let (step, eye) = (on_grid(step.into()), on_grid(pose.2.into()));
        let to_camera = DMat3::from_axis_angle(pose.0, pose.1);
        let home = case.camera(1.0).eye(eye).rotation(to_camera);
        let position = on_grid(eye + to_camera.transpose() * Point::from(case.one.position).as_dvec3());
        let still = One { position: position.as_vec3().to_array(), rotation: Quat::IDENTITY, ..case.one };
        let quaternion = Quat::from_mat3(&turn.as_mat3());
        prop_assert!(quaternion.to_array().iter().all(|v| [0.0, 0.5, 1.0].contains(&v.abs())));
        let moved = One {
            position: (turn * position + step).as_vec3().to_array(),
            rotation: quaternion,
            ..still
        };
        let away = home.eye(turn * eye + step).rotation(to_camera * turn.transpose());

        let planes = Case { one: still, ..case.clone() }.planes();
        let carried: Vec<_> = planes.iter().map(|p| {
            let normal = turn * p.normal();
            Plane::new(normal, p.offset() - normal.dot(step)).unwrap()
        }).collect();
        let weight = |one: One, camera: &Camera, planes: &[Plane]| {
            let case = Case { one, ..case.clone() };
            case.seen::<f64>(&ViewTransform::new(camera), planes).map(|(w, _)| w)
        };
        let slack = 1e-13 * (position.length() + step.length() + 1.0);
        let shifted = |by: f64| -> Vec<_> {
            planes.iter().map(|p| Plane::new(p.normal(), p.offset() + by).unwrap()).collect()
        };
        let least = weight(still, &home, &shifted(-slack));
        let most = weight(still, &home, &shifted(slack));
        if let (Some(least), Some(most), Some(w)) = (least, most, weight(moved, &away, &carried)) {
            prop_assert!(least - 1e-7 <= w && w <= most + 1e-7, "{w} is not within {least} and {most}");
        }
    }

    /// World units have no meaning but one: a centre nearer than 0.2 of them is culled. All else is bit for bit the
    /// same in a world twice or half as large, in either precision.
    #[test]
    fn a_world_of_another_power_of_two_has_the_same_weights(case in cases(1..4), power in -6..12_i32) {
        let factor = 2.0_f64.powi(power);
        let larger = |v: [f32; 3]| v.map(|v| v * factor as f32);
        let one = One { position: larger(case.one.position), scale: larger(case.one.scale), ..case.one };
        let scaled = |factor: f64| -> Vec<_> {
            case.planes().iter().map(|p| Plane::new(p.normal(), p.offset() * factor).unwrap()).collect()
        };
        let other = Case { one, ..case.clone() };
        let near = f64::from(rara_base::limits::NEAR_Z);
        if f64::from(one.position[2]) >= near && f64::from(case.one.position[2]) >= near {
            let camera = other.camera(factor);
            let double = other.seen::<f64>(&ViewTransform::new(&camera), &scaled(factor));
            let single = other.seen::<f32>(&ViewTransform::new(&camera), &scaled(factor));
            prop_assert_eq!(case.weight::<f64>(&scaled(1.0)), double.map(|(weight, _)| weight));
            prop_assert_eq!(case.weight::<f32>(&scaled(1.0)), single.map(|(weight, _)| weight));
        }
    }

    #[test]
    fn splitting_a_scene_and_merging_it_changes_nothing(
        ones in prop::collection::vec(splats(), 1..20),
        at in any::<prop::sample::Index>(),
        degrees in [0..4_u32, 0..4_u32],
    ) {
        let at = at.index(ones.len() + 1);
        let whole = scene(&ones);
        let mut merged = scene(&ones[..at]);
        merged.append(&scene(&ones[at..]));
        prop_assert_eq!(&merged, &whole);
        // Parts of different degrees: the higher one's harmonics are zeros.
        let [mut first, mut second] = [scene(&ones[..at]), scene(&ones[at..])];
        first.set_sh_degree(degrees[0]);
        second.set_sh_degree(degrees[1]);
        first.append(&second);
        prop_assert_eq!(first.sh().len(), 3 * first.len() * first.sh_coefficients());
        first.set_sh_degree(0);
        prop_assert_eq!(&first, &whole);
    }
}

#[test]
fn what_is_antialiased_has_the_light_that_it_has_without_the_low_pass() {
    // The integral of alpha over the picture is the opacity times 2 pi times the root of the covariance's determinant.
    let mut dice = Dice(5);
    let view = ViewTransform::<f64>::new(&camera(64, 48, 100.0));
    let mut darkest = 1.0_f64;
    for round in 0..200 {
        let one = dice.one([0.012, 0.03, 0.5][round % 3], 4.0);
        let mut scene = scene(&[one]);
        let plain = Footprint::new(&scene, 0, &view);
        scene.set_antialiased(true);
        let Some(footprint) = Footprint::new(&scene, 0, &view) else {
            continue;
        };
        let plain = plain.expect("what is fainter is in view");
        let [b1, b2] = footprint.gradients.b;
        let [k0, _, k2] = footprint.conic;
        let (without, with) = (b1.cross(b2).length(), 1.0 / (k0 * k2));
        let light = |opacity: f64, deviations: f64| opacity * deviations;
        let expected = light(plain.opacity, without);
        assert!((light(footprint.opacity, with) - expected).abs() <= 1e-12 * expected.max(1e-3));
        assert_eq!(footprint.conic, plain.conic);
        assert_eq!(footprint.reach, plain.extent);
        assert!(footprint.extent <= plain.extent);
        darkest = darkest.min(footprint.opacity / plain.opacity);
    }
    assert!(
        darkest < 0.1,
        "{darkest}: a splat of less than a pixel loses most"
    );
}

#[test]
fn what_makes_up_for_the_low_pass_leaves_a_share() {
    // A splat without any extent has no light of its own. Trainers leave it 0.005 of its opacity.
    let one = One {
        position: [0.02, 0.02, 4.0], // the middle of a pixel
        scale: [0.0; 3],
        opacity: 1.0,
        ..One::default()
    };
    let mut scene = scene(&[one]);
    scene.set_antialiased(true);
    let view = ViewTransform::<f64>::new(&camera(64, 64, 100.0));
    let footprint = Footprint::new(&scene, 0, &view).expect("0.005 is above 1/255");
    assert!((footprint.opacity - 0.005).abs() < 1e-6);
    scene.opacities_mut()[0] = 0.7;
    assert!(Footprint::new(&scene, 0, &view).is_none(), "0.0035 is not");
}

#[test]
fn a_picture_twice_as_large_is_another_picture_of_small_splats() {
    // The low-pass is 0.3 square pixels whatever a pixel covers: it widens the smaller picture's splats by more.
    let one = One {
        scale: [0.004; 3],
        ..One::default()
    };
    let variance = |factor: f64| {
        let size = (64.0 * factor) as u32;
        let view = ViewTransform::<f64>::new(&camera(size, size, 100.0 * factor));
        let footprint = Footprint::new(&scene(&[one]), 0, &view).unwrap();
        (footprint.half_sides[0] / footprint.extent).powi(2)
    };
    let low_pass = f64::from(Training::default().low_pass);
    let [small, large] = [1.0, 2.0].map(variance);
    assert!((large - 4.0 * small + 3.0 * low_pass).abs() < 1e-12);
}
