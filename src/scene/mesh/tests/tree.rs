use super::*;
use crate::mesh::{LEAF, MeshTree};

fn check(name: &str, mesh: &Mesh) {
    let nodes = mesh.tree().nodes();
    let mut next = 0;
    for (at, node) in nodes.iter().enumerate() {
        let corners = |face: u32| mesh.corners(face);
        if node.count == 0 {
            let left = nodes[at + 1];
            let right = nodes[left.skip as usize];
            assert_eq!(right.skip, node.skip, "{name}");
            assert_eq!(left.low.min(right.low), node.low, "{name}");
            assert_eq!(left.high.max(right.high), node.high, "{name}");
        } else {
            assert_eq!((node.first, node.skip as usize), (next, at + 1), "{name}");
            assert!(
                node.count as usize <= LEAF && (node.count >= 3 || mesh.faces().len() < 3),
                "{name}"
            );
            for corner in (node.first..node.first + node.count).flat_map(corners) {
                assert!(
                    corner.cmpge(node.low).all() && corner.cmple(node.high).all(),
                    "{name}"
                );
            }
            next += node.count;
        }
    }
    assert_eq!(
        next as usize,
        mesh.faces().len(),
        "{name}: each face is in one leaf"
    );
    let mut visited = Vec::new();
    let ended = mesh.tree().walk(
        |_| true,
        |face| {
            visited.push(face);
            false
        },
    );
    assert!(!ended && visited.into_iter().eq(0..next), "{name}");
}

#[test]
fn every_face_is_in_one_leaf() {
    for (name, mesh) in all() {
        check(name, &mesh);
    }
    check("a large star", &mesh(shapes::star(30_000, 5)));
}

#[test]
fn trees_are_not_deep() {
    // Each face twice as far as the one before, and all at one place.
    let ladder: Vec<DVec3> = (0..3_000)
        .map(|at| DVec3::splat(1.0 + f64::from(at % 3) * 1e-3) * 1.2_f64.powi(at / 3))
        .collect();
    let heap = vec![DVec3::ONE; 3_000];
    for vertices in [ladder, heap] {
        let faces: Vec<_> = (0..1_000)
            .map(|at| [3 * at, 3 * at + 1, 3 * at + 2])
            .collect();
        let (tree, order) = MeshTree::build(&vertices, &faces);
        let mut sorted = order;
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..1_000));
        let nodes = tree.nodes();
        let mut deepest = 0;
        let mut open = vec![(0, 1)];
        while let Some((at, depth)) = open.pop() {
            deepest = deepest.max(depth);
            if nodes[at].count == 0 {
                open.extend([
                    (at + 1, depth + 1),
                    (nodes[at + 1].skip as usize, depth + 1),
                ]);
            }
        }
        assert!(deepest <= 51, "{deepest}");
    }
}

#[test]
fn the_same_faces_make_the_same_mesh() {
    let (vertices, faces) = shapes::star(500, 6);
    let make = |vertices: &[DVec3]| {
        Mesh::from_triangles(vertices, &faces, MeshRule::Closed).expect("a star")
    };
    let (a, b) = (make(&vertices), make(&vertices));
    assert_eq!((&a, a.content_hash()), (&b, b.content_hash()));
    let mut moved = vertices.clone();
    moved[3] *= 1.001;
    assert_ne!(a, make(&moved));
    let winding = Mesh::from_triangles(&vertices, &faces, MeshRule::Winding).expect("a star");
    assert_ne!(a, winding);
    assert_eq!(format!("{:?}", a.clone()), format!("{b:?}"));
}
