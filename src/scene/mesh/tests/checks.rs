use super::*;

fn refusal((vertices, faces): &Triangles, rule: MeshRule) -> String {
    match Mesh::from_triangles(vertices, faces, rule) {
        Ok(mesh) => panic!("{mesh:?} is no error"),
        Err(error) => error.to_string(),
    }
}

fn cube() -> Triangles {
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
    for _ in 0..400 {
        let point = point_near(&whole, &mut random);
        let mut angles = by_angles(&whole, point);
        assert!((angles - angles.round()).abs() < 1e-6, "it is closed");
        // Without the faces that close it.
        let rest = Mesh::clone(&whole);
        let middle = rest.vertices().len() as u32 - 1;
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
fn degenerate_and_duplicate_faces_are_dropped() {
    let mut shape = cube();
    let own = shape.1.len();
    shape
        .0
        .extend([DVec3::ZERO, DVec3::new(-0.0, 0.0, -0.0), DVec3::splat(9.0)]);
    shape.1.extend([
        [0, 8, 9],
        [3, 3, 1],
        shape.1[4],
        [shape.1[5][0], shape.1[5][2], shape.1[5][1]],
    ]);
    // Two vertices at a corner's place, and one that no face has.
    shape.1[0] = shape.1[0].map(|at| if at == 0 { 8 } else { at });
    let made = mesh(shape);
    assert_eq!((made.faces().len(), made.vertices().len()), (own, 8));
    let report = made.report();
    assert_eq!(
        (report.degenerate, report.duplicate, report.welded),
        (2, 2, 2)
    );
    assert_eq!(
        report.to_string(),
        "dropped 2 faces without an area; dropped 2 faces that another has the corners of"
    );
    assert!(!report.is_clean() && mesh(cube()).report().is_clean());
    assert_eq!(
        mesh(cube()).report().to_string(),
        "nothing dropped or repaired"
    );
}

#[test]
fn shells_that_share_a_wall_are_one() {
    // A wall of three by three squares between two sheets, which has faces that touch none of its rim.
    let lower = shapes::sheet(3, 0.5);
    let mut upper = lower.clone();
    upper.0.iter_mut().for_each(|at| at.z += 0.5);
    // The same bits on both sides of the wall.
    for at in 0..16 {
        upper.0[16 + at] = lower.0[at];
    }
    let faces = lower.1.len();
    let mut both = lower;
    shapes::join(&mut both, upper);
    let made = mesh(both);
    assert_eq!(made.faces().len(), 2 * faces - 36);
    assert_eq!((made.report().duplicate, made.report().shells), (36, 1));
    for z in [-0.2, 0.2, 0.3, 0.7] {
        assert_eq!(made.winding(DVec3::new(0.01, 0.02, z)), 1, "{z}");
    }
    // Where every face is there once for either side, one of them stays.
    let mut twofold = cube();
    let backs: Vec<_> = twofold.1.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    twofold.1.extend(backs);
    let made = mesh(twofold);
    assert_eq!((made.faces().len(), made.report().duplicate), (12, 12));
    assert!(made.keeps(DVec3::splat(0.5)));
}

#[test]
fn faces_without_an_area_stay_where_they_close_the_surface() {
    // An edge that one neighbour has as two: the face between them has its corners in line.
    let mut shape = cube();
    let middle = shape.0.len() as u32;
    let [a, b, c] = shape.1[0];
    shape
        .0
        .push(0.5 * (shape.0[a as usize] + shape.0[b as usize]));
    shape.1[0] = [a, middle, c];
    shape.1.extend([[middle, b, c], [a, b, middle]]);
    let made = mesh(shape);
    assert_eq!((made.report().slivers, made.report().degenerate), (1, 0));
    assert!(
        made.report()
            .to_string()
            .starts_with("kept 1 face without an area")
    );
    assert!(made.keeps(DVec3::splat(0.5)));
    // One that is not needed goes.
    let mut shape = cube();
    shape
        .0
        .extend([DVec3::X * 3.0, DVec3::X * 4.0, DVec3::X * 5.0]);
    shape.1.extend([[8, 9, 10], [8, 10, 9]]);
    let made = mesh(shape);
    assert_eq!((made.report().slivers, made.report().duplicate), (0, 2));
    assert_eq!(made.report().degenerate, 0);
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
    assert_eq!(
        error,
        "'open' is no rule for the inside of a mesh; use closed or winding"
    );
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
