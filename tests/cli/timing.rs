//! What a time is the time of. Nothing here compares a time with a number of milliseconds.

use serde_json::Value;

use super::{document, done, folder, line, line_with, scene, stderr};

fn number(document: &Value, path: &str) -> f64 {
    let found = document.pointer(path).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no {path} in {document}"))
}

/// On a driver that keeps nothing, compilation takes far longer than a frame, and is in none that is shown.
#[test]
fn compilation_is_in_no_frame() {
    let here = folder("first_use");
    scene(&here);
    let words = "render @/scene.ply --size 32x32 --mode none --repeat 5 --no-pipeline-cache --json";
    let cold = Some(("MESA_SHADER_CACHE_DISABLE", "true"));
    let report = document(line_with(&here, words, cold));
    let first = number(&report, "/first_use_ms");
    assert!(
        number(&report, "/greatest/wall_ms") < first / 2.0,
        "{report}"
    );
}

#[test]
fn times_say_how_many_frames_they_are_the_medians_of() {
    let here = folder("samples");
    scene(&here);
    for (flags, least, most) in [
        ("", 1, 5),
        ("--repeat 3", 3, 3),
        ("--repeat 1", 1, 1),
        ("--trace @/trace.json", 1, 1),
        ("--section z=0.2..0.8:2", 2, 6),
    ] {
        let words = format!("render @/scene.ply --size 32x32 --json {flags}");
        let report = document(line(&here, &words));
        let samples = report["samples"].as_u64().expect("a number");
        assert!((least..=most).contains(&samples), "{flags}: {samples}");
        for time in ["gpu_ms", "wall_ms"] {
            let [low, middle, high] =
                ["/least/", "/", "/greatest/"].map(|of| number(&report, &format!("{of}{time}")));
            assert!(
                low <= middle && middle <= high,
                "{flags}: {low} {middle} {high}"
            );
        }
        assert!(number(&report, "/first_use_ms") > 0.0, "{flags}");
    }
    let printed = done(line(
        &here,
        "render @/scene.ply -o @/a.png --size 32x32 --repeat 2",
    ));
    assert!(stderr(&printed).contains("the median of 2 frames"));
    let printed = done(line(
        &here,
        "demo @/scene.ply -o @/out --size 32x32 --no-reference",
    ));
    assert!(stderr(&printed).contains("medians of 5 frames"));
}

/// Most frames of a sweep skip the stages that a moving clip does not touch. Those have no time, and no frame has less than none.
#[test]
fn a_stage_that_was_skipped_has_no_time() {
    let here = folder("skipped_stages");
    scene(&here);
    let words = "sweep @/scene.ply --clip-normal 0,0,1 --frames 7 --size 32x32";
    let report = document(line(&here, &format!("{words} --json")));
    let names = |of: &Value, list: &str, key: &str| -> Vec<String> {
        let list = of[list].as_array().expect("a list");
        let name = |one: &Value| {
            if key.is_empty() {
                one.clone()
            } else {
                one[key].clone()
            }
        };
        let text = |one: &Value| name(one).as_str().expect("a name").to_owned();
        list.iter().map(text).collect()
    };
    assert!(!names(&report, "skipped", "").is_empty(), "{report}");
    let frames = report["frames"].as_array().expect("frames");
    for of in frames.iter().chain([&report, &report["mean"]]) {
        let (skipped, timed) = (names(of, "skipped", ""), names(of, "passes", "name"));
        assert!(!timed.iter().any(|name| skipped.contains(name)), "{of}");
        for pass in of["passes"].as_array().expect("passes") {
            assert!(
                pass["ms"].as_f64().is_some_and(f64::is_sign_positive),
                "{pass}"
            );
        }
    }
    let printed = stderr(&done(line(&here, words)));
    assert!(
        printed.contains("(skipped: ") && !printed.contains("-0.00"),
        "{printed}"
    );
}

#[test]
fn frames_say_what_they_show_and_where_it_is() {
    let here = folder("frame_facts");
    scene(&here);
    let sweep = "sweep @/scene.ply --clip-normal 0,0,2 --frames 3 --size 32x32 -o @/sweep --json";
    let sweep = document(line(&here, sweep));
    let (mut last, mut files) = (f64::INFINITY, Vec::new());
    for frame in sweep["frames"].as_array().expect("frames") {
        assert_eq!(
            (&frame["view"], &frame["name"]),
            (&0.into(), &"framing".into())
        );
        assert_eq!(frame["plane"].as_array().map(Vec::len), Some(4));
        assert_eq!(number(frame, "/plane/2"), 1.0);
        assert!(
            number(frame, "/plane/3") < last,
            "it moves along its normal"
        );
        last = number(frame, "/plane/3");
        assert_eq!(frame["samples"], 1);
        files.push(frame["file"].as_str().expect("a file").to_owned());
    }
    assert!(
        files
            .iter()
            .all(|file| std::path::Path::new(file).is_file()),
        "{files:?}"
    );
    let sections = "render @/scene.ply --section z=0.2..0.8:3 --size 32x32 -o @/{name}.png --json";
    let sections = document(line(&here, sections));
    for (number, frame) in sections["frames"]
        .as_array()
        .expect("frames")
        .iter()
        .enumerate()
    {
        assert_eq!(frame["view"], number);
        let file = std::path::Path::new(frame["file"].as_str().expect("a file"));
        assert!(file.is_file() && frame["plane"].is_array(), "{frame}");
        let name = frame["name"].as_str().expect("a name");
        assert_eq!(file.file_stem().and_then(|stem| stem.to_str()), Some(name));
    }
}
