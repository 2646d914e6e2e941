//! Signals, memory that runs out, and the folder in which drivers keep what they compile.

#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};

use super::{document, done, folder, line, refused, scene, stderr};
use crate::folder::until;

fn unfinished(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    names
        .filter(|name| name.to_string_lossy().ends_with(".part"))
        .count()
}

#[test]
fn a_signal_leaves_no_unfinished_file() {
    for (name, number) in [("INT", 2), ("TERM", 15)] {
        let here = folder(&format!("signal_{name}"));
        let file = here.join("scene.ply");
        let started = Command::new(env!("CARGO_BIN_EXE_rara"))
            .args(["generate", "general", "-n", "1000000", "-o"])
            .arg(&file)
            .stderr(Stdio::piped())
            .spawn()
            .expect("the rara binary runs");
        until("a file", || {
            (unfinished(&here) > 0 || file.exists()).then_some(())
        });
        let pid = started.id().to_string();
        let sent = Command::new("kill").args(["-s", name, &pid]).status();
        assert!(sent.expect("kill runs").success());
        let output = started.wait_with_output().expect("it ends");
        assert_eq!(unfinished(&here), 0, "{name}");
        // A quick machine may have been done with it.
        if !file.exists() {
            assert_eq!(output.status.signal(), Some(number), "{:?}", output.status);
            assert_eq!(
                stderr(&output),
                "rara: interrupted; the unfinished file is removed\n"
            );
        }
    }
}

/// `rara` with no more addresses than this, in KiB.
fn limited(kib: u32, words: &[&str]) -> std::process::Output {
    Command::new("sh")
        .args(["-c", "ulimit -v \"$0\" && exec \"$@\"", &kib.to_string()])
        .arg(env!("CARGO_BIN_EXE_rara"))
        .args(words)
        .env("RARA_CACHE", "")
        .output()
        .expect("sh runs")
}

#[test]
fn memory_that_is_not_there_is_a_sentence() {
    let here = folder("memory");
    let scene = scene(&here);
    let text = |path: &Path| path.to_str().expect("text").to_owned();
    let (scene, out) = (text(&scene), text(&here.join("out.ply")));
    let many = limited(
        400_000,
        &["generate", "general", "-n", "2000000", "-o", &out],
    );
    refused(&many, 1, "memory for 2 000 000 Gaussians");
    assert!(!Path::new(&out).exists());
    // Lavapipe takes three quarters of a GiB for itself.
    for kib in [500_000, 1_000_000, 1_500_000] {
        let large = limited(kib, &["render", &scene, "--size", "4096x4096", "--json"]);
        refused(&large, 1, "memory for a picture of 4096x4096");
    }
}

#[test]
fn drivers_keep_their_shaders_in_the_folder_that_is_named() {
    let here = folder("driver_cache");
    let scene = scene(&here);
    let run = |cache: &Path| {
        let words = [
            "--size", "16x16", "--mode", "none", "--repeat", "1", "--json",
        ];
        let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
        command.arg("render").arg(&scene).args(words);
        command.env("RARA_CACHE", cache).env("HOME", "/nonexistent");
        command
            .env_remove("MESA_SHADER_CACHE_DIR")
            .env_remove("XDG_CACHE_HOME");
        let report = document(command.output().expect("the rara binary runs"));
        let is_mesa = report["driver"]
            .as_str()
            .is_some_and(|driver| driver.contains("Mesa"));
        (report["first_use_ms"].as_f64().expect("a time"), is_mesa)
    };
    let cache = here.join("cache");
    // What opens no device makes nothing there.
    let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
    let helped = command
        .arg("info")
        .arg(&scene)
        .env("RARA_CACHE", &cache)
        .output();
    done(helped.expect("the rara binary runs"));
    assert!(!cache.exists());
    let (first, is_mesa) = run(&cache);
    assert!(cache.join("driver").is_dir());
    if is_mesa {
        assert!(
            fs::read_dir(cache.join("driver"))
                .expect("a folder")
                .count()
                > 0
        );
        let (second, _) = run(&cache);
        assert!(second < first, "{second} ms after {first} ms");
    }
    // Nothing is kept where nothing is to be.
    done(line(
        &here,
        "render @/scene.ply --size 16x16 --mode none --json",
    ));
}

#[test]
fn after_warm_pictures_find_their_shaders_compiled() {
    let here = folder("warm");
    let cache = here.join("cache");
    scene(&here);
    // The driver's own folder serves, so that it compiles nothing for this test alone.
    let home = std::env::var_os("HOME").map(|home| Path::new(&home).join(".cache"));
    let drivers = ["MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME"];
    let set = drivers.iter().find_map(std::env::var_os);
    let drivers = set
        .or(home.map(Into::into))
        .unwrap_or_else(|| here.join("driver").into());
    let run = |words: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
        command.args(
            words
                .split(' ')
                .map(|word| word.replace('@', here.to_str().expect("text"))),
        );
        command
            .env("RARA_CACHE", &cache)
            .env("MESA_SHADER_CACHE_DIR", &drivers);
        done(command.output().expect("the rara binary runs"))
    };
    let lists = || {
        let files = fs::read_dir(&cache)
            .expect("a folder")
            .flatten()
            .map(|file| file.path());
        let lists = files.filter(|path| path.extension() == Some("compiled".as_ref()));
        lists
            .map(|list| fs::read_to_string(list).expect("text"))
            .collect::<Vec<_>>()
    };
    run("warm");
    let warm = lists();
    for clip in [
        "",
        " --clip plane:1,0,0,0.2",
        " --clip sphere:0,0,0,1",
        " --clip box:0,0,0,1,1,1 --clip !sphere:0,0,0,.5",
    ] {
        run(&format!(
            "render @/scene.ply -o @/cut.png --size 96x64{clip}"
        ));
    }
    run(
        "render @/scene.ply -o @/cut.exr --size 96x64 --clip sphere:0,0,0,1 --aov depth,normal,layer,weight,count",
    );
    assert_eq!(lists(), warm, "something was compiled after rara warm");
}
