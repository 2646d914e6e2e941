use super::*;
use glam::DVec4;

#[test]
fn near_and_far_are_the_ends() {
    for (near, far) in [(0.1, 1000.0), (1.0, 2.0), (0.5, f64::INFINITY)] {
        let far_enough = far.min(1e12);
        let [ordinary, reversed] = [DepthMap::ordinary, DepthMap::reversed]
            .map(|make| make(near, far).expect("0 < near < far"));
        for (map, ends) in [(ordinary, [0.0, 1.0]), (reversed, [1.0, 0.0])] {
            assert!((map.at(near) - ends[0]).abs() < 1e-12);
            assert!((map.at(far_enough) - ends[1]).abs() < 1e-11);
            assert_eq!(map.at(near / 2.0), ends[0], "kept within the buffer");
            assert_eq!(map.is_reversed(), ends[0] == 1.0);
        }
    }
    for (near, far) in [(0.0, 1.0), (1.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0)] {
        assert!(DepthMap::ordinary(near, far).is_err(), "{near} {far}");
    }
}

#[test]
fn orthographic_depths_are_linear_between_their_ends() {
    for (zero, one) in [(-2.0, 6.0), (6.0, -2.0)] {
        let map = DepthMap::orthographic(zero, one).expect("two depths");
        let values = [zero, one, 2.0, 2.0 * zero - one].map(|z| map.at(z));
        assert_eq!(values, [0.0, 1.0, 0.5, 0.0], "kept within the buffer");
        assert_eq!(map.is_reversed(), one < zero);
        assert!(map.check(Projection::Orthographic).is_ok());
        assert!(map.check(Projection::Perspective).is_err());
    }
    for (zero, one) in [(1.0, 1.0), (0.0, f64::INFINITY), (f64::NAN, 1.0)] {
        assert!(DepthMap::orthographic(zero, one).is_err(), "{zero} {one}");
    }
}

#[test]
fn a_projection_matrix_says_the_same() {
    // Focal lengths do not matter; the view looks along -z in the first and along +z in the second.
    let matrix = |z: f64, offset: f64, w: f64| {
        let (x, y) = (DVec4::X * 1.3, DVec4::Y * 0.9);
        DMat4::from_cols(x, y, DVec4::new(0.1, 0.0, z, w), DVec4::Z * offset)
    };
    let (near, far) = (0.1, 50.0);
    let away = matrix(far / (near - far), near * far / (near - far), -1.0);
    let turned = matrix(near / (near - far), near * far / (far - near), 1.0);
    let [map, reversed] =
        [away, turned].map(|matrix| DepthMap::of_projection(&matrix).expect("perspective"));
    assert!(map.at(near) < 1e-12 && map.at(far) > 1.0 - 1e-12);
    for z in [near, 0.7, 12.0, far] {
        let clip = away * DVec4::new(0.3, -0.2, -z, 1.0);
        assert!((map.at(z) - clip.z / clip.w).abs() < 1e-12);
        let clip = turned * DVec4::new(0.3, -0.2, z, 1.0);
        assert!((reversed.at(z) - clip.z / clip.w).abs() < 1e-12);
    }
    assert!(reversed.is_reversed() && !map.is_reversed());
    let flat = DMat4::from_scale(glam::DVec3::new(1.0, 1.0, 0.1));
    assert!(DepthMap::of_projection(&flat).is_err());
}

#[test]
fn a_scene_of_another_scale_has_the_same_depths() {
    let map = DepthMap::reversed(0.1, 100.0).expect("0 < near < far");
    let placement = Placement::new(glam::DVec3::ONE, glam::DQuat::IDENTITY, 4.0);
    let placement = placement.expect("a scale");
    assert_eq!(map.in_scene(&placement).at(2.0), map.at(8.0));
    let flat = DepthMap::orthographic(-3.0, 13.0).expect("two depths");
    assert_eq!(flat.in_scene(&placement).at(2.0), flat.at(8.0));
}
