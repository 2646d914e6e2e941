//! Defects that were found once, each with the smallest input that shows it.

use std::path::Path;

use rara::Camera;
use rara::camera_files::{
    ColmapFormat, NamedCamera, camera_from_json, cameras_from_colmap, cameras_from_json,
};
use rara::clip::clips_from_json;

/// Asserts that an error is one line, whatever names the file contains.
fn assert_one_line<T: std::fmt::Debug>(result: rara::Result<T>) {
    let text = result.expect_err("nothing usable in it").to_string();
    assert!(!text.chars().any(char::is_control), "{text:?}");
    assert!(text.len() < 400, "{text:?}");
}

/// The cameras of a file as they are drawn.
fn drawn(cameras: rara::Result<Vec<NamedCamera>>) -> rara::Result<Vec<Camera>> {
    cameras?.iter().map(NamedCamera::camera).collect()
}

#[test]
fn names_with_control_characters_in_errors() {
    let name = Path::new("file");
    let colmap = |cameras: &str, images: &str| {
        let (cameras, images) = (cameras.as_bytes(), images.as_bytes());
        drawn(cameras_from_colmap(
            ColmapFormat::Text,
            cameras,
            images,
            name,
        ))
    };
    assert_one_line(colmap("", "1 1 0 0 0 0 0 0 1 a\u{1b}[31mb\n\n"));
    let lens = "1 PINHOLE 9 9 9 9 4 4\n";
    assert_one_line(colmap(lens, "1 0 0 0 0 0 0 0 1 a\u{8}\n\n"));
    let long = format!("1 0 0 0 0 0 0 0 1 {}\n\n", "a".repeat(4000));
    assert_one_line(colmap(lens, &long));
    let matrix = "[[0,0,0,0],[0,0,0,0],[0,0,0,0]]";
    for json in [
        r#"[{"img_name": "a\nb\u0007", "width": 0, "height": 9, "fx": 9, "fy": 9, "position": [0,0,0],
           "rotation": [[1,0,0],[0,1,0],[0,0,1]]}]"#
            .into(),
        format!(
            r#"{{"w": 9, "h": 9, "fl_x": 9, "frames": [{{"file_path": "a\nb", "transform_matrix": {matrix}}}]}}"#
        ),
        format!(
            r#"{{"w": 9, "h": 9, "fl_x": 9, "camera_model": "\u001b[0m", "frames": [{{"transform_matrix": {matrix}}}]}}"#
        ),
    ] {
        assert_one_line(drawn(cameras_from_json(String::as_bytes(&json), name)));
    }
}

#[test]
fn words_that_json_does_not_know_in_errors() {
    let name = Path::new("file");
    for word in ["\u{7f}", "\u{9b}31m", &"a".repeat(4000)] {
        assert_one_line(clips_from_json(
            format!(r#"[["{word}",1]]"#).as_bytes(),
            name,
        ));
    }
}

#[test]
fn whatever_an_error_quotes_of_a_file_is_one_line() {
    let long = format!("a\nb\u{1b}[31m{}, and the remedy", "c".repeat(5000));
    let text = rara::Error::format("file", long).to_string();
    assert!(!text.chars().any(char::is_control), "{text:?}");
    assert!(text.starts_with(r"file: a\nb\u{1b}[31mccc") && text.ends_with("c, and the remedy"));
    assert!(text.len() < 1020, "{text:?}");
}

#[test]
fn a_camera_whose_position_overflows_is_refused() {
    // Each number is finite, but the product with the rotation is not.
    let json = r#"{"width": 9, "height": 9, "fx": 9, "fy": 9, "world_to_camera":
        [0.6, 0.8, 0, 1.7e308,  -0.8, 0.6, 0, 1.7e308,  0, 0, 1, 1.7e308,  0, 0, 0, 1]}"#;
    let error = camera_from_json(json.as_bytes(), Path::new("file")).unwrap_err();
    assert!(error.to_string().contains("not finite"), "{error}");
}
