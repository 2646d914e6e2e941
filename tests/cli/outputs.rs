//! Where the pictures of a run go, and which of them are drawn.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::films::{decoded, files};
use super::paths::frames;
use super::{document, done, folder, line, refused, scene, stderr, stdout};

const SWEEP: &str = "sweep @/scene.ply --clip-normal 0,0,1 --frames 4 --size 32x24";

/// The names in a folder, in order.
fn names(here: &Path) -> Vec<String> {
    let entries = fs::read_dir(here).expect("a folder").flatten();
    let mut names: Vec<_> = entries
        .map(|entry| entry.file_name().into_string().expect("text"))
        .collect();
    names.sort();
    names
}

/// The content of files in a folder.
fn contents(here: &Path) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| {
        let content = fs::read(here.join(&name)).expect("a file");
        (name, content)
    };
    names(here).into_iter().map(read).collect()
}

#[test]
fn a_sweep_writes_what_render_writes() {
    let here = folder("sweep_outputs");
    scene(&here);
    let sweep = |rest: &str| line(&here, &format!("{SWEEP} {rest}"));
    // A folder by its ending, by being there, and because its name is no picture's.
    fs::create_dir(here.join("there.png")).expect("a folder");
    let expected: Vec<_> = (0..4)
        .map(|index| format!("frame_{index:03}.png"))
        .collect();
    for place in ["new/folder", "ending.png/", "there.png", "v1.2"] {
        done(sweep(&format!("-o @/{place}")));
        assert_eq!(names(&here.join(place)), expected, "{place}");
    }
    let pictures: Vec<Vec<u8>> = contents(&here.join("v1.2"))
        .into_iter()
        .map(|(_, bytes)| bytes)
        .collect();
    let report = document(sweep("-o @/numbered/sw_{:04}.png --json"));
    for (index, frame) in frames(&report).iter().enumerate() {
        let file = frame["file"].as_str().expect("a file");
        assert!(file.ends_with(&format!("sw_{index:04}.png")), "{file}");
        assert!(fs::read(file).expect("a picture") == pictures[index]);
    }
    done(sweep("-o @/float/{}.exr"));
    assert_eq!(
        names(&here.join("float")),
        ["0.exr", "1.exr", "2.exr", "3.exr"]
    );
    rara::Picture::load(here.join("float/3.exr")).expect("a picture");
    let single = |index: usize| decoded(&here.join(format!("v1.2/{}", expected[index]))).concat();
    let shown: Vec<_> = (0..4).map(single).collect();
    done(sweep("-o @/film.apng --fps 12"));
    assert!(decoded(&here.join("film.apng")) == shown);
    assert!(done(sweep("-o - --format rgba")).stdout == shown.concat());
    let piped = done(sweep("-o - --format apng --quiet"));
    fs::write(here.join("piped.apng"), &piped.stdout).expect("writes");
    assert!(decoded(&here.join("piped.apng")) == shown);
    done(sweep("-o @/sheet.exr --sheet --sheet-columns 3"));
    let [sheet, last] = ["sheet.exr", "float/3.exr"]
        .map(|file| rara::Picture::load(here.join(file)).expect("a picture"));
    assert_eq!(sheet.width, 3 * last.width + 8);
    let top = sheet.height - last.height;
    for (index, pixel) in last.pixels.iter().enumerate() {
        let (x, y) = (index as u32 % last.width, index as u32 / last.width);
        assert_eq!(
            sheet.at(x, top + y),
            *pixel,
            "the fourth is below the first"
        );
    }
    for (rest, what) in [
        ("-o @/frames --sheet", "name that ends in .png or .exr"),
        ("-o @/sheet.apng --sheet", "name that ends in .png or .exr"),
        ("-o @/a_{}.png --sheet", "a film or a sheet is one file"),
        (
            "-o @/sheet.png --sheet --part 1/2",
            "not for a film or a sheet",
        ),
        ("-o @/one.png --sheet-columns 2", "--sheet"),
        ("-o @/one.png", "a sweep makes several pictures: put {}"),
        ("-o -", "--format apng or rgba"),
        ("-o - --format rgba --json", "both take standard output"),
        ("-o @/sw_{}", "a picture's name ends in .png"),
        ("-o @/sw_{}.apng", "a film or a sheet is one file"),
        ("-o @/frames --fps 9", "--fps is for films"),
        (
            "-o @/frames --format rgba",
            "--format is for standard output",
        ),
        ("-o @/{name}.png", "would be one file"),
        (
            "-o @/a_{}.png --trace @/a_2.png",
            "--trace and -o are one file",
        ),
    ] {
        refused(&sweep(rest), 2, what);
    }
    for new in [
        "one.png",
        "frames",
        "sheet.png",
        "a_{}.png",
        "sw_{}",
        "a_0.png",
    ] {
        assert!(!here.join(new).exists(), "{new}");
    }
}

/// `render` puts several pictures into a folder too, and one into none.
#[test]
fn a_folder_gets_numbered_pictures() {
    let here = folder("folder_outputs");
    scene(&here);
    let words = "render @/scene.ply --size 24x24 --section z=0.2..0.8:3";
    // A name without an ending is that of a folder, which need not be there.
    done(line(&here, &format!("{words} -o @/sections")));
    done(line(&here, &format!("{words} -o @/{{}}.png")));
    for index in 0..3 {
        let [a, b] = [
            format!("sections/frame_{index:03}.png"),
            format!("{index}.png"),
        ]
        .map(|name| fs::read(here.join(name)).expect("a picture"));
        assert!(a == b);
    }
    let one = line(&here, "render @/scene.ply -o @/none/");
    refused(&one, 1, "this is a folder; name a file in it");
    let one = line(&here, "render @/scene.ply -o @/none");
    refused(&one, 2, "a picture's name ends in .png");
    let other = line(&here, &format!("{words} -o @/none.jpg"));
    refused(&other, 2, "a picture's name ends in .png");
    assert!(!here.join("none").exists());
}

/// The words of one run of several pictures each.
const SEVERAL: [&str; 3] = [
    "render @/scene.ply --path orbit --frames 7 --size 16x16",
    "render @/scene.ply --section z=0.2..0.8:7 --size 16x16",
    "sweep @/scene.ply --clip-normal 0,0,1 --frames 7 --size 16x16",
];

#[test]
fn parts_together_are_the_whole() {
    let here = folder("parts");
    scene(&here);
    for words in SEVERAL {
        for place in ["whole", "parts", "one"] {
            let _ = fs::remove_dir_all(here.join(place));
        }
        done(line(&here, &format!("{words} -o @/whole/{{:02}}.png")));
        let whole = contents(&here.join("whole"));
        assert_eq!(whole.len(), 7);
        for part in 1..=3 {
            let words = format!("{words} -o @/parts/{{:02}}.png --part {part}/3 --json");
            let drawn = frames(&document(line(&here, &words))).len();
            assert!((2..=3).contains(&drawn), "{words}: {drawn}");
        }
        assert!(contents(&here.join("parts")) == whole, "{words}");
        // More parts than pictures: one is empty, and needs no device.
        let empty = format!("{words} -o @/one/{{}}.png --part 1/100 --device none --json");
        let document = document(line(&here, &empty));
        assert!(frames(&document).is_empty(), "{document}");
    }
    for (words, what) in [
        (
            "-o @/{}.png --path orbit --part 0/10",
            "a part from 1/10 to 10/10",
        ),
        (
            "--json --path orbit --part 11/10",
            "a part from 1/10 to 10/10",
        ),
        ("--json --path orbit --part 3", "such as 3/10"),
        (
            "--json --part 1/2",
            "--part changes nothing without --path, --view, --section or --from",
        ),
        (
            "-o @/a.apng --path orbit --part 1/2",
            "--part is for pictures in files of their own, and not for a film",
        ),
    ] {
        let words = format!("render @/scene.ply {words}");
        refused(&line(&here, &words), 2, what);
    }
}

#[test]
fn what_is_there_is_left_out() {
    let here = folder("existing");
    scene(&here);
    for words in SEVERAL {
        let _ = fs::remove_dir_all(here.join("p"));
        let run = |rest: &str| line(&here, &format!("{words} -o @/p/{{:02}}.png {rest}"));
        done(run(""));
        let whole = contents(&here.join("p"));
        fs::remove_file(here.join("p/03.png")).expect("a picture");
        fs::remove_file(here.join("p/06.png")).expect("a picture");
        // What is there stays, whatever it is.
        fs::write(here.join("p/01.png"), "mine").expect("writes");
        let printed = done(run("--skip-existing"));
        assert!(
            stderr(&printed).contains("note: 5 of 7 pictures are there and left out"),
            "{}",
            stderr(&printed)
        );
        assert!(fs::read(here.join("p/01.png")).expect("a file") == b"mine");
        fs::write(here.join("p/01.png"), &whole[1].1).expect("writes");
        assert!(contents(&here.join("p")) == whole, "{words}");
        // Nothing is left: no device is opened.
        let nothing = done(run("--skip-existing --device none"));
        assert!(
            stderr(&nothing).contains("7 of 7 pictures"),
            "{}",
            stderr(&nothing)
        );
        let document = document(run("--skip-existing --device none --json"));
        assert!(frames(&document).is_empty());
        done(run("--skip-existing --part 2/2 --device none"));
    }
    // One picture may be there too.
    done(line(&here, "render @/scene.ply -o @/a.png --size 8x8"));
    let printed = done(line(
        &here,
        "render @/scene.ply -o @/a.png --size 8x8 --skip-existing --device none",
    ));
    assert!(
        stderr(&printed).contains("1 of 1 picture is there"),
        "{}",
        stderr(&printed)
    );
    for (words, what) in [
        (
            "-o @/a.apng --path orbit --skip-existing",
            "--skip-existing is for pictures in files of their own",
        ),
        ("-o - --skip-existing", "--skip-existing looks for files"),
        ("--json --skip-existing", "--output"),
    ] {
        refused(
            &line(&here, &format!("render @/scene.ply {words}")),
            2,
            what,
        );
    }
}

/// The documents of lines.
fn lines(text: &str) -> Vec<Value> {
    let line = |line| serde_json::from_str(line).expect("a line is a document");
    text.lines().map(line).collect()
}

#[test]
fn each_picture_has_its_line() {
    let here = folder("json_lines");
    scene(&here);
    for words in SEVERAL {
        let printed = done(line(
            &here,
            &format!("{words} -o @/l/{{}}.png --json-lines"),
        ));
        let lines = lines(&stdout(&printed));
        assert_eq!(lines.len(), 7, "{words}");
        assert!(
            !stderr(&printed).contains("device "),
            "{}",
            stderr(&printed)
        );
        let report = document(line(&here, &format!("{words} -o @/l/{{}}.png --json")));
        for (line, frame) in lines.iter().zip(frames(&report)) {
            for key in ["view", "name", "file", "plane", "counts"] {
                assert_eq!(line[key], frame[key], "{key}");
            }
            assert!(line["wall_ms"].as_f64() > Some(0.0) && line["passes"].is_array());
        }
    }
    // One picture, without a file, and a panorama whose faces are one.
    let words = "render @/scene.ply --size 16x16 --json-lines";
    assert_eq!(lines(&stdout(&done(line(&here, words)))).len(), 1);
    let words = "render @/scene.ply --panorama --eye 0,0,0 --size 16x8 --json-lines";
    let panorama = lines(&stdout(&done(line(&here, words))));
    assert_eq!(
        (panorama.len(), &panorama[0]["name"]),
        (1, &"camera".into())
    );
    for (words, what) in [
        ("--json --json-lines", "--json"),
        (
            "-o - --json-lines",
            "-o - and --json-lines both take standard output",
        ),
        (
            "-o @/a.apng --json-lines",
            "--json-lines is for pictures in files of their own",
        ),
    ] {
        refused(
            &line(&here, &format!("render @/scene.ply {words}")),
            2,
            what,
        );
    }
}

/// Whoever interrupts a run finds as many pictures as lines.
#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_a_line_for_each_picture() {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};
    let here = folder("interrupted_lines");
    let scene = scene(&here);
    let mut child = Command::new(env!("CARGO_BIN_EXE_rara"))
        .arg("render")
        .arg(scene)
        .args("--path orbit --frames 100000 --size 16x16 --json-lines -o".split(' '))
        .arg(here.join("p/{}.png"))
        .env("RARA_CACHE", "")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the rara binary runs");
    let mut reader = BufReader::new(child.stdout.take().expect("piped")).lines();
    let mut next = || reader.next().map(|line| line.expect("text"));
    let mut seen: Vec<Value> = Vec::new();
    let mut keep = |line: String| {
        let document: Value = serde_json::from_str(&line).expect("a line is a document");
        let file = document["file"].as_str().expect("a file");
        assert!(
            Path::new(file).is_file(),
            "a picture is there before its line"
        );
        seen.push(document);
    };
    (0..5).for_each(|_| keep(next().expect("a line")));
    let sent = Command::new("kill")
        .args(["-s", "TERM", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
    while let Some(line) = next() {
        keep(line);
    }
    assert!(!child.wait().expect("it ends").success());
    assert_eq!(files(&here.join("p")), seen.len());
}

/// Pictures are wanted, also when nobody reads their lines any more; without pictures nothing is.
#[cfg(unix)]
#[test]
fn a_reader_that_stops_ends_what_only_measures() {
    use std::process::{Command, Stdio};
    let here = folder("lines_reader");
    let scene = scene(&here);
    let run = |frames: &str, out: Option<&str>| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
        command.arg("render").arg(&scene).args(["--frames", frames]);
        command.args("--path orbit --size 8x8 --json-lines".split(' '));
        if let Some(out) = out {
            command.arg("-o").arg(here.join(out));
        }
        let mut child = command
            .env("RARA_CACHE", "")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the rara binary runs");
        drop(child.stdout.take());
        assert!(child.wait().expect("it ends").success());
    };
    run("100000", None);
    run("3", Some("p/{}.png"));
    assert_eq!(files(&here.join("p")), 3);
}
