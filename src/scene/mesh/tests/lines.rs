use super::*;

/// The crossings in order along the line.
fn crossings(mesh: &Mesh, origin: DVec3, direction: DVec3) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    mesh.crossings(origin, direction, &mut found);
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Checks that a line goes into the mesh as often as it comes out.
fn check_balance(name: &str, mesh: &Mesh, origin: DVec3, direction: DVec3) -> usize {
    let found = crossings(mesh, origin, direction);
    let sum: f64 = found.iter().map(|crossing| crossing.1).sum();
    assert_eq!(
        sum, 0.0,
        "{name} from {origin} along {direction}: {found:?}"
    );
    found.len()
}

#[test]
fn lines_go_out_as_often_as_in() {
    let mut random = Random::new(20);
    for (name, mesh) in all() {
        let special = special_points(&mesh, &mut random);
        let mut crossed = 0;
        for pair in special.windows(2) {
            // Through one vertex, edge or face, and through two; along axes and edges too.
            let eye = point_near(&mesh, &mut random) + 3.0 * mesh.scale() * random.direction();
            crossed += check_balance(name, &mesh, eye, pair[0] - eye);
            check_balance(name, &mesh, pair[0], pair[1] - pair[0]);
            check_balance(name, &mesh, pair[0], random.direction());
            for axis in DVec3::AXES {
                check_balance(name, &mesh, pair[0], axis);
                check_balance(name, &mesh, pair[0] - 5.0 * axis, -1e-3 * axis);
            }
            check_balance(name, &mesh, pair[0], DVec3::new(1.0, -1.0, 1.0));
            check_balance(
                name,
                &mesh,
                pair[0] + 1e3 * random.direction(),
                random.direction(),
            );
        }
        assert!(
            crossed > special_points(&mesh, &mut random).len(),
            "{name} is crossed"
        );
        for face in 0..mesh.faces().len().min(500) as u32 {
            let [a, b, _] = mesh.corners(face);
            check_balance(name, &mesh, a, b - a);
            check_balance(name, &mesh, 0.5 * (a + b), a - b);
        }
    }
}

#[test]
fn between_crossings_the_winding_is_their_sum() {
    let mut random = Random::new(21);
    for (name, mesh) in all() {
        for _ in 0..200 {
            let (from, to) = (
                point_near(&mesh, &mut random),
                point_near(&mesh, &mut random),
            );
            let found = crossings(&mesh, from, to - from);
            let mut winding = 0.0;
            for pair in found.windows(2) {
                winding += pair[0].1;
                if pair[1].0 - pair[0].0 > 1e-7 {
                    let middle = from.lerp(to, 0.5 * (pair[0].0 + pair[1].0));
                    let expected = f64::from(mesh.winding(middle));
                    assert_eq!(
                        winding, expected,
                        "{name} between {pair:?} from {from} to {to}"
                    );
                }
            }
        }
    }
}

#[test]
fn crossings_are_on_the_surface() {
    let mut random = Random::new(22);
    for (name, mesh) in all() {
        for _ in 0..100 {
            let from = point_near(&mesh, &mut random);
            let direction = mesh.scale() * random.direction();
            for (t, _) in crossings(&mesh, from, direction) {
                let distance = mesh.signed_distance(from + t * direction).abs();
                let size = mesh.scale() + 1e-4 * from.length();
                assert!(distance < 1e-11 * size, "{name}: {distance} off at {t}");
            }
        }
    }
}

#[test]
fn the_tree_leaves_out_no_face() {
    let mut random = Random::new(23);
    for (name, mesh) in all() {
        for _ in 0..60 {
            let from = point_near(&mesh, &mut random);
            let direction = random.direction();
            let mut alone = Vec::new();
            let line = super::super::lines::Line::new(from, direction).expect("a line");
            for face in 0..mesh.faces().len() as u32 {
                alone.extend(line.crossing(mesh.corners(face)));
            }
            alone.sort_by(|a, b| a.0.total_cmp(&b.0));
            let found = crossings(&mesh, from, direction);
            let times = |all: &[(f64, f64)]| all.iter().map(|one| one.0).collect::<Vec<_>>();
            assert_eq!(times(&found), times(&alone), "{name}");
        }
    }
}

#[test]
fn a_sphere_is_crossed_where_it_is() {
    let mesh = mesh(shapes::icosphere(5));
    let mut random = Random::new(24);
    for _ in 0..300 {
        let (direction, beside) = (random.direction(), random.in_ball());
        let off = beside - direction * direction.dot(beside);
        if off.length() > 0.95 {
            continue;
        }
        let found = crossings(&mesh, off, direction);
        let half = (1.0 - off.length_squared()).sqrt();
        assert_eq!(found.len(), 2);
        assert!((found[0].0 + half).abs() < 0.01 && (found[1].0 - half).abs() < 0.01);
        assert_eq!((found[0].1, found[1].1), (1.0, -1.0));
    }
}

#[test]
fn lines_that_are_none_cross_nothing() {
    let mesh = mesh(shapes::icosphere(1));
    for direction in [
        DVec3::ZERO,
        DVec3::NAN,
        DVec3::INFINITY,
        DVec3::new(1.0, f64::NAN, 0.0),
    ] {
        assert!(crossings(&mesh, DVec3::ZERO, direction).is_empty());
    }
    for origin in [
        DVec3::NAN,
        DVec3::splat(f64::MAX),
        DVec3::splat(f64::INFINITY),
    ] {
        crossings(&mesh, origin, DVec3::ONE);
        mesh.winding(origin);
        mesh.signed_distance(origin);
        mesh.gradient(origin);
    }
}
