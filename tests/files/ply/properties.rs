//! Properties beside those of a Gaussian: read where they are asked for, in every encoding and of every type.

use std::io::Cursor;
use std::path::Path;

use rara::scene::{Predicate, Property, SceneFile, load_from_with};

use super::made::*;

fn load_asked(bytes: &[u8], names: &[&str]) -> rara::Result<(SceneFile, Vec<Property>)> {
    load_from_with(
        Cursor::new(bytes),
        Path::new("made.ply"),
        names,
        &mut |_, _| (),
    )
}

fn declared<'a>(extra: &[(&'a str, &'a str)]) -> Vec<(&'a str, &'a str)> {
    let mut properties = floats(FIXED);
    properties.insert(3, extra[0]);
    properties.extend(&extra[1..]);
    properties
}

#[test]
fn properties_of_every_type_are_read_in_every_encoding() {
    let extra = [
        ("uchar", "label"),
        ("short", "region"),
        ("int", "id"),
        ("uint", "track"),
        ("float", "confidence"),
        ("double", "time"),
        ("char", "unused"),
    ];
    let asked = [
        "confidence",
        "label",
        "region",
        "id",
        "track",
        "time",
        "label",
    ];
    for format in FORMATS {
        let bytes = scene_file(format, 40, &declared(&extra)).bytes();
        let (loaded, properties) = load_asked(&bytes, &asked).unwrap();
        let usual = load_bytes(&bytes).unwrap();
        assert_eq!(loaded.gaussians, usual.gaussians);
        assert_eq!(usual.others, extra.map(|(_, name)| name));
        assert_eq!(loaded.others, ["unused"]);
        let names: Vec<_> = properties.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, asked[..6], "in the order of asking, each once");
        for property in &properties {
            let whole = !["confidence", "time"].contains(&property.name.as_str());
            let values: Vec<f64> = (0..40).map(|i| value(&property.name, i, whole)).collect();
            assert_eq!(property.values, values, "{}", property.name);
            assert_eq!(property.single, property.name == "confidence");
        }
    }
}

#[test]
fn labels_select_beside_lists_and_dropped_gaussians() {
    for format in FORMATS {
        let properties = declared(&[("ushort", "label"), ("list uchar float", "history")]);
        let mut file = File::new(format);
        file.element("vertex", 5, &properties);
        for i in 0..5 {
            for (kind, name) in &properties {
                match *name {
                    "history" => {
                        file.number("uchar", 2.0);
                        file.number("float", 1.0);
                        file.number("float", 2.0);
                    }
                    "label" => file.number(kind, f64::from(i) + 60_000.0),
                    "x" if i == 1 => file.number(kind, f64::NAN), // dropped, and its label with it
                    "rot_0" => file.number(kind, 1.0),
                    _ => file.number(kind, 0.5),
                }
            }
            file.end_element();
        }
        let (loaded, properties) = load_asked(&file.bytes(), &["label"]).unwrap();
        assert_eq!((loaded.report.dropped, loaded.gaussians.len()), (1, 4));
        assert_eq!(
            properties[0].values,
            [60_000.0, 60_002.0, 60_003.0, 60_004.0]
        );
        let predicate: Predicate = "label in 60001, 60003..60004".parse().unwrap();
        let [rest, taken] = predicate.split(loaded.gaussians, &properties).unwrap();
        assert_eq!((rest.numbers, taken.numbers), (vec![0, 1], vec![2, 3]));
    }
}

#[test]
fn properties_that_no_file_gives_are_refused() {
    for format in FORMATS {
        let properties = declared(&[("uchar", "label"), ("list uchar int", "history")]);
        let bytes = scene_file(format, 3, &properties).bytes();
        for (name, words) in [
            (
                "labl",
                "no property `labl`; next to those of a Gaussian it has label, history",
            ),
            ("history", "`history` is a list"),
            ("x", "`x` is what a Gaussian is made of"),
            ("f_dc_0", "use opacity, size, red"),
        ] {
            let error = load_asked(&bytes, &[name]).unwrap_err().to_string();
            assert!(
                error.starts_with("made.ply: ") && error.contains(words),
                "{error}"
            );
        }
    }
    let bare = scene_file(Format::Ascii, 3, &floats(FIXED)).bytes();
    let error = load_asked(&bare, &["label"]).unwrap_err().to_string();
    assert!(
        error.contains("of a Gaussian it has none; name another"),
        "{error}"
    );
    // Harmonics of a higher degree than the file's are properties that it lacks.
    let first_degree: Vec<String> = (0..9).map(|i| format!("f_rest_{i}")).collect();
    let mut names = FIXED.to_vec();
    names.extend(first_degree.iter().map(String::as_str));
    let degree_1 = scene_file(Format::Ascii, 3, &floats(&names)).bytes();
    for (bytes, name, words) in [
        (&bare, "f_rest_0", "no property `f_rest_0`"),
        (&bare, "f_rest_44", "no property `f_rest_44`"),
        (&degree_1, "f_rest_9", "no property `f_rest_9`"),
        (
            &degree_1,
            "f_rest_8",
            "`f_rest_8` is what a Gaussian is made of",
        ),
    ] {
        let error = load_asked(bytes, &[name]).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    // A text that is no number is only refused where it is asked for.
    let text =
        String::from_utf8(scene_file(Format::Ascii, 1, &declared(&[("uchar", "label")])).bytes());
    let text = text.unwrap();
    let (head, row) = text.trim_end().rsplit_once('\n').unwrap();
    let mut words: Vec<&str> = row.split_whitespace().collect();
    words[3] = "skin";
    let spoilt = format!("{head}\n{}\n", words.join(" "));
    assert!(load_bytes(spoilt.as_bytes()).is_ok());
    let error = load_asked(spoilt.as_bytes(), &["label"])
        .unwrap_err()
        .to_string();
    assert!(error.contains("\"skin\" is not a number"), "{error}");
}
