//! Files of each format.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::*;

/// Two shells whose numbers have so few digits that all formats have them all.
pub(super) fn shape() -> Triangles {
    let mut shape = shapes::star(60, 60);
    let mut inner = shapes::icosphere(0);
    inner.0.iter_mut().for_each(|at| *at *= 0.1);
    shapes::join(&mut shape, inner);
    let digits = |at: DVec3| (1024.0 * at).round() / 1024.0;
    shape.0.iter_mut().for_each(|at| *at = digits(*at));
    shape
}

fn obj((vertices, faces): &Triangles) -> Vec<u8> {
    let mut text = String::from("# a comment\nmtllib none.mtl\no first\nvt 0 0\nvn 0 0 1\n");
    for at in vertices {
        text += &format!("v {} {} {}\n", at.x, at.y, at.z);
    }
    for (number, [a, b, c]) in faces.iter().enumerate() {
        let back = |vertex: &u32| i64::from(*vertex) - vertices.len() as i64;
        text += &match number % 4 {
            0 => format!(
                "g part {number}\nusemtl none\nf {} {} {}\n",
                a + 1,
                b + 1,
                c + 1
            ),
            1 => format!("f {}/1/1 {}/1/1 {}/1/1\r\n", a + 1, b + 1, c + 1),
            2 => format!("f {}//1 {}//1 {} # behind\n", a + 1, b + 1, c + 1),
            _ => format!("f {} {} \\\n {}\n", back(a), back(b), back(c)),
        };
    }
    text.into_bytes()
}

pub(super) fn stl((vertices, faces): &Triangles) -> Vec<u8> {
    let mut bytes = b"solid, as some programs begin binary files too\n".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((faces.len() as u32).to_le_bytes());
    for face in faces {
        bytes.extend([0; 12]);
        for at in face.map(|vertex| vertices[vertex as usize].as_vec3()) {
            at.to_array()
                .iter()
                .for_each(|part| bytes.extend(part.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

pub(super) fn stl_text((vertices, faces): &Triangles) -> Vec<u8> {
    let mut text = String::from("SOLID\n");
    for (number, face) in faces.iter().enumerate() {
        if number == 20 {
            text += "endsolid\n\nsolid another\n";
        }
        text += "  FACET NORMAL nan 0 0\n    outer loop\r\n";
        for at in face.map(|vertex| vertices[vertex as usize]) {
            text += &format!("      Vertex {:e} {} {}\n", at.x, at.y, at.z);
        }
        text += "    endloop\n  endfacet\n";
    }
    text += "endsolid another\n";
    text.into_bytes()
}

pub(super) fn ply((vertices, faces): &Triangles, encoding: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {encoding} 1.0\nelement vertex {}\nproperty double x\nproperty uchar red\nproperty double y\nproperty double z\n\
         element edge 1\nproperty list uchar int ends\nelement face {}\nproperty uchar flags\nproperty list uchar int vertex_indices\n\
         end_header\n",
        vertices.len(),
        faces.len()
    );
    let mut bytes = header.into_bytes();
    let is_text = encoding == "ascii";
    let big = encoding == "binary_big_endian";
    let mut put = |number: f64, kind: &str, end: &str| match kind {
        _ if is_text => bytes.extend(format!("{number}{end}").bytes()),
        "byte" => bytes.push(number as u8),
        "int" if big => bytes.extend((number as i32).to_be_bytes()),
        "int" => bytes.extend((number as i32).to_le_bytes()),
        _ if big => bytes.extend(number.to_be_bytes()),
        _ => bytes.extend(number.to_le_bytes()),
    };
    for at in vertices {
        put(at.x, "double", " ");
        put(7.0, "byte", " ");
        put(at.y, "double", " ");
        put(at.z, "double", "\n");
    }
    put(2.0, "byte", " ");
    put(0.0, "int", " ");
    put(1.0, "int", "\n");
    for face in faces {
        put(1.0, "byte", " ");
        put(3.0, "byte", " ");
        for (vertex, end) in face.iter().zip([" ", " ", "\n"]) {
            put(f64::from(*vertex), "int", end);
        }
    }
    bytes
}

/// The numbers of a glTF's only mesh, and its document with a buffer of a name or of the file.
pub(super) fn gltf_parts((vertices, faces): &Triangles, uri: Option<&str>) -> (Vec<u8>, String) {
    let mut numbers = Vec::new();
    // As glTF has its axes, and moved and scaled, which the nodes undo.
    for at in vertices {
        let stored = (DVec3::new(-at.x, -at.y, at.z) - DVec3::X) * 0.5;
        stored
            .as_vec3()
            .to_array()
            .iter()
            .for_each(|part| numbers.extend(part.to_le_bytes()));
    }
    let places = numbers.len();
    let corners = faces.iter().flatten();
    corners.for_each(|vertex| numbers.extend((*vertex as u16).to_le_bytes()));
    let uri = uri.map_or_else(String::new, |uri| format!("\"uri\": \"{uri}\", "));
    let document = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"children": [1], "translation": [1, 0, 0]}}, {{"mesh": 0, "scale": [2, 2, 2]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}, {{"mode": 1, "attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5123, "count": {}, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {places}}}, {{"buffer": 0, "byteOffset": {places}, "byteLength": {}}}],
        "buffers": [{{{uri}"byteLength": {}}}]}}"#,
        vertices.len(),
        3 * faces.len(),
        numbers.len() - places,
        numbers.len()
    );
    (numbers, document)
}

fn gltf(shape: &Triangles) -> Vec<u8> {
    let (numbers, _) = gltf_parts(shape, None);
    let uri = format!(
        "data:application/octet-stream;base64,{}",
        STANDARD.encode(numbers)
    );
    gltf_parts(shape, Some(&uri)).1.into_bytes()
}

fn glb(shape: &Triangles) -> Vec<u8> {
    let (mut numbers, document) = gltf_parts(shape, None);
    let mut document = document.into_bytes();
    document.resize(document.len().next_multiple_of(4), b' ');
    numbers.resize(numbers.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF".to_vec();
    let mut put = |number: u32| bytes.extend(number.to_le_bytes());
    put(2);
    put((28 + document.len() + numbers.len()) as u32);
    put(document.len() as u32);
    put(0x4E4F_534A);
    bytes.extend(&document);
    bytes.extend((numbers.len() as u32).to_le_bytes());
    bytes.extend(0x004E_4942_u32.to_le_bytes());
    bytes.extend(&numbers);
    bytes
}

/// A file of each format.
pub(super) fn files(shape: &Triangles) -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a.obj", obj(shape)),
        ("a.stl", stl(shape)),
        ("text.stl", stl_text(shape)),
        ("ascii.ply", ply(shape, "ascii")),
        ("little.ply", ply(shape, "binary_little_endian")),
        ("big.ply", ply(shape, "binary_big_endian")),
        ("a.gltf", gltf(shape)),
        ("a.glb", glb(shape)),
    ]
}
