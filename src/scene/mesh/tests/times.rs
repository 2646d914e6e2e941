use super::*;
use std::time::Instant;

/// Calls something, and prints how long it takes.
fn timed<R>(what: &str, work: impl FnOnce() -> R) -> R {
    let start = Instant::now();
    let made = work();
    println!("{what}: {:.3} s", start.elapsed().as_secs_f64());
    made
}

#[test]
#[ignore = "prints times, of which debug builds say little"]
fn a_million_faces() {
    let shape = shapes::star(1_000_000, 70);
    println!("{} faces", shape.1.len());
    let mesh = timed("made and checked", || mesh(shape.clone()));
    timed("made by the winding number", || {
        Mesh::from_triangles(&shape.0, &shape.1, MeshRule::Winding).expect("a star")
    });
    timed("its tree alone", || {
        crate::mesh::MeshTree::build(mesh.vertices(), mesh.faces())
    });
    let packed = timed("packed", || mesh.packed());
    println!(
        "{:.1} bytes a face",
        16.0 * packed.quads.len() as f64 / mesh.faces().len() as f64
    );
    let mut random = Random::new(71);
    let points: Vec<_> = (0..10_000)
        .map(|_| point_near(&mesh, &mut random))
        .collect();
    timed("10 000 winding numbers", || {
        points.iter().map(|at| mesh.winding(*at)).sum::<i32>()
    });
    timed("10 000 distances", || {
        points
            .iter()
            .map(|at| mesh.signed_distance(*at))
            .sum::<f64>()
    });
    let mut found = Vec::new();
    timed("10 000 lines", || {
        for pair in points.windows(2) {
            mesh.crossings(pair[0], pair[1] - pair[0], &mut found);
        }
    });
    #[cfg(feature = "formats")]
    for (name, bytes) in super::files::files(&shape) {
        let read = || crate::mesh::read::read_bytes(&bytes, std::path::Path::new(name));
        let megabytes = bytes.len() / 1_000_000;
        timed(&format!("{name}, {megabytes} MB, read"), read)
            .map(drop)
            .unwrap_or_else(|error| println!("{error}"));
    }
}
