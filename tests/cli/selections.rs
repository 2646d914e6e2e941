//! Selections: layers of the splats that fulfil a predicate.

use std::fs;
use std::path::Path;

use rara::Picture;

use super::{document, done, folder, line, rara, refused, scene};

/// Writes the scene of `from` with a label for each Gaussian, its number modulo 5, in ascii or in binary.
fn label(from: &Path, to: &Path, ascii: bool) {
    let bytes = fs::read(from).unwrap();
    let end = b"end_header\n";
    let at = bytes
        .windows(end.len())
        .position(|window| window == end)
        .unwrap();
    let (header, payload) = (
        std::str::from_utf8(&bytes[..at]).unwrap(),
        &bytes[at + end.len()..],
    );
    let floats = header.matches("property float").count();
    let format = if ascii {
        "ascii"
    } else {
        "binary_little_endian"
    };
    let header = header.replace("binary_little_endian", format);
    let mut made = format!("{header}property uchar label\nend_header\n").into_bytes();
    for (number, row) in payload.chunks_exact(4 * floats).enumerate() {
        if ascii {
            let numbers = row
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes(b.try_into().unwrap()));
            let words: Vec<String> = numbers.map(|number| number.to_string()).collect();
            made.extend(format!("{} {}\n", words.join(" "), number % 5).into_bytes());
        } else {
            made.extend(row);
            made.push((number % 5) as u8);
        }
    }
    fs::write(to, made).unwrap();
}

/// `line` with more words, which may hold blanks.
fn line_and(here: &Path, words: &str, more: &[&str]) -> std::process::Output {
    let folder = here.to_str().unwrap();
    let words = words
        .split_whitespace()
        .map(|word| word.replace('@', folder));
    rara(words.chain(more.iter().map(|word| (*word).to_owned())))
}

#[test]
fn selections_are_layers_by_label_in_ascii_and_binary() {
    let here = folder("selections");
    scene(&here);
    label(&here.join("scene.ply"), &here.join("text.ply"), true);
    label(&here.join("scene.ply"), &here.join("bits.ply"), false);
    let select = ["--select", "vessels=label in 3,4"];
    for file in ["text", "bits"] {
        let listed = document(line_and(
            &here,
            &format!("info @/{file}.ply --json"),
            &select,
        ));
        let layers = listed["layers"].as_array().unwrap();
        let facts: Vec<_> = layers
            .iter()
            .map(|layer| {
                (
                    layer["name"].as_str().unwrap(),
                    layer["gaussians"].as_u64().unwrap(),
                )
            })
            .collect();
        assert_eq!(facts, [(file, 1200), ("vessels", 800)]);

        let drawn = |more: &[&str]| {
            let words = format!("render @/{file}.ply --size 64x48 -o @/a.png --json");
            let report = document(line_and(&here, &words, more));
            let cutoff = report["counts"]["cutoff"].as_u64().unwrap();
            let visible = report["counts"]["visible"].as_u64().unwrap();
            ([visible, cutoff], fs::read(here.join("a.png")).unwrap())
        };
        let whole = drawn(&[]);
        assert_eq!(drawn(&select), whole, "{file}");
        let hidden = drawn(&[&select[..], &["--hide", "vessels"]].concat());
        assert!(hidden.0[0] < whole.0[0] && hidden.1 != whole.1);
        let cut = drawn(&[&select[..], &["--layer-clip", "vessels=plane:1,0,0,0"]].concat());
        assert!(cut.0[1] > 0 && cut.0[1] < drawn(&["--clip", "plane:1,0,0,0"]).0[1]);
    }
}

#[test]
fn selections_take_what_others_leave_and_go_by_layers() {
    let here = folder("selections_of");
    scene(&here);
    done(line(&here, "generate layers -n 500 --seed 2 -o @/more.ply"));
    let layers = |words: &str, more: &[&str]| {
        let listed = document(line_and(&here, &format!("info {words} --json"), more));
        let layers = listed["layers"].as_array().unwrap().iter();
        let facts = layers.map(|layer| {
            let name = layer["name"].as_str().unwrap().to_owned();
            (name, layer["gaussians"].as_u64().unwrap())
        });
        (
            facts.collect::<Vec<_>>(),
            listed["notes"].as_array().unwrap().len(),
        )
    };
    let both = "outer=@/scene.ply inner=@/more.ply";
    let (found, _) = layers(
        both,
        &[
            "--select",
            "strong=opacity>=0.5",
            "--select",
            "weak=opacity<0.5",
        ],
    );
    let names: Vec<_> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        ["outer", "strong", "weak", "inner", "strong", "weak"]
    );
    assert_eq!((found[0].1, found[3].1), (0, 0), "nothing is left");
    assert_eq!(found[1].1 + found[2].1, 2000);

    let big = "strong/big=inside(all(plane:1,0,0,0, sphere:0,0,0,9))";
    let (found, notes) = layers(
        both,
        &[
            "--select",
            "outer/strong=opacity>=0.5",
            "--select",
            big,
            "--select",
            "inner/none=size<0",
        ],
    );
    let names: Vec<_> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["outer", "strong", "big", "inner", "none"]);
    assert!(found[2].1 > 0 && found[0].1 + found[1].1 + found[2].1 == 2000);
    assert_eq!((found[4].1, notes), (0, 1), "an empty selection is told of");

    let list = serde_json::json!({"layers": [{
        "path": "scene.ply", "name": "outer", "opacity": 0.5,
        "select": [
            {"name": "strong", "where": "opacity>=0.5", "opacity": 1, "clip_expr": "whole"},
            {"name": "red", "where": "red>0.5", "visible": false},
        ],
    }]});
    fs::write(here.join("list.json"), list.to_string()).unwrap();
    let listed = document(line(&here, "info @/list.json --json"));
    let facts = |at: usize, what: &str| listed["layers"][at][what].clone();
    assert_eq!(facts(1, "name"), "strong");
    assert_eq!(
        (
            facts(0, "opacity"),
            facts(1, "opacity"),
            facts(2, "opacity")
        ),
        (0.5.into(), 1.0.into(), 0.5.into())
    );
    assert_eq!(
        (
            facts(0, "clipped"),
            facts(1, "clipped"),
            facts(2, "visible")
        ),
        (false.into(), true.into(), false.into())
    );
    for (select, words) in [
        (serde_json::json!([{"name": "a"}]), "where"),
        (
            serde_json::json!([{"name": "a", "where": "opacity"}]),
            "layer 0, selection 0: column 8",
        ),
        (
            serde_json::json!([{"name": "a", "where": "label=1"}]),
            "no property `label`",
        ),
    ] {
        let list = serde_json::json!({"layers": [{"path": "scene.ply", "select": select}]});
        fs::write(here.join("list.json"), list.to_string()).unwrap();
        refused(&line(&here, "info @/list.json"), 1, words);
    }
    for (select, status, words) in [
        ("strong", 2, "expected NAME=PREDICATE"),
        ("=opacity>1", 2, "a name for the layer"),
        (
            "strong=opacity>",
            2,
            "column 9 of the selection: a number is missing",
        ),
        (
            "skin/strong=opacity>1",
            2,
            "no layer is called 'skin'; the layers are outer, inner",
        ),
        (
            "strong=labl=3",
            1,
            "no property `labl`; next to those of a Gaussian it has nx, ny, nz",
        ),
    ] {
        refused(
            &line_and(&here, &format!("info {both}"), &["--select", select]),
            status,
            words,
        );
    }
}

#[test]
fn baking_a_divided_file_is_baking_it() {
    let here = folder("selections_bake");
    scene(&here);
    let bake = |to: &str, more: &[&str]| {
        let words = format!("bake @/scene.ply -o @/{to} --clip plane:1,0,0,0 --views 0");
        done(line_and(&here, &words, more));
    };
    bake("whole.ply", &[]);
    bake("parts.ply", &["--select", "strong=opacity>0.5"]);
    let [whole, parts] = ["whole.ply", "parts.ply"].map(|name| fs::read(here.join(name)).unwrap());
    assert!(whole == parts, "the same Gaussians in the same order");
    bake("{}.cut.ply", &["--select", "strong=opacity>0.5"]);
    assert!(here.join("strong.cut.ply").exists() && here.join("scene.cut.ply").exists());
}

/// A layer's opacity and tint are those of a file whose Gaussians have them.
#[test]
fn layers_look_as_flags_say() {
    let here = folder("layer_look");
    scene(&here);
    let drawn = |scene: &str, flags: &str| {
        let words = format!("render {scene} -o @/drawn.exr --size 64x48 {flags}");
        done(line(&here, &words));
        fs::read(here.join("drawn.exr")).expect("a picture")
    };
    let plain = drawn("@/scene.ply", "");
    let listed = r#"{"layers":[{"path":"scene.ply","opacity":0.3}]}"#;
    fs::write(here.join("list.json"), listed).expect("writes");
    let faint = drawn("@/list.json", "");
    assert!(faint != plain);
    for share in ["0.3", "30%"] {
        assert!(faint == drawn("@/scene.ply", &format!("--layer-opacity scene={share}")));
    }
    assert!(plain == drawn("@/list.json", "--layer-opacity scene=1"));
    let red = drawn("@/scene.ply", "--layer-tint scene=red");
    assert!(red != plain && red == drawn("@/scene.ply", "--layer-tint scene=1,0,0:50%"));
    assert!(plain == drawn("@/scene.ply", "--layer-tint scene=red:0"));
    done(line(
        &here,
        "convert @/scene.ply -o @/all_red.ply --layer-tint scene=red:1 --layer-opacity scene=0.5",
    ));
    let whole = drawn("@/all_red.ply", "--background 0,0,1");
    let picture = Picture::load(here.join("drawn.exr")).expect("a picture");
    assert!(
        picture.pixels.iter().all(|p| p[1].abs() < 1e-4),
        "nothing is green"
    );
    assert!(whole != red);
    for (flag, says) in [
        ("--layer-opacity skin=0.5", "no layer is called 'skin'"),
        ("--layer-opacity scene=2", "a number from 0 to 1"),
        ("--layer-opacity 0.5", "a layer's name and = come first"),
        ("--layer-tint scene=rouge", "--layer-tint scene=rouge"),
    ] {
        refused(
            &line(&here, &format!("render @/scene.ply -o @/a.png {flag}")),
            2,
            says,
        );
    }
}
