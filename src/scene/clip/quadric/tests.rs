use super::*;

#[test]
fn a_quadric_measures_distances_near_its_surface() {
    let centre = DVec3::new(1.0, -2.0, 0.5);
    let sphere = Quadric::sphere(centre, 3.0).unwrap();
    let direction = DVec3::new(2.0, 1.0, -2.0) / 3.0;
    for away in [-1e-3, 0.0, 1e-3] {
        let distance = sphere.distance(centre + (3.0 + away) * direction);
        assert!((distance + away).abs() < 1e-6, "{distance}");
    }
    let cylinder = Quadric::cylinder(centre, centre + direction, 0.5).unwrap();
    let side = centre + 7.0 * direction + 0.5 * direction.any_orthonormal_vector();
    assert!(cylinder.distance(side).abs() < 1e-12);
    let cone = Quadric::cone(centre, centre + 2.0 * direction, 1.0).unwrap();
    let side = centre + direction + 0.5 * direction.any_orthonormal_vector();
    assert!(cone.distance(side).abs() < 1e-12 && cone.distance(centre + direction) > 0.0);
}

#[test]
fn an_anchor_changes_numbers_and_not_the_surface() {
    let huge = Quadric::sphere(DVec3::new(0.0, 0.0, 1e6), 1e6).unwrap();
    let near = huge.anchored(DVec3::new(3.0, 1.0, -2.0));
    for point in [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)] {
        assert!((huge.distance(point) - near.distance(point)).abs() < 1e-9);
    }
    assert!(near.linear().distance(DVec3::Z) < 1e-5);
}

#[test]
fn what_has_no_size_is_refused() {
    assert!(Quadric::sphere(DVec3::ZERO, 0.0).is_err());
    assert!(Quadric::sphere(DVec3::ZERO, f64::NAN).is_err());
    assert!(Quadric::sphere(DVec3::NAN, 1.0).is_err());
    assert!(Quadric::cylinder(DVec3::ONE, DVec3::ONE, 1.0).is_err());
    assert!(Quadric::cone(DVec3::ZERO, DVec3::X, -1.0).is_err());
    let none = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    assert!(Quadric::ellipsoid(DVec3::ZERO, DVec3::ONE, none).is_err());
}
