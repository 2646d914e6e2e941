use super::*;

#[test]
fn winding_is_that_of_the_solid_angles() {
    let mut random = Random::new(7);
    for (name, mesh) in all() {
        let mut inside = 0;
        for _ in 0..400 {
            let point = point_near(&mesh, &mut random);
            let winding = mesh.winding(point);
            let expected = by_angles(&mesh, point);
            assert!(
                (f64::from(winding) - expected).abs() < 1e-6,
                "{name} at {point}: {winding}, not {expected}"
            );
            inside += winding;
        }
        assert!(inside > 0 || name == "a thin sheet", "{name} has an inside");
    }
}

#[test]
fn points_level_with_vertices_edges_and_faces_have_their_winding() {
    let mut random = Random::new(8);
    for (name, mesh) in all() {
        let [low, high] = mesh.bounds();
        let special = special_points(&mesh, &mut random);
        for _ in 0..400 {
            // Each coordinate is one of some vertex, edge or face: the ray goes through those.
            let mut pick = || special[(random.unit() * special.len() as f64) as usize];
            let point = DVec3::new(pick().x, pick().y, pick().z);
            let is_clear = mesh.signed_distance(point).abs() > 1e-6 * (high - low).length();
            if is_clear {
                let expected = by_angles(&mesh, point);
                let winding = mesh.winding(point);
                assert!(
                    (f64::from(winding) - expected).abs() < 1e-4,
                    "{name} at {point}: {winding}, not {expected}"
                );
            }
        }
        // Right above and below vertices, middles of edges and of faces.
        for point in special {
            for step in [-2.0, -0.3, -0.01, 0.01, 0.3, 2.0] {
                let point = point + DVec3::Z * step * mesh.scale();
                if mesh.signed_distance(point).abs() > 1e-6 * mesh.scale() {
                    let expected = by_angles(&mesh, point).round();
                    assert_eq!(
                        f64::from(mesh.winding(point)),
                        expected,
                        "{name} at {point}"
                    );
                }
            }
        }
    }
}

#[test]
fn points_on_the_surface_have_the_winding_of_a_side() {
    let mut random = Random::new(9);
    for (name, mesh) in all() {
        for point in special_points(&mesh, &mut random) {
            assert!([0, 1].contains(&mesh.winding(point)), "{name} at {point}");
        }
    }
    // A grid whose points are all on planes, edges and vertices of a cube, or level with them.
    let cube = mesh(shapes::cuboid(DVec3::ZERO, DVec3::ONE));
    for at in 0..125 {
        let point = 0.5 * DVec3::new((at % 5) as f64, (at / 5 % 5) as f64, (at / 25) as f64) - 0.5;
        let is_in = point.cmpgt(DVec3::ZERO).all() && point.cmplt(DVec3::ONE).all();
        let is_out = point.cmplt(DVec3::ZERO).any() || point.cmpgt(DVec3::ONE).any();
        if is_in || is_out {
            assert_eq!(cube.keeps(point), is_in, "{point}");
        }
    }
}

#[test]
fn spheres_in_each_other_are_inside_by_turns() {
    let mesh = mesh(shapes::nested(4, 3));
    assert_eq!((mesh.report().shells, mesh.report().cavities), (4, 2));
    for (radius, winding) in [(0.05, 0), (0.37, 1), (0.62, 0), (0.87, 1), (1.1, 0)] {
        let direction = Random::new(4).direction();
        assert_eq!(mesh.winding(radius * direction), winding, "{radius}");
    }
}

#[test]
fn distances_of_a_box_are_known() {
    let (low, high) = (DVec3::new(-1.0, -2.0, -0.5), DVec3::new(1.0, 0.5, 2.0));
    let mesh = mesh(shapes::cuboid(low, high));
    let mut random = Random::new(10);
    for _ in 0..500 {
        let point = point_near(&mesh, &mut random) * 1.4;
        let beyond = (low - point).max(point - high);
        let outside = beyond.max(DVec3::ZERO).length();
        let expected = if outside > 0.0 {
            -outside
        } else {
            -beyond.max_element()
        };
        let distance = mesh.signed_distance(point);
        assert!(
            (distance - expected).abs() < 1e-12,
            "{point}: {distance}, not {expected}"
        );
        let step = 1e-6;
        let gradient = mesh.gradient(point);
        let slope = (mesh.signed_distance(point + step * gradient) - distance) / step;
        assert!(
            (gradient.length() - 1.0).abs() < 1e-9 && (slope - 1.0).abs() < 1e-3,
            "{point}: {slope}"
        );
    }
    // On a face the gradient is the normal that points inside.
    assert_eq!(mesh.gradient(DVec3::new(1.0, 0.1, 0.2)), -DVec3::X);
    assert!(mesh.signed_distance(DVec3::new(1.0, 0.1, 0.2)).abs() < 1e-15);
}

#[test]
fn the_nearest_point_is_that_of_all_faces() {
    let mut random = Random::new(11);
    for (name, mesh) in all() {
        for _ in 0..60 {
            let point = point_near(&mesh, &mut random);
            let nearest = mesh.nearest(point).expect("faces");
            let faces = 0..mesh.faces().len() as u32;
            let distances = faces.map(|face| {
                let corners = mesh.corners(face).map(|corner| corner - point);
                super::super::near::nearest_to_origin(corners).length_squared()
            });
            let least = distances.fold(f64::INFINITY, f64::min);
            assert_eq!(nearest.distance_squared, least, "{name} at {point}");
            assert!(
                (nearest.point.distance(point) - least.sqrt()).abs() < 1e-9,
                "{name} at {point}"
            );
        }
    }
}
