use super::*;
use crate::clip::Expression;
use crate::mesh::shapes;
use rara_base::fnv;

/// A box from -1 to 1 with these parts behind the file in its text.
fn shape(parts: &str) -> (std::path::PathBuf, String) {
    let folder = std::env::temp_dir().join(format!("rara-mesh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    let path = folder.join(format!(
        "cube-{:x}.obj",
        fnv::with(fnv::NOTHING, parts.bytes())
    ));
    let (vertices, faces) = shapes::cuboid(DVec3::NEG_ONE, DVec3::ONE);
    let mut text = String::new();
    for DVec3 { x, y, z } in vertices {
        text += &format!("v {x} {y} {z}\n");
    }
    for face in faces {
        let [a, b, c] = face.map(|vertex| vertex + 1);
        text += &format!("f {a} {b} {c}\n");
    }
    std::fs::write(&path, text).expect("a temporary file");
    let text = format!("mesh:{}{parts}", path.display());
    (path, text)
}

fn read(text: &str) -> Expression {
    text.parse()
        .unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn texts_and_json_come_back() {
    for parts in [
        "",
        ";winding",
        ";scale=0.5;turn=0,1,0,0;at=1,2,3",
        ";at=0,0,-2",
    ] {
        let (path, text) = shape(parts);
        let region = read(&text);
        assert_eq!(region.to_string(), text);
        assert_eq!(read(&region.to_string()), region);
        let json = serde_json::to_string(&region).expect("JSON");
        let back: Expression = serde_json::from_str(&json).expect("the same");
        assert_eq!(back, region, "{json}");
        std::fs::remove_file(path).expect("it was there");
    }
}

#[test]
fn a_mesh_is_scaled_turned_and_moved() {
    let (path, text) = shape(";scale=0.5;turn=1,0,0,1;at=0,0,2");
    let clip = read(&format!("!{text}")).clip();
    // A quarter turn about z leaves a box as it is.
    for (point, kept) in [
        ([0.4, 0.0, 2.4], false),
        ([0.6, 0.0, 2.0], true),
        ([0.0; 3], true),
    ] {
        assert_eq!(clip.keeps(point.into()), kept, "{point:?}");
    }
    let up = Placement::new(DVec3::Z, DQuat::IDENTITY, 2.0).expect("a placement");
    let higher = read(&text).placed(&up).expect("finite numbers");
    assert_eq!(higher.middle(DVec3::ZERO), DVec3::Z * 5.0);
    let between = read(&text).between(&higher, 0.5).expect("the same mesh");
    assert_eq!(between.middle(DVec3::ZERO), DVec3::Z * 3.5);
    assert_eq!(higher.name(), "mesh");
    std::fs::remove_file(path).expect("it was there");
}

#[test]
fn what_is_wrong_is_named() {
    let (path, text) = shape(";at=0,0,0");
    let text = text.replace(";at=0,0,0", "");
    for (parts, expected) in [
        (";at=1,2", "'1,2' has 2 numbers; give 3"),
        (";scale=0", "its scale has to be finite and above zero"),
        (";turn=0,0,0,0", "its rotation cannot be zero"),
        (";bigger", "'bigger' is not a part of a mesh; use scale=s"),
    ] {
        let error = format!("{text}{parts}")
            .parse::<Expression>()
            .expect_err(parts);
        assert!(error.to_string().contains(expected), "{parts}: {error}");
    }
    std::fs::remove_file(&path).expect("it was there");
    let missing = text.parse::<Expression>().expect_err("no file");
    assert!(
        missing.to_string().contains(&path.display().to_string()),
        "{missing}"
    );
    let nothing = "mesh:".parse::<Expression>().expect_err("no name");
    assert!(
        nothing.to_string().contains("a mesh needs a file"),
        "{nothing}"
    );
}
