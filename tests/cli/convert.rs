//! `rara convert`: what it writes, what it leaves out, and what it refuses.

use std::fs;

use serde_json::Value;

use super::{document, done, folder, line, refused, scene, stderr, stdout};

fn centre(info: &Value, end: &str, axis: usize) -> f64 {
    info["centres"][end][axis].as_f64().expect("a number")
}

/// The numbers of a binary .ply that `rara` has written, row by row; the rotation is last.
fn rows(bytes: &[u8]) -> Vec<Vec<f32>> {
    let end = b"end_header\n";
    let at = bytes.windows(end.len()).position(|window| window == end);
    let (header, rows) = bytes.split_at(at.expect("a header") + end.len());
    let header = String::from_utf8_lossy(header);
    let row = 4 * header.matches("property float").count();
    let number = |four: &[u8]| f32::from_le_bytes(four.try_into().expect("four bytes"));
    let numbers = |row: &[u8]| row.chunks_exact(4).map(number).collect();
    rows.chunks_exact(row).map(numbers).collect()
}

#[test]
fn spz_is_written_in_the_version_that_is_asked_for() {
    let here = folder("convert_versions");
    scene(&here);
    for version in ["2", "3", "4"] {
        done(line(
            &here,
            &format!("convert @/scene.ply -o @/v.spz --spz-version {version}"),
        ));
        let bytes = fs::read(here.join("v.spz")).expect("a scene");
        assert_eq!(bytes.starts_with(b"NGSP"), version == "4", "{version}");
    }
    let output = line(&here, "convert @/scene.ply -o @/v.spz --spz-version 1");
    refused(&output, 2, "--spz-version");
}

#[test]
fn every_format_is_written_and_named() {
    let here = folder("convert");
    scene(&here);
    for (name, format) in [
        ("b.ply", "3DGS .ply"),
        ("b.compressed.ply", "compressed .ply"),
        ("b.spz", ".spz"),
        ("b.sog", "SOG"),
        ("b.glb", "glTF"),
    ] {
        let report = document(line(
            &here,
            &format!("convert @/scene.ply -o @/{name} --json"),
        ));
        assert_eq!(
            (&report["format"], &report["written"]),
            (&format.into(), &2000.into())
        );
        assert_eq!(
            report["bytes"],
            fs::metadata(here.join(name)).unwrap().len()
        );
        let info = document(line(&here, &format!("info @/{name} --json")));
        assert_eq!(info["layers"][0]["format"], format);
        assert_eq!(info["gaussians"], 2000);
        let printed = stdout(&done(line(&here, &format!("info @/{name}"))));
        assert!(
            printed.contains(&format!("format         {format}")),
            "{printed}"
        );
    }
    // Full precision comes back to the bit through glTF, but for rotations, which every reader normalises.
    done(line(&here, "convert @/b.glb -o @/c.ply"));
    let [b, c] = ["b.ply", "c.ply"].map(|name| rows(&fs::read(here.join(name)).unwrap()));
    assert_eq!((b.len(), c.len()), (2000, 2000));
    for (b, c) in b.iter().zip(&c) {
        let rotation = b.len() - 4;
        assert_eq!(
            b[..rotation],
            c[..rotation],
            "turned to glTF's axes and back"
        );
        let [b, c] = [b, c].map(|row| &row[rotation..]);
        assert!(
            b.iter().zip(c).all(|(b, c)| (b - c).abs() < 3e-7),
            "{b:?} {c:?}"
        );
    }
}

/// Gaussians that are equally deep are drawn in the file's order.
#[test]
fn selections_leave_the_order_as_it_is() {
    let here = folder("convert-selected");
    scene(&here);
    done(line(&here, "convert @/scene.ply -o @/b.ply"));
    let words = "convert @/scene.ply -o @/c.ply --select top=opacity>0.5";
    done(line(&here, words));
    let [b, c] = ["b.ply", "c.ply"].map(|name| fs::read(here.join(name)).unwrap());
    assert!(b == c, "the selection changed the file");
}

#[test]
fn what_is_lost_or_clamped_is_said() {
    let here = folder("convert-lost");
    scene(&here);
    let report = document(line(
        &here,
        "convert @/scene.ply -o @/b.sog --scale 3e38 --move 3e38,0,0 --json",
    ));
    let count = |name: &str| report[name].as_u64().expect("a count");
    assert!(count("lost") > 0 && count("written") > 0, "{report}");
    assert_eq!(count("lost") + count("written"), 2000);
    let info = document(line(&here, "info @/b.sog --json"));
    assert_eq!(info["gaussians"], report["written"]);

    let made = done(line(&here, "convert @/scene.ply -o @/b.spz --scale 100000"));
    assert!(
        stderr(&made).contains("beyond what .spz holds"),
        "{}",
        stderr(&made)
    );
}

#[test]
fn what_is_left_out_is_counted() {
    let here = folder("convert-filters");
    scene(&here);
    let words = "convert @/scene.ply -o @/b.ply --clip plane:1,0,0,0 --min-opacity 0.5 --sh-degree 0 --json";
    let report = document(line(&here, words));
    let count = |name: &str| report[name].as_u64().expect("a count");
    assert!(count("clipped") > 0 && count("faint") > 0, "{report}");
    assert_eq!(count("clipped") + count("faint") + count("written"), 2000);
    let info = document(line(&here, "info @/b.ply --json"));
    assert_eq!(
        (&info["gaussians"], &info["sh_degree"]),
        (&report["written"], &0.into())
    );
    assert!(centre(&info, "min", 0) >= 0.0, "{info}");
    assert!(
        info["opacity"]["min"].as_f64().expect("a number") >= 0.4999,
        "{info}"
    );

    // An expression, and a layer's own clip in its place.
    let kept = |flags: &str| {
        let words = format!("convert @/scene.ply -o @/c.ply {flags} --json");
        document(line(&here, &words))["written"]
            .as_u64()
            .expect("a count")
    };
    assert_eq!(kept("--clip-expr not(plane:1,0,0,0)"), count("clipped"));
    assert_eq!(kept("--clip plane:1,0,0,0 --layer-clip scene=whole"), 2000);
}

#[test]
fn scenes_are_placed_and_joined() {
    let here = folder("convert-placed");
    scene(&here);
    done(line(
        &here,
        "convert @/scene.ply -o @/b.ply --scale 2 --rotate 0,0,1,180 --move 0,0,5",
    ));
    let [a, b] =
        ["scene.ply", "b.ply"].map(|name| document(line(&here, &format!("info @/{name} --json"))));
    for (found, expected) in [
        (centre(&b, "min", 0), -2.0 * centre(&a, "max", 0)),
        (centre(&b, "max", 1), -2.0 * centre(&a, "min", 1)),
        (centre(&b, "min", 2), 2.0 * centre(&a, "min", 2) + 5.0),
    ] {
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
    let list = r#"{"layers": [{"path": "scene.ply", "scale": 2, "rotation": [0, 0, 0, 1], "position": [0, 0, 5]},
        {"path": "b.ply", "visible": false}]}"#;
    fs::write(here.join("list.json"), list).unwrap();
    let report = document(line(&here, "convert @/list.json -o @/c.ply --json"));
    assert_eq!(
        (&report["gaussians"], &report["hidden"]),
        (&4000.into(), &2000.into())
    );
    let c = document(line(&here, "info @/c.ply --json"));
    for (end, axis) in [("min", 0), ("max", 1), ("max", 2)] {
        assert!(
            (centre(&c, end, axis) - centre(&b, end, axis)).abs() < 1e-5,
            "{end} {axis}"
        );
    }
}

/// A SOG scene that was unpacked is its folder or its meta.json, which is no list of layers, alone or in a list.
#[test]
fn unpacked_scenes_are_read_by_their_folder() {
    let here = folder("convert-unpacked");
    scene(&here);
    done(line(&here, "convert @/scene.ply -o @/b.sog"));
    let bytes = fs::read(here.join("b.sog")).unwrap();
    let unpacked = here.join("kept");
    fs::create_dir(&unpacked).unwrap();
    // The archive is stored: each file's own header is 30 bytes, then its name and the file.
    let number = |at: usize, size: usize| {
        (0..size)
            .rev()
            .fold(0, |sum, byte| 256 * sum + usize::from(bytes[at + byte]))
    };
    let mut at = 0;
    while bytes[at..].starts_with(b"PK\x03\x04") {
        let (size, name) = (number(at + 18, 4), number(at + 26, 2));
        let name_at = at + 30;
        let path = unpacked.join(std::str::from_utf8(&bytes[name_at..name_at + name]).unwrap());
        at = name_at + name + size;
        fs::write(path, &bytes[at - size..at]).unwrap();
    }
    fs::write(
        here.join("list.json"),
        r#"{"layers": [{"path": "kept/meta.json"}]}"#,
    )
    .unwrap();
    for words in [
        "info @/kept --json",
        "info @/kept/meta.json --json",
        "info @/list.json --json",
    ] {
        let info = document(line(&here, words));
        assert_eq!(
            (&info["gaussians"], &info["layers"][0]["format"]),
            (&2000.into(), &"SOG".into())
        );
        assert_eq!(info["layers"][0]["name"], "kept", "{words}");
    }
    fs::remove_file(unpacked.join("quats.webp")).unwrap();
    refused(&line(&here, "info @/kept"), 1, "quats.webp");
}

#[test]
fn what_cannot_be_written_is_refused_before_anything_is_read() {
    let here = folder("convert-refused");
    scene(&here);
    refused(
        &line(&here, "convert @/scene.ply -o @/a.splat"),
        2,
        "it has to end in",
    );
    refused(
        &line(&here, "convert @/scene.ply -o @/scene.ply"),
        2,
        "one of the scenes",
    );
    refused(
        &line(&here, "convert @/scene.ply -o @/scene.ply/a.spz"),
        1,
        "not a folder",
    );
    refused(
        &line(&here, "convert @/scene.ply -o @/a.spz --rotate 0,0,0,90"),
        2,
        "axis",
    );
    refused(
        &line(&here, "convert @/scene.ply -o @/a.spz --scale 0"),
        2,
        "--scale",
    );
    fs::write(here.join("a.usd"), "#usda 1.0").unwrap();
    refused(&line(&here, "info @/a.usd"), 1, "USD");
}

/// Names and extras go from .glb to .glb with the Gaussians that are theirs, and other formats say that they have no room.
#[test]
fn names_and_extras_stay_with_their_gaussians() {
    let here = folder("convert-names");
    scene(&here);
    done(line(&here, "convert @/scene.ply -o @/plain.glb"));
    let glb = fs::read(here.join("plain.glb")).expect("a scene");
    let (mut json, binary) = chunks(&glb);
    json["nodes"][0]["name"] = "the statue".into();
    json["nodes"][0]["extras"] = serde_json::json!({"room": 12});
    json["asset"]["copyright"] = "A. Sculptor".into();
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut named = b"glTF\x02\0\0\0".to_vec();
    named.extend((20 + text.len() as u32 + binary.len() as u32).to_le_bytes());
    named.extend((text.len() as u32).to_le_bytes());
    named.extend(b"JSON");
    named.extend(text);
    named.extend(binary);
    fs::write(here.join("named.glb"), named).expect("a scene");

    let words = "convert @/scene.ply @/named.glb -o @/both.glb --clip plane:1,0,0,0 --select few=opacity>0.5 --json";
    let report = document(line(&here, words));
    let (json, _) = chunks(&fs::read(here.join("both.glb")).expect("a scene"));
    assert_eq!(json["nodes"][1]["name"], "the statue");
    assert_eq!(json["nodes"][1]["extras"]["room"], 12);
    assert_eq!(json["asset"]["copyright"], "A. Sculptor");
    let count = |mesh: usize| {
        let position = &json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"];
        json["accessors"][position.as_u64().expect("a number") as usize]["count"].clone()
    };
    let half = report["written"].as_u64().expect("a count") / 2;
    assert_eq!([count(0), count(1)], [half, half], "{json}");

    let printed = stderr(&done(line(&here, "convert @/named.glb -o @/named.ply")));
    let says = "has no room for the names and extras of the glTF";
    assert!(printed.contains(says), "{printed}");
    let printed = stderr(&done(line(&here, "convert @/plain.glb -o @/plain.ply")));
    assert!(!printed.contains(says), "{printed}");
}

/// The JSON of a .glb, and what is behind it.
fn chunks(glb: &[u8]) -> (serde_json::Value, &[u8]) {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("4 bytes")) as usize;
    let (json, rest) = glb[20..].split_at(length);
    (serde_json::from_slice(json).expect("JSON"), rest)
}
