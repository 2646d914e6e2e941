use super::*;
use crate::clip::prism::winds_around;
use crate::generate::Random;
use glam::{DMat3, DVec3};

#[test]
fn a_lasso_holds_what_is_seen_in_it() {
    let mut random = Random::new(8);
    let size = (320, 240);
    let (eye, target) = (DVec3::new(1.0, -2.0, -5.0), DVec3::new(0.5, 0.0, 0.0));
    let up = DVec3::new(0.1, -1.0, 0.0);
    let mirrored = |camera: Camera| Camera {
        rotation: DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) * camera.rotation,
        ..camera
    };
    let seen = Camera::look_at(eye, target, up, 50.0, size).unwrap();
    let flat = Camera::orthographic(eye, target, up, 4.0, size).unwrap();
    let ring = [
        (20.0, 30.0),
        (300.0, 10.0),
        (160.0, 100.0),
        (280.0, 230.0),
        (10.0, 200.0),
    ];
    let ring = ring.map(DVec2::from).to_vec();
    let inside = Lasso::new(vec![ring.clone()], true).unwrap();
    let outside = Lasso::new(vec![ring.clone()], false).unwrap();
    for camera in [seen, flat, mirrored(seen), mirrored(flat)] {
        let held = inside.expression(&camera).unwrap();
        let (clip, rest) = (held.clip(), outside.expression(&camera).unwrap().clip());
        let again: Expression = held.to_string().parse().unwrap();
        assert_eq!(again.clip(), clip);
        for _ in 0..500 {
            let point = DVec3::from_array([(); 3].map(|()| random.range(-6.0, 3.0)));
            let p = camera.rotation * (point - camera.eye);
            let across = match camera.projection {
                Projection::Perspective => p.truncate() / p.z,
                Projection::Orthographic => p.truncate(),
            };
            let pixel =
                across * DVec2::new(camera.fx, camera.fy) + DVec2::new(camera.cx, camera.cy);
            let is_before = p.z > 0.0 || camera.projection == Projection::Orthographic;
            let is_held = is_before && winds_around(&ring, pixel);
            assert_eq!(clip.keeps(point), is_held, "{point}");
            assert_eq!(rest.keeps(point), !is_held, "{point}");
        }
    }
}

#[test]
fn lassos_are_read_from_text() {
    let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0)].map(DVec2::from);
    let hole = [(6.0, 1.0), (8.0, 1.0), (8.0, 3.0)].map(DVec2::from);
    let rings = vec![corners.to_vec(), hole.to_vec()];
    for (text, keeps) in [
        ("0,0;9,0;9,9|6,1;8,1;8,3", true),
        (" !0, 0; 9, 0; 9, 9 | 6, 1; 8, 1; 8, 3", false),
    ] {
        let lasso = Lasso::new(rings.clone(), keeps).unwrap();
        assert_eq!(text.parse::<Lasso>().unwrap(), lasso);
    }
    for (text, words) in [
        ("", "corners"),
        ("0,0;9", "'9' is not a corner"),
        ("0,0;32,0", "three corners"),
        ("0,0;9,9;9,0;0,9", "edges that cross"),
    ] {
        let message = text.parse::<Lasso>().unwrap_err().to_string();
        assert!(message.contains(words), "{text}: {message}");
    }
}
