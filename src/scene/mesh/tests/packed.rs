use super::*;
use glam::Vec3;

#[test]
fn single_precision_has_the_same_inside() {
    let mut random = Random::new(30);
    for (name, mesh) in all() {
        let packed = mesh.packed();
        assert_eq!(packed.faces() as usize, mesh.faces().len());
        for _ in 0..500 {
            let point = mesh.to_unit(point_near(&mesh, &mut random)).as_vec3();
            let exact = mesh.centre() + mesh.scale() * point.as_dvec3();
            if mesh.signed_distance(exact).abs() > 2e-6 * mesh.scale() {
                assert_eq!(
                    packed.winding(point),
                    mesh.winding(exact),
                    "{name} at {point}"
                );
            }
        }
    }
}

#[test]
fn single_precision_lets_no_line_through() {
    let mut random = Random::new(31);
    for (name, mesh) in all() {
        let packed = mesh.packed();
        let mut found = Vec::new();
        let mut check = |origin: Vec3, direction: Vec3| {
            found.clear();
            packed.crossings(origin, direction, &mut found);
            let sum: f32 = found.iter().map(|crossing| crossing.1).sum();
            assert_eq!(
                sum, 0.0,
                "{name} from {origin} along {direction}: {found:?}"
            );
            found.len()
        };
        let mut crossed = 0;
        for face in 0..packed.faces().min(400) {
            let [a, b, c] = packed.corners(face);
            let eye = 2.0 * random.direction().as_vec3();
            for at in [a, 0.5 * (a + b), (a + b + c) / 3.0] {
                crossed += check(eye, at - eye);
                crossed += check(at, eye - at);
                for axis in Vec3::AXES {
                    check(at, axis);
                }
            }
            check(a, b - a);
            check(b, a - c);
            check(100.0 * eye, a - 100.0 * eye);
        }
        assert!(crossed > 0, "{name} is crossed");
    }
}

#[test]
fn boxes_hold_faces_in_both_precisions() {
    for (name, mesh) in all() {
        let packed = mesh.packed();
        let mut at = 0;
        while let Some(node) = packed.node(at) {
            let exact = mesh.tree().nodes()[at as usize];
            let (low, high) = (mesh.to_unit(exact.low), mesh.to_unit(exact.high));
            assert!(node.low.as_dvec3().cmple(low).all(), "{name}");
            assert!(node.high.as_dvec3().cmpge(high).all(), "{name}");
            for face in node.first..node.first + node.count {
                for (corner, exact) in packed.corners(face).into_iter().zip(mesh.corners(face)) {
                    assert_eq!(corner, mesh.to_unit(exact).as_vec3(), "{name}");
                    assert!(
                        corner.cmpge(node.low).all() && corner.cmple(node.high).all(),
                        "{name}"
                    );
                }
            }
            at += 1;
        }
        assert_eq!(at as usize, mesh.tree().nodes().len(), "{name}");
    }
}

#[test]
fn a_face_takes_at_most_sixty_bytes() {
    for (name, mesh) in all() {
        let bytes = 16 * mesh.packed().quads.len() - 32;
        assert!(bytes <= 60 * mesh.faces().len(), "{name}: {bytes} bytes");
    }
}
