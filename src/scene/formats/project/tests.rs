use glam::Vec3;

use super::super::wrapped::tests::{archive, file, load};
use super::*;

/// A PLY of two Gaussians at (0, 1, 3) and (1, 1, 3), of which the first is deleted where this is 4.
fn with_state(first: u8) -> Vec<u8> {
    let (_, ply) = file(".ply", 2, 3.0);
    let end = b"end_header\n";
    let at = ply.windows(end.len()).position(|part| part == end).unwrap();
    let (header, rows) = (&ply[..at], &ply[at + end.len()..]);
    let mut made = [header, b"property uchar state\n", end].concat();
    for (row, state) in rows.chunks(rows.len() / 2).zip([first, 1]) {
        made.extend_from_slice(row);
        made.push(state);
    }
    made
}

fn project(splats: &str, plys: &[&[u8]]) -> Vec<u8> {
    let document = format!(r#"{{"version": 0, "camera": {{}}, "splats": [{splats}]}}"#);
    let names: Vec<_> = (0..plys.len()).map(file_of).collect();
    let mut files = vec![(DOCUMENT, document.as_bytes())];
    files.extend(names.iter().map(String::as_str).zip(plys.iter().copied()));
    archive(&files)
}

const PLACED: &str = r#""position": [0, 2, 0], "rotation": [0, 0, 1, 0], "scale": [2, 2, 2]"#;

#[test]
fn a_project_is_what_is_visible_of_it_placed_and_coloured() {
    let splats = format!(
        r#"{{"name": "a", {PLACED}, "visible": true, "tintClr": [0.5, 1, 1, 1], "saturation": 0, "transparency": 0.5,
            "contrast": 3}}, {{"name": "b", "visible": false}}"#
    );
    let bytes = project(&splats, &[&with_state(4), &with_state(0)]);
    let loaded = load(bytes.clone()).unwrap();
    assert_eq!(loaded.format, Format::SuperSplat);
    let gaussians = &loaded.gaussians;
    assert_eq!(
        gaussians.positions(),
        [Vec3::new(2.0, 0.0, 6.0)],
        "y is up in SuperSplat"
    );
    assert_eq!(
        (gaussians.scales()[0], gaussians.opacities()[0]),
        (Vec3::splat(2.0), 0.25)
    );
    // A grey of .5, of whose red half is left.
    let grey = 0.5 * (1.0 - 0.5 * 0.299);
    for own in gaussians.sh_of(0) {
        assert!((f64::from(*own) * SH_0 + 0.5 - grey).abs() < 1e-6, "{own}");
    }
    let lines = loaded.report.lines().join("; ");
    for says in [
        "deleted",
        "hides its splat 'b'",
        "does not use: contrast",
        "does not use: camera",
    ] {
        assert!(lines.contains(says), "{lines} lacks {says}");
    }

    let path = std::env::temp_dir().join(format!("rara-project-{}.ssproj", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let layers = file_layers(&path).unwrap();
    let [first, second] = &layers[..] else {
        panic!("{layers:?}")
    };
    assert_eq!((&first.name[..], first.state.opacity), ("a", 0.5));
    let place = first.state.placement;
    assert_eq!(place.to_world(DVec3::Y), DVec3::ZERO);
    assert!(first.state.visible && !second.state.visible);
    let (own, states) = load_layer(&path, 1, &["state"], &mut |_, _| ()).unwrap();
    assert_eq!(own.gaussians.positions()[1], Vec3::new(1.0, 1.0, 3.0));
    assert_eq!(states[0].values, [0.0, 1.0]);
    assert!(load_layer(&path, 2, &[], &mut |_, _| ()).is_err());
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn colours_are_graded_as_in_supersplat() {
    let graded = r#""temperature": 0.1, "brightness": 0.1, "blackPoint": 0.2, "whitePoint": 0.7"#;
    let bytes = project(&format!("{{{graded}}}"), &[&with_state(0)]);
    let loaded = load(bytes).unwrap();
    for (own, own_colour) in loaded.gaussians.sh_of(0).iter().zip([1.0, 0.9, 0.8]) {
        let found = f64::from(*own) * SH_0 + 0.5;
        assert!(
            (found - own_colour).abs() < 1e-6,
            "{found}, not {own_colour}"
        );
    }
}

#[test]
fn what_is_wrong_with_a_project_is_named() {
    let ply = with_state(0);
    for (splats, version, says) in [
        (
            r#"{"position": [0, 1]}"#,
            "0",
            "a position that is not 3 numbers",
        ),
        (
            r#"{"scale": [1, "a", 1]}"#,
            "0",
            "a scale that is not 3 numbers",
        ),
        (
            r#"{"rotation": [0, 0, 0, 0]}"#,
            "0",
            "no place for anything",
        ),
        (
            r#"{"whitePoint": 0}"#,
            "0",
            "a whitePoint that is its blackPoint",
        ),
        ("{}, {}", "0", "no file \"splat_1.ply\""),
        ("{}", "2", "version 2"),
    ] {
        let splats = splats.to_owned() + &format!(r#"], "version": {version}, "timeline": ["#);
        let error = load(project(&splats, &[&ply])).unwrap_err().to_string();
        assert!(error.contains(says), "{error} lacks {says}");
    }
    let nested = project("{}", &[&project("{}", &[&ply])]);
    let error = load(nested).unwrap_err().to_string();
    assert!(error.contains("splat_0.ply: "), "{error}");
}
