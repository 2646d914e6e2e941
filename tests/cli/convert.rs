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
    done(line(&here, "generate strands -n 2000 -o @/scene.ply"));
    let mut sizes = Vec::new();
    for version in ["2", "3", "4"] {
        done(line(
            &here,
            &format!("convert @/scene.ply -o @/v.spz --spz-version {version}"),
        ));
        let bytes = fs::read(here.join("v.spz")).expect("a scene");
        assert_eq!(bytes.starts_with(b"NGSP"), version == "4", "{version}");
        sizes.push(bytes.len());
    }
    // Version 4 has 91 % of version 3: 97 % at its compressor's lowest level, and 78 % at that of version 3.
    let share = sizes[2] as f64 / sizes[1] as f64;
    assert!((0.85..0.94).contains(&share), "{sizes:?}");
    let output = line(&here, "convert @/scene.ply -o @/v.spz --spz-version 1");
    refused(&output, 2, "--spz-version");
    let output = line(&here, "convert @/scene.ply -o @/v.ply --spz-version 2");
    refused(&output, 2, "--spz-version has no effect on");
}

#[test]
fn each_scene_gets_a_file_of_its_own_where_braces_stand() {
    let here = folder("convert-each");
    scene(&here);
    done(line(&here, "generate strands -n 10 -o @/a.ply"));
    for name in ["scene", "a"] {
        let words = format!("convert @/{name}.ply -o @/alone_{name}.spz");
        done(line(&here, &words));
    }
    let file = |name: &str| fs::read(here.join(name)).expect("a file");
    for (pattern, [scene, a]) in [
        ("c_{}.spz", ["c_scene.spz", "c_a.spz"]),
        ("{name}.spz", ["scene.spz", "a.spz"]),
        ("f/{:02}.spz", ["f/00.spz", "f/01.spz"]),
    ] {
        let words = format!("convert @/scene.ply @/a.ply -o @/{pattern} --json");
        let report = document(line(&here, &words));
        let written = |at: usize| report["files"][at]["written"].as_u64();
        assert_eq!([written(0), written(1)], [Some(2000), Some(10)]);
        assert!(file(scene) == file("alone_scene.spz") && file(a) == file("alone_a.spz"));
        assert!(!here.join(pattern).exists());
    }
    done(line(&here, "convert s/b=@/a.ply -o @/{name}.spz"));
    assert!(file("s_b.spz") == file("alone_a.spz"));
    for (words, code, what) in [
        (
            "@/scene.ply scene=@/a.ply -o @/c_{}.ply",
            2,
            "two of the scenes",
        ),
        ("@/scene.ply @/a.ply -o @/{}.ply", 2, "one of the scenes"),
        ("@/scene.ply @/a.ply -o @/a.ply/{}.ply", 1, "not a folder"),
    ] {
        refused(&line(&here, &format!("convert {words}")), code, what);
    }
    for flags in ["--clip sphere:90,0,0,1", "--hide scene", "--min-opacity 1"] {
        let words = format!("convert @/scene.ply -o @/none.ply {flags}");
        let printed = stderr(&done(line(&here, &words)));
        assert!(
            printed.contains("is empty, because the flags leave out all 2 000"),
            "{printed}"
        );
    }
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
        stderr(&made).contains("outside the range of .spz"),
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
fn floaters_are_left_out() {
    let here = folder("convert-clusters");
    scene(&here);
    done(line(&here, "generate general -n 20 -o @/dust.ply"));
    done(line(
        &here,
        "convert @/dust.ply -o @/far.ply --move 1000,0,0",
    ));
    done(line(&here, "convert @/scene.ply @/far.ply -o @/scan.ply"));
    let cleaned = |flags: &str| {
        let words = format!("convert @/scan.ply -o @/clean.ply {flags} --json");
        let report = document(line(&here, &words));
        let counts = ["floating", "written"].map(|name| report[name].as_u64().expect("a count"));
        assert_eq!(counts[0] + counts[1], 2020, "{report}");
        let info = document(line(&here, "info @/clean.ply --json"));
        assert!(centre(&info, "max", 0) < 100.0, "{info}");
        counts[0]
    };
    let floating = cleaned("--min-cluster 30");
    assert!((20..1000).contains(&floating), "{floating}");
    assert!(cleaned("--largest-cluster") >= floating);
    let select = "info @/scan.ply --select floaters=cluster_size<30 --json";
    let layers = &document(line(&here, select))["layers"];
    assert_eq!(layers[1]["gaussians"], floating, "{layers}");
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
        "the ending of the name chooses the format, and must be one of",
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
    let half = report["written"].as_u64().expect("a count") / 2;
    assert_eq!(
        [0, 1].map(|mesh| primitive_count(&json, mesh)),
        [half; 2],
        "{json}"
    );

    let printed = stderr(&done(line(&here, "convert @/named.glb -o @/named.ply")));
    let says = "has no room for the names and extras of the glTF";
    assert!(printed.contains(says), "{printed}");
    let printed = stderr(&done(line(&here, "convert @/plain.glb -o @/plain.ply")));
    assert!(!printed.contains(says), "{printed}");
}

/// The number of Gaussians of a mesh's first primitive.
fn primitive_count(json: &serde_json::Value, mesh: usize) -> u64 {
    let position = &json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"];
    let accessor = position.as_u64().expect("a number") as usize;
    json["accessors"][accessor]["count"]
        .as_u64()
        .expect("a count")
}

/// The JSON of a .glb, and what is behind it.
fn chunks(glb: &[u8]) -> (serde_json::Value, &[u8]) {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("4 bytes")) as usize;
    let (json, rest) = glb[20..].split_at(length);
    (serde_json::from_slice(json).expect("JSON"), rest)
}

/// A `.ply` of this many Gaussians along x, each with a label and a confidence.
fn labelled(first: f32, labels: &[i32]) -> Vec<u8> {
    labelled_as(["label", "marks", "float"], first, labels)
}

/// The same, with these names of the labels and of an empty list, and this type of the confidences.
fn labelled_as([label, marks, kind]: [&str; 3], first: f32, labels: &[i32]) -> Vec<u8> {
    let names = [
        "x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
        "rot_0", "rot_1", "rot_2", "rot_3",
    ];
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n",
        labels.len()
    );
    names
        .iter()
        .for_each(|name| bytes += &format!("property float {name}\n"));
    bytes += &format!(
        "property int {label}\nproperty list uchar int {marks}\nproperty {kind} confidence\nend_header\n"
    );
    let mut bytes = bytes.into_bytes();
    for (at, label) in labels.iter().enumerate() {
        let mut row = [0.0_f32; 14];
        (row[0], row[2], row[10]) = (first + at as f32, 5.0, 1.0);
        row.iter()
            .for_each(|value| bytes.extend(value.to_le_bytes()));
        bytes.extend(label.to_le_bytes());
        bytes.push(0);
        match kind {
            "double" => bytes.extend((0.5 * f64::from(*label)).to_le_bytes()),
            _ => bytes.extend((0.5 * *label as f32).to_le_bytes()),
        }
    }
    bytes
}

#[test]
fn further_properties_are_carried_or_said() {
    let here = folder("convert_properties");
    fs::write(here.join("a.ply"), labelled(0.0, &[7, 8, 9])).expect("ours");
    fs::write(here.join("b.ply"), labelled(3.0, &[-1, 70_000])).expect("ours");
    let command = "convert @/a.ply @/b.ply -o @/both.ply --clip plane:1,0,0,-0.5 --select eight=label=8 --place move:0,1,0";
    let report = document(line(&here, &(command.to_owned() + " --json")));
    assert!(report["notes"].to_string().contains("marks"), "{report}");
    let bytes = fs::read(here.join("both.ply")).expect("a scene");
    let text = String::from_utf8_lossy(&bytes);
    assert!(
        text.contains("property int label\nproperty float confidence\n"),
        "{text}"
    );
    for (label, count) in [(7, 0), (8, 1), (9, 1), (-1, 1), (70_000, 1)] {
        let confidence = 0.5 * f64::from(label);
        for predicate in [format!("label={label}"), format!("confidence={confidence}")] {
            let command = format!("info @/both.ply --json --select one={predicate}");
            let info = document(line(&here, &command));
            assert_eq!(info["layers"][1]["gaussians"], count, "{predicate}");
        }
    }
    // Placing drops the first Gaussian of the first file, whose values go with it, and no others.
    fs::write(here.join("far.ply"), labelled(-6.0, &[70_000, -1])).expect("ours");
    for flags in ["--scale 0.65e38", "--place scale:0.65e38"] {
        let command = format!("convert @/far.ply @/a.ply -o @/left.EXT {flags}");
        done(line(&here, &command.replace("EXT", "ply")));
        for (label, count) in [(-1, 1), (70_000, 0), (7, 1), (8, 1), (9, 1)] {
            let command = format!("info @/left.ply --json --select one=label={label}");
            let info = document(line(&here, &command));
            assert_eq!(info["layers"][1]["gaussians"], count, "{flags}: {label}");
        }
        done(line(&here, &command.replace("EXT", "glb")));
        let (json, _) = chunks(&fs::read(here.join("left.glb")).expect("a scene"));
        assert_eq!(
            [0, 1].map(|mesh| primitive_count(&json, mesh)),
            [1, 3],
            "{flags}"
        );
    }
    // What one of the files alone has is left out and said, whichever is first, and the rest is as precise as in either.
    let other = labelled_as(["class", "tags", "double"], 3.0, &[-1, 70_000]);
    fs::write(here.join("class.ply"), other).expect("ours");
    for scenes in ["@/a.ply @/class.ply", "@/class.ply @/a.ply"] {
        let said = stderr(&done(line(
            &here,
            &format!("convert {scenes} -o @/both.ply"),
        )));
        assert!(
            said.contains(
                "4 properties of the scene that drawing does not use: class, label, marks, tags"
            ),
            "{said}"
        );
        let bytes = fs::read(here.join("both.ply")).expect("a scene");
        assert!(String::from_utf8_lossy(&bytes).contains("property double confidence"));
        for confidence in [3.5, 4.0, 4.5, -0.5, 35_000.0] {
            let command = format!("info @/both.ply --json --select one=confidence={confidence}");
            let info = document(line(&here, &command));
            assert_eq!(info["layers"][1]["gaussians"], 1, "{scenes}: {confidence}");
        }
    }
    for other in ["c.spz", "c.sog", "c.glb", "c.compressed.ply"] {
        let said = stderr(&done(line(&here, &format!("convert @/a.ply -o @/{other}"))));
        assert!(
            said.contains("3 properties of the scene that drawing does not use: label, confidence, marks; a .ply keeps"),
            "{said}"
        );
    }
}

/// A picture without flags has it up, and so has a file that is written.
#[test]
fn what_a_file_says_is_up_is_up() {
    let here = folder("convert_up");
    let plain = String::from_utf8_lossy(&labelled(0.0, &[])).into_owned();
    let stated = plain.replacen(
        "element vertex 0",
        "comment Vertical Axis: z\nelement vertex 3",
        1,
    );
    let rows = labelled(0.0, &[1, 2, 3])[plain.len()..].to_vec();
    fs::write(here.join("a.ply"), [stated.into_bytes(), rows].concat()).expect("ours");
    let info = stdout(&done(line(&here, "info @/a.ply")));
    assert!(info.contains("up             z"), "{info}");
    for (words, up) in [
        ("convert @/a.ply -o @/b.ply", "0,0,1"),
        ("convert @/a.ply -o @/b.ply --rotate 1,0,0,90", "0,-1,0"),
        (
            "bake @/a.ply -o @/b.ply --clip plane:0,0,1,9 --views 0",
            "0,0,1",
        ),
    ] {
        done(line(&here, words));
        let info = document(line(&here, "info @/b.ply --json"));
        let found: Vec<_> = info["layers"][0]["up"]
            .as_array()
            .expect("up")
            .iter()
            .map(|n| n.as_f64().unwrap().to_string())
            .collect();
        assert_eq!(found.join(",").replace("-0,", "0,"), up, "{words}");
    }
    let said = stderr(&done(line(&here, "convert @/a.ply -o @/b.spz")));
    assert!(said.contains("--up z"), "{said}");
}
