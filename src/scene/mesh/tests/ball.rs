use super::*;
use glam::{DMat3, DQuat};

/// Random axes, of lengths from 1 to 1e-3, orthogonal or not.
fn axes(random: &mut Random, size: f64) -> DMat3 {
    let length = |random: &mut Random| size * 10.0_f64.powf(random.range(-3.0, 0.0));
    let lengths = DVec3::new(length(random), length(random), length(random));
    let turn = DMat3::from_quat(DQuat::from_rotation_arc(DVec3::X, random.direction()));
    let skew = DMat3::from_cols(random.in_ball(), random.in_ball(), random.in_ball());
    let shear = if random.unit() < 0.5 {
        DMat3::ZERO
    } else {
        0.3 * skew
    };
    turn * (DMat3::IDENTITY + shear) * DMat3::from_diagonal(lengths)
}

/// How many deviations off a face is, by steps along two edges.
fn deviations_off(corners: [DVec3; 3], centre: DVec3, axes: DMat3) -> f64 {
    let [a, b, c] = corners.map(|corner| axes.inverse() * (corner - centre));
    super::super::near::nearest_to_origin([a, b, c]).length()
}

#[test]
fn faces_in_an_ellipsoid_are_those_of_all() {
    let mut random = Random::new(40);
    for (name, mesh) in all() {
        let mut touched = 0;
        for _ in 0..200 {
            let centre = point_near(&mesh, &mut random);
            let axes = axes(&mut random, 0.3 * mesh.scale());
            let deviations = random.range(0.1, 3.0);
            let faces = 0..mesh.faces().len() as u32;
            let expected: Vec<u32> = faces
                .filter(|face| deviations_off(mesh.corners(*face), centre, axes) <= deviations)
                .collect();
            let mut found = Vec::new();
            mesh.faces_in_ball(centre, axes, deviations, &mut found);
            assert_eq!(found, expected, "{name}");
            assert_eq!(
                mesh.touches_ball(centre, axes, deviations),
                !expected.is_empty(),
                "{name}"
            );
            touched += usize::from(!expected.is_empty());
        }
        assert!(touched > 0, "{name} is touched");
    }
}

#[test]
fn the_nearest_point_of_a_face_is_on_it_and_nearest() {
    let mut random = Random::new(41);
    for _ in 0..2_000 {
        let mut corners = [0; 3].map(|_| random.in_ball() + 0.5 * random.direction());
        match (random.unit() * 4.0) as u32 {
            0 => corners[2] = corners[0].lerp(corners[1], random.unit()), // hardly an area
            1 => corners[1] = corners[0],
            _ => {}
        }
        let nearest = super::super::near::nearest_to_origin(corners);
        for at in 0..=20 {
            for along in 0..=20 - at {
                let (u, v) = (f64::from(at) / 20.0, f64::from(along) / 20.0);
                let other = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                assert!(nearest.length() <= other.length() + 1e-12, "{corners:?}");
            }
        }
        let off = super::super::near::nearest_to_origin(corners.map(|corner| corner - nearest));
        assert!(
            off.length() < 1e-9,
            "{corners:?}: {nearest} is {} off",
            off.length()
        );
    }
}

#[test]
fn flat_ellipsoids_touch_what_they_reach() {
    let mesh = mesh(shapes::cuboid(-DVec3::ONE, DVec3::ONE));
    let disc = DMat3::from_diagonal(DVec3::new(0.4, 0.4, 0.0));
    let line = DMat3::from_diagonal(DVec3::new(0.0, 0.0, 0.4));
    assert!(!mesh.touches_ball(DVec3::ZERO, disc, 2.0));
    assert!(mesh.touches_ball(DVec3::ZERO, disc, 2.6));
    assert!(!mesh.touches_ball(DVec3::ZERO, line, 2.0));
    assert!(mesh.touches_ball(DVec3::ZERO, line, 2.6));
    assert!(!mesh.touches_ball(DVec3::ZERO, DMat3::ZERO, 3.0));
    assert!(mesh.touches_ball(DVec3::X, DMat3::ZERO, 3.0));
    let skewed = DMat3::from_cols(DVec3::X, DVec3::X, DVec3::X);
    assert!(mesh.touches_ball(DVec3::ZERO, skewed, 1.0));
    assert!(!mesh.touches_ball(DVec3::ZERO, skewed, 0.5));
}
