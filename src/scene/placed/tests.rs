use glam::Vec3;

use super::*;
use crate::{Kind, generate};

/// The colour of a Gaussian in a direction.
fn seen(gaussians: &Gaussians, index: usize, direction: DVec3) -> DVec3 {
    let parts = basis(direction);
    let own = gaussians.sh_of(index).chunks_exact(3);
    own.zip(parts)
        .map(|(c, part)| DVec3::new(c[0].into(), c[1].into(), c[2].into()) * part)
        .sum()
}

#[test]
fn what_is_placed_looks_the_same_from_where_it_is() {
    let mut whole = generate(Kind::General, 40, 3);
    whole.set_sh_degree(3);
    let mut number = 0_u32;
    whole.sh_mut().fill_with(|| {
        number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        number as f32 / u32::MAX as f32 - 0.5
    });
    let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9).normalize();
    let placement = Placement::new(DVec3::new(4.0, -1.0, 2.5), turn, 0.35).expect("numbers");
    let mut placed = whole.clone();
    assert!(placed.place(&placement).is_empty());
    for index in 0..whole.len() {
        let to = placement.to_world(whole.positions()[index].as_dvec3());
        assert!(to.distance(placed.positions()[index].as_dvec3()) < 1e-6);
        for direction in [DVec3::X, DVec3::new(0.6, 0.0, -0.8), DVec3::ONE.normalize()] {
            let [before, after] = [
                seen(&whole, index, direction),
                seen(&placed, index, turn * direction),
            ];
            assert!(before.distance(after) < 1e-6, "{before} {after}");
        }
        let axis = whole.rotations()[index].as_dquat() * DVec3::X;
        let turned = placed.rotations()[index].as_dquat() * DVec3::X;
        assert!((turn * axis).distance(turned) < 1e-6);
    }
}

/// A needle, a disc and a round one, each turned in its own way.
fn shapes() -> Gaussians {
    let mut shapes = Gaussians::default();
    for (number, scale) in [[1e3, 1e-3, 2e-3], [1.0, 1.0, 0.0], [0.5; 3]]
        .into_iter()
        .enumerate()
    {
        let turn = DQuat::from_xyzw(0.3, -0.5, 0.2 * number as f64, 0.9).normalize();
        shapes.push(Vec3::X, scale.into(), turn.as_quat(), 0.5, &[0.0; 3]);
    }
    shapes
}

#[test]
fn covariances_follow_any_matrix() {
    let turn = DMat3::from_quat(DQuat::from_xyzw(0.1, 0.2, -0.7, 0.4).normalize());
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::Z);
    let flat = DMat3::from_diagonal(DVec3::new(1.0, 3.0, 0.0));
    let line = DMat3::from_diagonal(DVec3::X);
    for matrix in [
        turn,
        -turn,
        shear,
        shear * turn,
        turn * flat * shear,
        turn * line,
        DMat3::ZERO,
    ] {
        let (before, mut after) = (shapes(), shapes());
        assert!(after.transform(&DAffine3::from_mat3(matrix)).is_empty());
        after.check().expect("whole Gaussians");
        for at in 0..before.len() {
            // By the deviation in each direction, which keeps the digits of needles.
            let along = |gaussians: &Gaussians, to: DVec3| {
                let axes = DMat3::from_quat(gaussians.rotations()[at].as_dquat());
                (gaussians.scales()[at].as_dvec3() * (axes.transpose() * to)).length()
            };
            for to in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE] {
                let (expected, found) =
                    (along(&before, matrix.transpose() * to), along(&after, to));
                let size = after.scales()[at].max_element();
                let error = (expected - found).abs() / f64::from(size).max(1e-9);
                assert!(error < 1e-6, "{matrix} {at} {to}: {expected} {found}");
            }
        }
    }
    // The short axes of a needle keep their lengths, whatever turns it.
    let mut needle = shapes();
    assert!(needle.transform(&DAffine3::from_mat3(-turn)).is_empty());
    for axis in 0..3 {
        let [before, after] = [&shapes(), &needle].map(|all| all.scales()[0][axis]);
        assert!((after / before - 1.0).abs() < 1e-6, "{before} {after}");
    }
}

#[test]
fn a_transform_by_a_placement_is_the_placement() {
    let mut placed = generate(Kind::General, 40, 3);
    placed.set_sh_degree(3);
    let mut transformed = placed.clone();
    let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9).normalize();
    let placement = Placement::new(DVec3::new(4.0, -1.0, 2.5), turn, 0.35).expect("numbers");
    let affine =
        DAffine3::from_scale_rotation_translation(DVec3::splat(0.35), turn, placement.position());
    assert!(placed.place(&placement).is_empty() && transformed.transform(&affine).is_empty());
    for at in 0..placed.len() {
        let [a, b] = [&placed, &transformed];
        assert!(a.positions()[at].distance(b.positions()[at]) < 1e-6);
        assert!(a.scales()[at].distance(b.scales()[at]) < 1e-6);
        assert!(a.rotations()[at].dot(b.rotations()[at]).abs() > 1.0 - 1e-6);
        let apart = a
            .sh_of(at)
            .iter()
            .zip(b.sh_of(at))
            .map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f32::max) < 1e-6);
    }
    assert_eq!(
        placed
            .transform(&DAffine3::from_scale(DVec3::splat(f64::NAN)))
            .len(),
        40
    );
}

#[test]
fn half_turns_there_and_back_change_nothing() {
    let mut whole = generate(Kind::General, 40, 3);
    whole.set_sh_degree(3);
    let half = DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0);
    let mut placed = whole.clone();
    for turn in [half, half.inverse()] {
        let placement = Placement::new(DVec3::ZERO, turn, 1.0).expect("numbers");
        assert!(placed.place(&placement).is_empty());
    }
    assert_eq!(placed, whole);
}

#[test]
fn what_cannot_be_held_where_it_is_placed_is_dropped() {
    let mut whole = generate(Kind::General, 5, 3);
    whole.positions_mut().fill(DVec3::X.as_vec3());
    whole.positions_mut()[1] *= 10.0;
    whole.positions_mut()[2] = DVec3::ZERO.as_vec3();
    whole.scales_mut()[2].x = 10.0;
    let kept = [0, 3, 4].map(|at| whole.sh_of(at).to_vec()).concat();
    let placement = Placement::new(DVec3::ZERO, DQuat::IDENTITY, 1e38).expect("numbers");
    assert_eq!(whole.place(&placement), [1, 2]);
    assert_eq!((whole.len(), whole.sh()), (3, &kept[..]));
    assert!(whole.positions().iter().all(|at| at.is_finite()));
}
