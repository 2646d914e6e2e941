//! Films: all pictures of a run in one file or stream.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use super::paths::frames;
use super::{document, done, folder, line, line_with, refused, scene, stderr, stdout};
use crate::folder::until;

/// The pictures of a PNG, of which an animated one has several: 8-bit RGBA each.
pub(super) fn decoded(file: &Path) -> Vec<Vec<u8>> {
    let file = BufReader::new(File::open(file).expect("a picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let count = reader
        .info()
        .animation_control()
        .map_or(1, |control| control.num_frames);
    let size = reader.output_buffer_size().expect("small");
    let mut picture = || {
        let mut bytes = vec![0; size];
        reader.next_frame(&mut bytes).expect("a picture");
        bytes
    };
    (0..count).map(|_| picture()).collect()
}

/// The number of files in a folder.
pub(super) fn files(here: &Path) -> usize {
    fs::read_dir(here).expect("a folder").count()
}

#[test]
fn films_have_the_pictures_of_the_sequence() {
    let here = folder("films");
    scene(&here);
    let flags = "--path orbit --frames 3 --size 32x24";
    let render = |rest: &str| line(&here, &format!("render @/scene.ply {flags} {rest}"));
    done(render("-o @/{}.png"));
    let pictures: Vec<_> = (0..3)
        .flat_map(|number| decoded(&here.join(format!("{number}.png"))))
        .collect();
    let report = document(render("-o @/new/film.apng --fps 12 --json"));
    assert!(
        frames(&report)[2]["file"]
            .as_str()
            .is_some_and(|file| file.ends_with("film.apng"))
    );
    assert!(decoded(&here.join("new/film.apng")) == pictures);
    let bytes = fs::read(here.join("new/film.apng")).expect("a film");
    let control = bytes
        .windows(4)
        .position(|four| four == b"fcTL")
        .expect("a frame");
    assert_eq!(
        bytes[control + 24..control + 28],
        [0, 1, 0, 12],
        "a twelfth of a second"
    );
    assert!(done(render("-o - --format rgba")).stdout == pictures.concat());
    let piped = done(render("-o - --format apng --quiet"));
    fs::write(here.join("piped.apng"), &piped.stdout).expect("writes");
    assert!(decoded(&here.join("piped.apng")) == pictures);
    // Sections make a film too, of one picture also.
    done(line(
        &here,
        "render @/scene.ply -o @/s.apng --section z=0.2..0.8:4 --size 24x24",
    ));
    assert_eq!(decoded(&here.join("s.apng")).len(), 4);
    let one = done(line(&here, "render @/scene.ply -o @/one.apng --size 24x24"));
    assert!(stderr(&one).contains("note: this is a film of one picture"));
    assert_eq!(decoded(&here.join("one.apng")).len(), 1);
    assert_eq!(files(&here.join("new")), 1, "nothing else is left");
}

/// A film's reader may stop before its end.
#[cfg(unix)]
#[test]
fn a_reader_that_stops_ends_the_film() {
    use std::io::Read;
    use std::process::{Command, Stdio};
    let here = folder("film_reader");
    let scene = scene(&here);
    let mut child = Command::new(env!("CARGO_BIN_EXE_rara"))
        .arg("render")
        .arg(scene)
        .args("-o - --format rgba --path orbit --frames 100000 --size 64x64 --quiet".split(' '))
        .env("RARA_CACHE", "")
        .stdout(Stdio::piped())
        .spawn()
        .expect("the rara binary runs");
    let mut stdout = child.stdout.take().expect("piped");
    stdout.read_exact(&mut [0; 64 * 64 * 4]).expect("a picture");
    drop(stdout);
    assert!(child.wait().expect("it ends").success());
}

/// Numbered scenes are the pictures of a film, each as it would be drawn by itself.
#[test]
fn numbered_scenes_are_a_film() {
    let here = folder("film-scenes");
    scene(&here);
    for (number, scale) in [(3, 1.0), (4, 0.7), (10, 0.4)] {
        let words = format!("convert @/scene.ply -o @/part_{number:03}.ply --scale {scale}");
        done(line(&here, &words));
    }
    let view = "--eye 2,-1,-4 --target 0,0,0 --size 48x32 --repeat 1";
    let film = done(line(
        &here,
        &format!("render @/part_{{:03}}.ply {view} -o - --format rgba"),
    ));
    let alone = |number: u32| {
        let words = format!("render @/part_{number:03}.ply {view} -o - --format rgba");
        done(line(&here, &words)).stdout
    };
    let all = [alone(3), alone(4), alone(10)];
    assert!(all[0] != all[1] && all[1] != all[2]);
    assert!(film.stdout == all.concat());
    // Pictures have the numbers of their scenes, and names.
    let words =
        format!("render @/part_{{:03}}.ply {view} -o @/p_{{:02}}_{{name}}.png --json-lines");
    let lines = stdout(&done(line(&here, &words)));
    assert_eq!(lines.lines().count(), 3);
    for name in [
        "p_03_part_003.png",
        "p_04_part_004.png",
        "p_10_part_010.png",
    ] {
        assert!(here.join(name).is_file(), "{name}");
    }
    let around = "render @/part_{:03}.ply --path orbit --size 48x32 -o - --format rgba --frames";
    let orbit = done(line(&here, &format!("{around} 3")));
    assert_eq!(orbit.stdout.len(), 3 * 4 * 48 * 32);
    for (words, says) in [
        (format!("{around} 4"), "3 scenes and 4 cameras"),
        (
            "render @/part_{:03}.ply -o @/a_{}.png --section z=0".into(),
            "--section cuts one scene",
        ),
        (
            format!("render @/part_{{:03}}.ply {view} -o @/one.png"),
            "these scenes make several pictures",
        ),
        (
            format!("render @/none_{{}}.ply {view} -o @/a.apng"),
            "none_{}.ply: there is no file of that name",
        ),
    ] {
        refused(&line(&here, &words), 2, says);
    }
}

/// Makes a program that is found as ffmpeg in `here`, and returns the PATH.
#[cfg(unix)]
fn encoder(here: &Path, script: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let bin = here.join("bin");
    fs::create_dir_all(&bin).expect("a folder");
    let file = bin.join("ffmpeg");
    fs::write(
        &file,
        format!("#!/bin/sh\nfor last; do :; done\nlast=${{last#file:}}\n{script}\n"),
    )
    .expect("writes");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).expect("ours");
    format!("{}:/usr/bin:/bin", bin.display())
}

#[cfg(unix)]
#[test]
fn ffmpeg_gets_opaque_pictures_and_its_failures_are_sentences() {
    let here = folder("ffmpeg");
    scene(&here);
    let flags = "--path orbit --frames 3 --size 32x24";
    let film = |path: &str, rest: &str| {
        line_with(
            &here,
            &format!("render @/scene.ply {flags} {rest}"),
            Some(("PATH", path)),
        )
    };
    let path = encoder(&here, "echo \"$@\" > \"$0.words\"; cat > \"$last\"");
    let made = done(film(&path, "-o @/film.mp4 --fps 24"));
    assert!(
        stderr(&made).contains("no transparency"),
        "{}",
        stderr(&made)
    );
    let raw = done(line(
        &here,
        &format!("render @/scene.ply {flags} --background black -o - --format rgba"),
    ));
    assert!(fs::read(here.join("film.mp4")).expect("a film") == raw.stdout);
    let words = fs::read_to_string(here.join("bin/ffmpeg.words")).expect("words");
    for part in ["-video_size 32x24", "-framerate 24", "-f mp4"] {
        assert!(words.contains(part), "{part}: {words}");
    }
    let sweep = "sweep @/scene.ply --clip-normal 0,0,1 --frames 3 --size 32x24";
    let path_is = Some(("PATH", path.as_str()));
    done(line_with(
        &here,
        &format!("{sweep} -o @/sweep.mp4"),
        path_is,
    ));
    let raw = done(line(
        &here,
        &format!("{sweep} --background black -o - --format rgba"),
    ));
    assert!(fs::read(here.join("sweep.mp4")).expect("a film") == raw.stdout);
    let made = done(film(&path, "-o @/film.webm --background white"));
    assert!(
        !stderr(&made).contains("no transparency"),
        "{}",
        stderr(&made)
    );
    let raw = done(line(
        &here,
        &format!("render @/scene.ply {flags} -o - --format rgba"),
    ));
    for (name, words_are) in [
        ("clear.mov", "-pix_fmt rgba -c:v png"),
        ("clear.webm", "format=yuva420p"),
    ] {
        let made = done(film(&path, &format!("-o @/{name} --alpha")));
        assert!(!stderr(&made).contains("no transparency"));
        assert!(fs::read(here.join(name)).expect("a film") == raw.stdout);
        let words = fs::read_to_string(here.join("bin/ffmpeg.words")).expect("words");
        assert!(words.contains(words_are), "{words}");
    }
    for name in ["clear.mp4", "clear.mkv", "clear.png"] {
        let what = format!("-o @/{name} --alpha");
        refused(&film(&path, &what), 2, "a name that ends in .mov or .webm");
    }
    let before = files(&here);
    for script in [
        "echo 'Unknown encoder libx264.' >&2; exit 1",
        "cat > \"$last\"; echo 'Unknown encoder libx264.' >&2; exit 1",
    ] {
        let failed = film(&encoder(&here, script), "-o @/none.mkv --background white");
        refused(
            &failed,
            1,
            "none.mkv: ffmpeg could not encode the film (Unknown encoder libx264)",
        );
    }
    refused(
        &film(&here.join("nowhere").to_string_lossy(), "-o @/none.mov"),
        1,
        "ffmpeg, which is not on the PATH",
    );
    assert_eq!(files(&here), before, "nothing is left of it");
}

#[cfg(unix)]
#[test]
fn a_signal_ends_the_encoder_and_removes_the_film() {
    use std::process::{Command, Stdio};
    let here = folder("film_signal");
    let scene = scene(&here);
    let path = encoder(&here, "echo $$ > \"$0.pid\"; exec cat > \"$last\"");
    let child = Command::new(env!("CARGO_BIN_EXE_rara"))
        .arg("render")
        .arg(scene)
        .args("--path orbit --frames 100000 --size 16x16 --quiet -o".split(' '))
        .arg(here.join("film.mp4"))
        .env("RARA_CACHE", "")
        .env("PATH", path)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the rara binary runs");
    let is_part = |entry: &fs::DirEntry| entry.file_name().to_string_lossy().ends_with(".part");
    let parts = || {
        fs::read_dir(&*here)
            .expect("a folder")
            .flatten()
            .filter(is_part)
    };
    let is_begun = |part: fs::DirEntry| part.metadata().is_ok_and(|about| about.len() > 4096);
    until("a part", || parts().any(is_begun).then_some(()));
    // A shell has what it runs in the background ignore interrupts, and tests may be run so.
    let sent = Command::new("kill")
        .args(["-s", "TERM", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(
        stderr(&output),
        "rara: interrupted; the unfinished file is removed\n"
    );
    let encoder = fs::read_to_string(here.join("bin/ffmpeg.pid")).expect("a number");
    let alive = Command::new("kill")
        .args(["-0", encoder.trim()])
        .stderr(Stdio::null())
        .status();
    assert!(
        !alive.expect("kill runs").success(),
        "the encoder has ended"
    );
    assert_eq!(
        (parts().count(), here.join("film.mp4").exists()),
        (0, false)
    );
}
