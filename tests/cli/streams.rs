//! Scenes from standard input, pictures to standard output.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use super::{done, folder, line, refused, scene};

/// Runs `rara` with a file as its standard input.
fn fed(input: &Path, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rara"))
        .args(words.split_whitespace())
        .stdin(Stdio::from(File::open(input).expect("the input")))
        .env("RARA_CACHE", "")
        .output()
        .expect("the rara binary runs")
}

#[test]
fn a_scene_comes_in_and_a_picture_goes_out() {
    let here = folder("streams");
    let scene = scene(&here);
    let flags = "--size 48x32 --background white --repeat 1";
    done(line(
        &here,
        &format!("render @/scene.ply -o @/a.png {flags}"),
    ));
    let piped = done(fed(&scene, &format!("render - -o - {flags}")));
    assert!(piped.stdout == fs::read(here.join("a.png")).expect("a picture"));
    let listed = done(fed(&scene, "info - --json"));
    let info: serde_json::Value = serde_json::from_slice(&listed.stdout).expect("JSON");
    assert_eq!(
        (&info["gaussians"], &info["layers"][0]["name"]),
        (&2000.into(), &"stdin".into())
    );
    refused(
        &fed(&scene, "render - -o - --json"),
        2,
        "both take standard output",
    );
    let broken = here.join("broken.ply");
    fs::write(&broken, "ply\n").expect("writes");
    refused(&fed(&broken, "render - -o -"), 1, "standard input");
}
