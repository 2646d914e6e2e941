use super::*;
use crate::{Kind, generate};

/// The opacity of a Gaussian at a point.
fn opacity_at(gaussians: &Gaussians, index: usize, point: DVec3) -> f64 {
    let turned = gaussians.rotations()[index]
        .as_dquat()
        .normalize()
        .inverse()
        * (point - gaussians.positions()[index].as_dvec3());
    let unit = turned / gaussians.scales()[index].as_dvec3();
    f64::from(gaussians.opacities()[index]) * (-0.5 * unit.length_squared()).exp()
}

/// The same of a flat one, at a point of its plane.
fn opacity_on_plane(flat: &Gaussians, index: usize, point: DVec3) -> f64 {
    let turned = flat.rotations()[index].as_dquat().normalize().inverse()
        * (point - flat.positions()[index].as_dvec3());
    let unit = turned.truncate() / flat.scales()[index].as_dvec3().truncate();
    f64::from(flat.opacities()[index]) * (-0.5 * unit.length_squared()).exp()
}

#[test]
fn on_the_plane_a_cross_section_is_as_opaque_as_the_gaussian() {
    let gaussians = generate(Kind::General, 400, 5);
    let plane = Plane::new(DVec3::new(0.4, -0.7, 0.6), 0.13).expect("a normal");
    let mut compared = 0;
    for index in 0..gaussians.len() {
        let mut one = Gaussians::default();
        one.set_sh_degree(gaussians.sh_degree());
        one.push(
            gaussians.positions()[index],
            gaussians.scales()[index],
            gaussians.rotations()[index],
            gaussians.opacities()[index],
            gaussians.sh_of(index),
        );
        let flat = cross_section(&one, &plane);
        if flat.is_empty() {
            continue;
        }
        assert_eq!(flat.sh_of(0), gaussians.sh_of(index));
        let middle = flat.positions()[0].as_dvec3();
        let reach = f64::from(flat.scales()[0].max_element());
        for step in 0..8 {
            let (sine, cosine) = f64::from(step).sin_cos();
            let aside = plane.normal().any_orthonormal_vector() * cosine
                + plane
                    .normal()
                    .cross(plane.normal().any_orthonormal_vector())
                    * sine;
            let point = middle + aside * reach * 0.3 * f64::from(step);
            let point = point - plane.normal() * plane.distance(point);
            let (there, whole) = (
                opacity_on_plane(&flat, 0, point),
                opacity_at(&one, 0, point),
            );
            assert!(
                (there - whole).abs() < 1e-3,
                "{index}: {there} against {whole}"
            );
            compared += 1;
        }
    }
    assert!(compared > 400, "{compared}");
}

#[test]
fn what_the_plane_does_not_reach_is_left_out() {
    let mut gaussians = Gaussians::default();
    for (z, scale) in [(0.0, 0.1), (2.0, 0.1), (0.0, 0.0), (1e-3, 0.0)] {
        let size = glam::Vec3::new(0.3, 0.2, scale);
        gaussians.push(
            glam::Vec3::Z * z,
            size,
            glam::Quat::IDENTITY,
            0.9,
            &[0.1, 0.2, 0.3],
        );
    }
    let plane = Plane::new(DVec3::Z, 0.0).expect("a normal");
    // A Gaussian without thickness that lies in the plane has no cross-section: its density there has no bound.
    assert_eq!(cross_section(&gaussians, &plane).len(), 1);
    let across = Plane::new(DVec3::X, 0.0).expect("a normal");
    assert_eq!(cross_section(&gaussians, &across).len(), 4);
}
