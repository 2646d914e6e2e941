use super::*;
use crate::mesh::faces::Faces;

fn refusal((vertices, faces): &Triangles, rule: MeshRule) -> String {
    match Mesh::from_triangles(vertices, faces, rule) {
        Ok(mesh) => panic!("{mesh:?} is no error"),
        Err(error) => error.to_string(),
    }
}

pub(super) fn cube() -> Triangles {
    shapes::cuboid(DVec3::ZERO, DVec3::ONE)
}

fn winding((vertices, faces): &Triangles) -> Mesh {
    Mesh::from_triangles(vertices, faces, MeshRule::Winding).expect("faces")
}

#[test]
fn holes_are_named_by_an_edge() {
    let mut open = cube();
    open.1.pop();
    assert_eq!(
        refusal(&open, MeshRule::Closed),
        "the mesh is not closed: the edge from (0, 0, 1) to (0, 1, 1) has 1 face, and should have one on either side; it is the \
         first of 3 like it; fill the holes, or have its inside decided by the winding number, which closes them"
    );
    let closed = winding(&open);
    assert_eq!(closed.report().closed, 3);
    assert_eq!(
        closed.report().to_string(),
        "closed 3 open edges, each to the middle of its hole"
    );
    assert!(closed.keeps(DVec3::splat(0.99)) && !closed.keeps(DVec3::splat(1.01)));
}

#[test]
fn fins_are_named() {
    let mut fin = cube();
    fin.0.push(DVec3::splat(3.0));
    fin.1.push([0, 1, 8]);
    let error = refusal(&fin, MeshRule::Closed);
    assert!(
        error.contains("the edge from (0, 0, 0) to (1, 0, 0) has 3 faces"),
        "{error}"
    );
    assert!(error.contains("the first of 3 like it"), "{error}");
}

#[test]
fn open_meshes_are_closed_as_the_winding_number_has_them() {
    let mut random = Random::new(50);
    let mut open = shapes::icosphere(3);
    // Cut level through a ring of vertices, so that the hole is nearly flat.
    open.1
        .retain(|face| face.iter().any(|at| open.0[*at as usize].z < 0.5));
    let whole = winding(&open);
    assert!(whole.report().closed > 10, "{}", whole.report());
    let faces_at = |vertex: &u32| {
        let all = whole.faces().iter();
        all.filter(|face| face.contains(vertex)).count()
    };
    let middle = (0..whole.vertices().len() as u32)
        .max_by_key(faces_at)
        .expect("vertices");
    for _ in 0..400 {
        let point = point_near(&whole, &mut random);
        let mut angles = by_angles(&whole, point);
        assert!((angles - angles.round()).abs() < 1e-6, "it is closed");
        // Without the faces that close it.
        let rest = Mesh::clone(&whole);
        let caps = rest.faces().iter().filter(|face| face.contains(&middle));
        for face in caps {
            let [a, b, c] = face.map(|at| rest.vertices()[at as usize] - point);
            let [la, lb, lc] = [a, b, c].map(DVec3::length);
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            angles -= a.dot(b.cross(c)).atan2(below) / std::f64::consts::TAU;
        }
        if (angles - 0.5).abs() > 0.12 {
            assert_eq!(whole.keeps(point), angles > 0.5, "{point}: {angles}");
        }
    }
}

#[test]
fn faces_are_turned_outward() {
    let mut random = Random::new(51);
    for (name, mesh) in all() {
        let mut faces = mesh.faces().to_vec();
        let mut turned = 0;
        for face in &mut faces {
            if random.unit() < 0.4 {
                face.swap(0, 1);
                turned += 1;
            }
        }
        let mended = Mesh::from_triangles(mesh.vertices(), &faces, MeshRule::Closed).expect(name);
        assert_eq!(mended.report().turned, turned, "{name}");
        for _ in 0..50 {
            let point = point_near(&mesh, &mut random);
            assert_eq!(mended.winding(point), mesh.winding(point), "{name}");
        }
        // All of it inside out.
        let inverted: Vec<_> = mesh.faces().iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        let mended =
            Mesh::from_triangles(mesh.vertices(), &inverted, MeshRule::Closed).expect(name);
        assert_eq!(mended.report().turned as usize, inverted.len(), "{name}");
        let kept = Mesh::from_triangles(mesh.vertices(), &inverted, MeshRule::Winding).expect(name);
        assert_eq!(kept.report().turned, 0);
        let point = point_near(&mesh, &mut random);
        assert_eq!(kept.winding(point), -mesh.winding(point), "{name}");
    }
}

#[test]
fn meshes_that_cut_themselves_are_refused_by_place() {
    let mut crossed = cube();
    shapes::join(
        &mut crossed,
        shapes::cuboid(DVec3::splat(0.5), DVec3::splat(1.5)),
    );
    let error = refusal(&crossed, MeshRule::Closed);
    assert!(
        error.starts_with("the mesh cuts itself: the face with the corners ("),
        "{error}"
    );
    assert!(
        error.contains("it is the first of ") && error.contains("winding number"),
        "{error}"
    );
    let both = winding(&crossed);
    assert_eq!(both.winding(DVec3::splat(0.75)), 2);
    assert!(both.keeps(DVec3::splat(0.75)) && both.keeps(DVec3::splat(0.25)));
    // Through edges and corners exactly, and in one plane.
    for (low, high) in [
        (DVec3::new(0.25, -1.0, 0.25), DVec3::new(0.75, 2.0, 0.75)),
        (DVec3::new(0.0, 0.0, 0.5), DVec3::new(1.0, 1.0, 1.5)),
        (DVec3::new(0.25, 0.25, 1.0), DVec3::new(0.75, 0.75, 2.0)),
        (DVec3::new(-1.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 1.0)),
    ] {
        let mut shape = cube();
        shapes::join(&mut shape, shapes::cuboid(low, high));
        let error = refusal(&shape, MeshRule::Closed);
        assert!(
            error.starts_with("the mesh cuts itself"),
            "{low} {high}: {error}"
        );
    }
    // One vertex pulled through the other side.
    let mut star = shapes::star(500, 4);
    star.0[100] *= -3.0;
    assert!(refusal(&star, MeshRule::Closed).starts_with("the mesh cuts itself"));
}

#[test]
fn shells_may_touch_in_corners_and_edges() {
    for to in [
        DVec3::ONE,
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(-1.0, 0.0, -1.0),
    ] {
        let mut shape = cube();
        shapes::join(&mut shape, shapes::cuboid(to, to + 1.0));
        let made = mesh(shape);
        assert_eq!(made.report().shells, 2, "{to}");
        assert!(made.keeps(DVec3::splat(0.5)) && made.keeps(to + 0.5));
        assert_eq!(made.winding(to + DVec3::new(0.5, 0.5, 1.5)), 0);
    }
    // A corner that touches the middle of a face.
    let mut shape = cube();
    let tip = shapes::cuboid(DVec3::ZERO, DVec3::splat(0.2));
    let turn = glam::DMat3::from_quat(glam::DQuat::from_rotation_arc(
        DVec3::ONE.normalize(),
        DVec3::Z,
    ));
    let moved = tip
        .0
        .iter()
        .map(|at| turn * *at + DVec3::new(0.5, 0.375, 1.0));
    shapes::join(&mut shape, (moved.collect(), tip.1));
    assert_eq!(mesh(shape).report().shells, 2);
}

#[test]
fn a_surface_of_one_side_is_refused() {
    // The projective plane of six vertices, a closed surface that has one side only.
    let faces = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 5, 1],
        [1, 2, 4],
        [2, 3, 5],
        [3, 4, 1],
        [4, 5, 2],
        [5, 1, 3],
    ];
    let mut random = Random::new(52);
    let vertices = (0..6).map(|_| random.in_ball()).collect();
    let error = refusal(&(vertices, faces.into()), MeshRule::Closed);
    assert!(
        error.starts_with("the mesh has one side only, as a Moebius strip has"),
        "{error}"
    );
}

#[test]
fn wrong_numbers_are_named() {
    let mut wrong = cube();
    wrong.1[3][1] = 12;
    assert_eq!(
        refusal(&wrong, MeshRule::Closed),
        "face 3 names vertex 12, and there are 8; export the mesh again"
    );
    for bad in [f64::NAN, f64::INFINITY, 1e31] {
        let mut wrong = cube();
        wrong.0[7].y = bad;
        let error = refusal(&wrong, MeshRule::Winding);
        assert!(
            error.contains("has a corner at (1, ") && error.contains("not finite or beyond 1e30"),
            "{error}"
        );
    }
    for rule in [MeshRule::Closed, MeshRule::Winding] {
        let error = refusal(&(Vec::new(), Vec::new()), rule);
        assert_eq!(error, "the mesh has no faces with an area; export it again");
        assert_eq!(rule.to_string().parse::<MeshRule>().expect("a rule"), rule);
    }
    let error = "open".parse::<MeshRule>().expect_err("no rule").to_string();
    assert_eq!(error, "there is no 'open'; give one of closed, winding");
}

#[test]
fn shapes_have_as_many_faces_as_they_say() {
    assert_eq!(shapes::icosphere(3).1.len(), 20 * 64);
    for faces in [12, 100, 5_000] {
        let made = mesh(shapes::star(faces, 9)).faces().len() as f64;
        assert!(
            (0.7..1.4).contains(&(made / f64::from(faces))),
            "{made} of {faces}"
        );
    }
    let fan = mesh(shapes::needle_fan(40));
    let tip = fan
        .vertices()
        .iter()
        .position(|at| at.z > 0.05)
        .expect("a tip") as u32;
    assert_eq!(
        fan.faces()
            .iter()
            .filter(|face| face.contains(&tip))
            .count(),
        40
    );
}

#[test]
fn many_faces_at_a_vertex_take_no_long_time() {
    let fan = mesh(shapes::needle_fan(1_000));
    assert!(fan.keeps(DVec3::new(0.1, 0.2, 0.01)));
    let (vertices, faces) = (fan.vertices().to_vec(), fan.faces().to_vec());
    let crowded = crate::mesh::meet::check(&Faces { vertices, faces }, fan.tree(), 1_000);
    let error = crowded.expect_err("a limit");
    assert!(
        error.starts_with("so many faces of the mesh lie beside each other that it takes too long"),
        "{error}"
    );
}
