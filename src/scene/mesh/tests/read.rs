use std::path::Path;

use proptest::prelude::*;

use super::files::{files, gltf_parts, ply, shape, stl, stl_text};
use super::*;
use crate::mesh::read::{ReadMesh, read_bytes};
use rara_base::error::Result;

pub(super) fn made(read: Result<ReadMesh>) -> Mesh {
    let read = read.unwrap_or_else(|error| panic!("{error}"));
    Mesh::make(&read.vertices, &read.faces, MeshRule::Closed, read.report)
        .unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn refusal(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let read = read_bytes(bytes.as_ref(), Path::new(name));
    let error = read.map(|read| read.faces.len());
    error
        .expect_err(&String::from_utf8_lossy(bytes.as_ref()))
        .to_string()
}

#[test]
fn all_formats_make_the_same_mesh() {
    let shape = shape();
    let expected = mesh(shape.clone());
    assert_eq!(
        (expected.report().shells, expected.report().cavities),
        (2, 1)
    );
    for (name, bytes) in files(&shape) {
        let read = made(read_bytes(&bytes, Path::new(name)));
        assert_eq!(read.faces(), expected.faces(), "{name}");
        assert_eq!(read, expected, "{name}");
        // The name is only asked where the content does not say.
        let unnamed = made(read_bytes(&bytes, Path::new("a file")));
        assert_eq!(unnamed, read, "{name}");
    }
}

#[test]
fn files_are_read_from_folders() {
    let folder = std::env::temp_dir().join(format!("rara-meshes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let shape = shape();
    let (numbers, document) = gltf_parts(&shape, Some("its%20numbers.bin"));
    std::fs::write(folder.join("its numbers.bin"), numbers).expect("a file");
    std::fs::write(folder.join("a.gltf"), document).expect("a file");
    std::fs::write(folder.join("a.ply"), ply(&shape, "ascii")).expect("a file");
    let [gltf, ply] = ["a.gltf", "a.ply"]
        .map(|name| Mesh::read(folder.join(name), MeshRule::Closed).expect(name));
    assert_eq!(gltf, ply);
    assert_eq!(
        gltf.report().to_string(),
        "turned 20 faces round; left out 1 primitive of the glTF that are no triangles"
    );
    let missing = Mesh::read(folder.join("b.ply"), MeshRule::Closed).expect_err("no file");
    assert!(
        missing.to_string().contains("b.ply") && missing.to_string().contains("check the name")
    );
    std::fs::write(
        folder.join("open.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .expect("a file");
    let open = Mesh::read(folder.join("open.obj"), MeshRule::Closed)
        .expect_err("open")
        .to_string();
    assert!(
        open.contains("open.obj: the mesh is not closed: the edge from (0, 0, 0) to (1, 0, 0)"),
        "{open}"
    );
    std::fs::remove_dir_all(&folder).expect("the folder");
}

#[test]
fn what_is_wrong_is_named_by_its_place() {
    let shape = shape();
    let stl_text = String::from_utf8(stl_text(&shape)).expect("a text");
    let ascii = String::from_utf8(ply(&shape, "ascii")).expect("a text");
    let binary = ply(&shape, "binary_little_endian");
    let wrong_ply = |from: &str, to: &str| ascii.replacen(from, to, 1);
    let document = gltf_parts(&shape, None).1;
    let cut = |bytes: &[u8]| bytes[..bytes.len() - 1].to_vec();
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        (
            "a.obj",
            "v 1 2\n".into(),
            "line 1 is no vertex of three numbers: \"v 1 2\"",
        ),
        (
            "a.obj",
            "# a\nv 1 2 x\n".into(),
            "line 2 is no vertex of three numbers",
        ),
        (
            "a.obj",
            "v 1 2 3 0\n".into(),
            "line 1 divides a vertex by zero",
        ),
        (
            "a.obj",
            "v 1 2 3\r\nf 1 a 1\n".into(),
            "line 2 is no face of vertices' numbers: \"f 1 a 1\"",
        ),
        (
            "a.obj",
            "v 1 2 3\nv 1 2 4\n\nf 1 2 1\nf 1 2 3\n".into(),
            "line 5 is a face of vertices that there are not, of 2",
        ),
        (
            "a.obj",
            "v 1 2 3\nf 1 0 1\n".into(),
            "line 2 is a face of vertices that there are not, of 1: \"f 1 0 1\"",
        ),
        (
            "a.obj",
            "v 1 2 3\nf -1 -2 -1\n".into(),
            "line 2 is a face of vertices that there are not",
        ),
        ("a.obj", "v 1 2 3\n".into(), "the OBJ has no faces"),
        (
            "a.stl",
            cut(&stl(&shape)),
            "the STL says to have 80 faces, and has the bytes of 79; it is cut off",
        ),
        (
            "a.stl",
            b"short".to_vec(),
            "the STL is shorter than its header",
        ),
        (
            "a.stl",
            "solid a\nendsolid\n".into(),
            "the STL has no faces",
        ),
        (
            "a.stl",
            stl_text.replacen("endloop", "endlop", 1).into(),
            "line 7 is not what an STL has there: \"endlop\"",
        ),
        (
            "a.stl",
            stl_text.replacen("Vertex ", "Vertex 1 ", 1).into(),
            "line 4 is not what an STL has there",
        ),
        (
            "a.stl",
            stl_text.replace("endsolid", "").into(),
            "is not what an STL has there",
        ),
        (
            "a.ply",
            wrong_ply("element face", "element faces").into(),
            "points or Gaussians and no element `face`",
        ),
        (
            "a.ply",
            wrong_ply("element face", "element tristrips").into(),
            "has its faces as strips",
        ),
        (
            "a.ply",
            wrong_ply("vertex_indices", "corners").into(),
            "have no list `vertex_indices`",
        ),
        (
            "a.ply",
            wrong_ply("double z", "double w").into(),
            "have no property `z`",
        ),
        (
            "a.ply",
            wrong_ply("element vertex ", "element vertex 70").into(),
            "there are not the bytes for them",
        ),
        (
            "a.ply",
            wrong_ply("element vertex ", "element vertex 70000000").into(),
            "simplify it",
        ),
        (
            "a.ply",
            wrong_ply("\n2 0 1\n", "\n2 0 q\n").into(),
            "`edge` 0 has \"q\" where a number should be in line ",
        ),
        (
            "a.ply",
            wrong_ply("\n2 0 1\n", "\n-2 0 1\n").into(),
            "`edge` 0 has a list of -2 numbers in line ",
        ),
        (
            "a.ply",
            wrong_ply("\n1 3 0 ", "\n1 3 99 ").into(),
            "face 0 of the PLY names vertex 99, of ",
        ),
        (
            "a.ply",
            cut(&binary),
            "the PLY ends in `face` 79; it is cut off",
        ),
        (
            "a.gltf",
            document.replace("\"mode\": 1", "\"mode\": 4").into(),
            "no buffer 0",
        ),
        (
            "a.gltf",
            document
                .replace(
                    "\"scenes\": [{\"nodes\": [0]}]",
                    "\"scenes\": [{\"nodes\": []}]",
                )
                .into(),
            "draws no triangles",
        ),
        (
            "a.gltf",
            document
                .replace(
                    "\"indices\": 1}",
                    "\"indices\": 1, \"extensions\": {\"KHR_draco_mesh_compression\": {}}}",
                )
                .into(),
            "compressed by KHR_draco_mesh_compression",
        ),
        ("a.gltf", "{".into(), "its JSON is damaged"),
        (
            "a.png",
            b"\x89PNG".to_vec(),
            "this is no mesh of a format that is read; convert it to OBJ, STL, PLY or glTF",
        ),
        ("a.obj", Vec::new(), "the file is empty"),
    ];
    for (name, bytes, expected) in cases {
        let error = refusal(name, &bytes);
        assert!(
            error.starts_with(name) && error.contains(expected),
            "{error}\n is not \n{expected}"
        );
        let has_remedy = ["export", "get it again", "convert", "simplify", "remove"];
        assert!(
            has_remedy.iter().any(|remedy| error.contains(remedy)),
            "{error}"
        );
    }
}

thread_local! {
    static FILES: Vec<(&'static str, Vec<u8>)> = files(&shapes::star(12, 1));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Whatever a file is, it is a mesh or an error.
    #[test]
    fn no_bytes_end_in_a_panic(
        which in 0..8_usize,
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..6_u8), 1..6),
        length in any::<prop::sample::Index>(),
        is_cut in 0..4_u8,
    ) {
        let (name, mut bytes) = FILES.with(|files| files[which].clone());
        for (place, byte, how) in places {
            let at = place.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => bytes[at] = b"0123456789-+.eE/ \n\\"[byte as usize % 19],
                2 => bytes[at] ^= 1 << (byte % 8),
                3 => bytes.insert(at, b"0123456789-+.eE/ \n\\"[byte as usize % 19]),
                4 => drop(bytes.remove(at)),
                _ => {
                    let end = (at + byte as usize).min(bytes.len());
                    let copied = bytes[at..end].to_vec();
                    bytes.splice(at..at, copied);
                }
            }
        }
        if is_cut == 0 {
            bytes.truncate(length.index(bytes.len() + 1));
        }
        if let Ok(read) = read_bytes(&bytes, Path::new(name)) {
            for rule in [MeshRule::Closed, MeshRule::Winding] {
                if let Ok(mesh) = Mesh::from_triangles(&read.vertices, &read.faces, rule) {
                    mesh.packed();
                    mesh.signed_distance(mesh.centre());
                    let mut found = Vec::new();
                    mesh.crossings(DVec3::ZERO, DVec3::new(1.0, 0.1, 0.2), &mut found);
                    prop_assert_eq!(found.iter().map(|crossing| crossing.1).sum::<f64>(), 0.0);
                }
            }
        }
    }
}
