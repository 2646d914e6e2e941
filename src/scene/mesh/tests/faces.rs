use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::files::gltf_parts;
use super::read::{made, refusal};
use super::*;
use crate::mesh::read::read_bytes;

#[test]
fn polygons_are_divided() {
    // A prism over a U, whose ends are concave, and whose sides are squares.
    let ring = [
        (0, 0),
        (5, 0),
        (5, 4),
        (4, 4),
        (4, 1),
        (1, 1),
        (1, 4),
        (0, 4),
    ];
    let mut text = String::new();
    for z in [0, 1] {
        for (x, y) in ring {
            text += &format!("v {x} {y} {z} 1 .5 0\n");
        }
    }
    let list = |all: Vec<usize>| all.iter().map(|at| format!(" {at}")).collect::<String>();
    text += &format!(
        "f{}\nf{}\n",
        list((1..=8).rev().collect()),
        list((9..=16).collect())
    );
    for at in 0..8 {
        let next = (at + 1) % 8;
        text += &format!("f {} {} {} {}\n", at + 1, next + 1, next + 9, at + 9);
    }
    text += "l 1 2\np 3\nf 1 2\n";
    let mesh = made(read_bytes(text.as_bytes(), Path::new("u.obj")));
    assert_eq!((mesh.faces().len(), mesh.report().turned), (2 * 6 + 16, 0));
    assert_eq!(mesh.report().to_string(), "nothing dropped or repaired");
    let mut random = Random::new(61);
    for _ in 0..500 {
        let point = point_near(&mesh, &mut random);
        let is_in_box =
            point.cmpgt(DVec3::ZERO).all() && point.cmplt(DVec3::new(5.0, 4.0, 1.0)).all();
        let is_in_gap = point.x > 1.0 && point.x < 4.0 && point.y > 1.0;
        assert_eq!(mesh.keeps(point), is_in_box && !is_in_gap, "{point}");
    }
    // Large convex ones, and concave ones that are too large.
    for count in [900, 2_000] {
        let mut text = String::from("v 0 0 1\n");
        for at in 0..count {
            let angle = std::f64::consts::TAU * f64::from(at) / f64::from(count);
            let radius = if at == 1 && count == 900 { 0.5 } else { 1.0 };
            text += &format!("v {} {} 0\n", radius * angle.cos(), radius * angle.sin());
        }
        text += &format!("f{}\n", list((2..count as usize + 2).rev().collect()));
        for at in 0..count {
            text += &format!("f 1 {} {}\n", at + 2, (at + 1) % count + 2);
        }
        let mesh = made(read_bytes(text.as_bytes(), Path::new("cone.obj")));
        assert_eq!(mesh.faces().len(), 2 * count as usize - 2);
        if count == 2_000 {
            let dented = text.replace("v 1 0 0\n", "v .5 0 0\n");
            let error = refusal("cone.obj", dented);
            assert!(
                error.contains(
                    "face 0 has 2000 corners and is not convex, and at most 1000 are read"
                ),
                "{error}"
            );
        }
    }
}

#[test]
fn triangles_of_a_gltf_may_be_strips_fans_and_mirrored() {
    let shape = shapes::icosphere(0);
    let document = gltf_parts(&shape, Some("X")).1;
    for (from, to, faces, turned) in [
        ("\"scale\": [2, 2, 2]", "\"scale\": [2, 2, -2]", 20, 0),
        (
            "\"scale\": [2, 2, 2]",
            "\"matrix\": [1, 0, 0, 0, 0, 3, 0, 0, 0, 1, 1, 0, 5, 5, 5, 1]",
            20,
            0,
        ),
        (
            "\"indices\": 1}",
            "\"indices\": 1}, {\"attributes\": {\"POSITION\": 0}, \"mode\": 5, \"indices\": 1}",
            20 + 58,
            0,
        ),
        (
            "\"indices\": 1}",
            "\"indices\": 1}, {\"attributes\": {\"POSITION\": 0}, \"mode\": 6}",
            20 + 10,
            0,
        ),
    ] {
        let numbers = gltf_parts(&shape, None).0;
        let uri = format!("data:;base64,{}", STANDARD.encode(numbers));
        let bytes = document.replace('X', &uri).replace(from, to);
        let read = read_bytes(bytes.as_bytes(), Path::new("a.gltf"));
        let read = read.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(read.faces.len(), faces, "{to}");
        if faces == 20 {
            let mesh = made(Ok(read));
            assert_eq!(
                mesh.report().turned,
                turned,
                "{to}: mirrored faces are turned by the reader"
            );
        }
    }
}
