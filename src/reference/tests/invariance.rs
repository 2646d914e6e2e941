//! Changes of the input that must leave a frame the same: planes at infinity, rigid motions, cutting in two, single precision.

use super::*;
use glam::{DQuat, Vec3 as Point};
use rara_scene::settings::{Decay, ExactForm, Miss};

/// Splats of every size and aspect, one of them about the eye.
fn mixed(count: usize) -> Vec<One> {
    let mut dice = Dice(7);
    let mut ones: Vec<_> = (0..count)
        .map(|i| dice.one([0.003, 0.02, 0.2, 1.0][i % 4], [3.0, 100.0][i % 2]))
        .collect();
    ones.push(One {
        position: [0.1, 0.0, 0.6],
        scale: [0.5, 0.3, 0.4],
        opacity: 0.3,
        ..One::default()
    });
    ones
}

fn every_setting() -> Vec<Settings> {
    let mut all = vec![mode(Mode::None), mode(Mode::Hard)];
    for form in [ExactForm::Auto, ExactForm::Beam, ExactForm::Affine] {
        all.push(mode(Mode::Exact).form(form));
    }
    for miss in [Miss::Keep, Miss::Peak, Miss::Drop] {
        all.push(mode(Mode::Rara).miss(miss));
    }
    let laws = [None, Some(Decay::Linear), Some(Decay::Depth)];
    all.iter()
        .flat_map(|&settings| laws.map(|decay| settings.decay(decay)))
        .collect()
}

#[test]
fn a_plane_at_infinity_changes_no_bit_in_any_mode() {
    unchanged_by_a_plane_at_infinity::<f64>();
    unchanged_by_a_plane_at_infinity::<f32>();
}

fn unchanged_by_a_plane_at_infinity<T: Real>() {
    let (scene, camera) = (scene(&mixed(40)), camera(96, 80, 120.0));
    let far = [plane([0.3, -0.5, 0.8], 1e30), plane([0.0, 1.0, 0.1], 1e9)];
    let expected = render::<T>(&scene, &camera, &NO_CLIP, &Settings::default()).picture;
    for settings in every_setting() {
        for clip in [ClipOp::And, ClipOp::Or].map(|op| clip(op, &far)) {
            let frame = render::<T>(&scene, &camera, &clip, &settings);
            assert!(frame.picture == expected, "{settings:?}");
            let traced = settings.trace_all(true);
            let frame = render::<T>(&scene, &camera, &clip, &traced);
            // Dropping what a ray misses is the one reading that changes a whole splat (the paper's table 2).
            let drops = settings.mode == Mode::Rara && settings.miss == Miss::Drop;
            assert!((frame.picture == expected) != drops, "{traced:?}");
            let traces = matches!(settings.mode, Mode::Exact | Mode::Rara);
            assert_eq!(
                frame.counts.cutoff,
                if traces { frame.counts.drawn } else { 0 }
            );
        }
    }
}

#[test]
fn a_rigid_motion_of_everything_changes_nothing() {
    let ones = mixed(40);
    let home = camera(96, 80, 120.0);
    let still = clip(
        ClipOp::And,
        &[plane([0.3, -0.5, 0.8], -2.9), plane([-1.0, 0.2, 0.1], 0.3)],
    );
    // Exact in f32: a turn about z by 90 degrees and a step of powers of two leave no rounding behind.
    let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let step = DVec3::new(64.0, -32.0, 16.0);
    let turned = |v: Point| Point::new(-v.y, v.x, v.z);
    let base = scene(&ones);
    let mut moved = base.clone();
    for i in 0..base.len() {
        // Rounded to 1/65536 first, so that the step is exact as well.
        let position = (base.positions()[i] * 65536.0).round() / 65536.0;
        moved.positions_mut()[i] = turned(position) + step.as_vec3();
        moved.rotations_mut()[i] = (turn * base.rotations()[i].as_dquat()).as_quat();
    }
    let mut base = base;
    base.positions_mut()
        .iter_mut()
        .for_each(|p| *p = (*p * 65536.0).round() / 65536.0);
    let view = home
        .eye(step)
        .rotation(home.rotation * DMat3::from_quat(turn.inverse()));
    let planes = still.surfaces.iter().map(|surface| {
        let p = surface.as_plane().expect("a plane");
        let normal = turn * p.normal();
        Plane::new(normal, p.offset() - normal.dot(step)).unwrap()
    });
    let carried = Clip::of(planes, still.op);
    for settings in every_setting() {
        let a = render::<f64>(&base, &home, &still, &settings);
        let b = render::<f64>(&moved, &view, &carried, &settings);
        assert_eq!(a.counts, b.counts, "{settings:?}");
        let result = crate::differences::differences(&a.picture, &b.picture).unwrap();
        // Quaternions are rounded to f32 after the turn: 1e-7 of a needle's length.
        assert!(
            result.l1 < 1e-3 && result.share_over_2 < 1e-3,
            "{settings:?}: {result:?}"
        );
    }
}

#[test]
fn the_f32_twin_agrees_with_f64() {
    let (scene, camera) = (scene(&mixed(60)), camera(96, 80, 120.0));
    let clip = clip(ClipOp::And, &[plane([0.3, -0.5, 0.8], -2.9)]);
    for settings in every_setting() {
        let (a, b) = (
            render::<f64>(&scene, &camera, &clip, &settings),
            render::<f32>(&scene, &camera, &clip, &settings),
        );
        let result = crate::differences::differences(&a.picture, &b.picture).unwrap();
        assert_eq!(a.counts, b.counts);
        assert!(
            result.l1 < 2e-3 && result.share_over_2 < 1e-3,
            "{settings:?}: {result:?}"
        );
    }
}

#[test]
fn complementary_halves_rebuild_the_whole_under_the_depth_law() {
    // Splats of one colour that do not overlap: each half is drawn alone and blended over the other by hand.
    let mut dice = Dice(3);
    let camera = camera(64, 64, 100.0);
    for i in 0..40 {
        let one = dice.one([0.003, 0.02, 0.2, 1.0][i % 4], 30.0);
        let normal = dice.direction();
        let cutter = plane_through(&one, normal, dice.between(-1.5, 1.5));
        let half = |plane: Plane| {
            let settings = mode(Mode::Exact);
            render::<f64>(
                &scene(&[one]),
                &camera,
                &clip(ClipOp::And, &[plane]),
                &settings,
            )
            .picture
        };
        let (front, back) = (half(cutter), half(opposite(&cutter)));
        let expected = whole(&scene(&[one]), &camera);
        for ((a, b), whole) in front.pixels.iter().zip(&back.pixels).zip(&expected.pixels) {
            let joined = 1.0 - (1.0 - f64::from(a[3])) * (1.0 - f64::from(b[3]));
            assert!(
                (joined - f64::from(whole[3])).abs() < 2e-7,
                "{joined} is not {}",
                whole[3]
            );
        }
    }
}

/// Not a check: how long a frame takes. `cargo test --release -- --ignored --nocapture speed`
#[test]
#[ignore = "prints how long a frame takes; only means something in release"]
fn speed() {
    let mut dice = Dice(5);
    let ones: Vec<_> = (0..100_000).map(|_| dice.one(0.05, 10.0)).collect();
    let (scene, camera) = (scene(&ones), camera(1024, 1024, 1000.0));
    let cutter = clip(ClipOp::And, &[plane([0.3, -0.5, 0.8], -3.6)]);
    for (settings, clip) in [
        (mode(Mode::None), &NO_CLIP),
        (mode(Mode::Exact), &cutter),
        (mode(Mode::Rara), &cutter),
    ] {
        let start = std::time::Instant::now();
        let wide = render::<f64>(&scene, &camera, clip, &settings);
        let middle = start.elapsed();
        let twin = render::<f32>(&scene, &camera, clip, &settings);
        let end = start.elapsed() - middle;
        let result = crate::differences::differences(&wide.picture, &twin.picture).unwrap();
        println!(
            "{:?}: f64 {middle:?}, f32 {end:?}, {:?}, {result:?}",
            settings.mode, wide.counts
        );
    }
}
