//! The program `rara-lab` as people use it. Nothing here is timed.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use rara::scene::{Kind, generate, save};

use crate::folder::Folder;
use crate::output::{document, done, plurals, refused, stderr, stdout};

/// Runs `rara-lab` with a line's words; `@` stands for `folder`. Commands that draw do so on `RARA_TEST_DEVICE` if that is
/// set.
fn lab(folder: &Path, words: &str) -> Output {
    let folder = folder.to_str().expect("the test folder's name is text");
    let words = words.split_whitespace();
    let mut words: Vec<String> = words.map(|word| word.replace('@', folder)).collect();
    let draws = ["ablate", "bench", "paper", "study"].contains(&words[0].as_str());
    if let Some(device) = std::env::var("RARA_TEST_DEVICE").ok().filter(|_| draws) {
        words.extend(["--device".into(), device]);
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_rara-lab"));
    // The tests must not use the user's own cache.
    let output = command.args(words).env("RARA_CACHE", "").output();
    output.expect("the program runs")
}

fn folder(test: &str) -> Folder {
    Folder::new(&format!("lab-{test}"))
}

/// A small scene in `folder`, under this name.
fn scene(folder: &Path, name: &str, kind: Kind, count: usize) {
    let file = folder.join(name).with_extension("ply");
    save(&file, &generate(kind, count, 4)).expect("the folder is writable");
}

#[test]
fn every_command_has_help_with_an_example() {
    let here = folder("help");
    let overview = stdout(&done(lab(&here, "--help")));
    for command in [
        "bench",
        "measure",
        "ablate",
        "stress",
        "paper",
        "study",
        "study-report",
    ] {
        assert!(overview.contains(&format!("\n  {command} ")), "{command}");
        let help = stdout(&done(lab(&here, &format!("{command} --help"))));
        for part in [
            format!("Usage: rara-lab {command}"),
            format!("  rara-lab {command}"),
        ] {
            assert!(help.contains(&part), "{part}: {help}");
        }
    }
    let version = concat!("rara-lab ", env!("CARGO_PKG_VERSION"), "\n");
    assert_eq!(stdout(&done(lab(&here, "--version"))), version);
    let script = stdout(&done(lab(&here, "completions bash")));
    assert!(script.contains("default rara-lab"), "{script}");
    for (words, what) in [
        (
            "render scene.ply -o a.png",
            "rara has the commands that draw",
        ),
        ("bench --frames 0 scene.ply", "0"),
        ("paper -o {}", "leave them out"),
        ("measure pass", "passes"),
        ("stress nobody", "no regime has such a name"),
    ] {
        refused(&lab(&here, words), 2, what);
    }
}

#[test]
fn one_gaussian_is_not_called_several() {
    let here = folder("plurals");
    scene(&here, "one", Kind::General, 1);
    let drawn = "@/one.ply --size 16x16";
    for words in [
        format!("ablate {drawn}"),
        format!("bench {drawn} --frames 1 --steps 1 --only exact -o @/bench"),
    ] {
        let output = done(lab(&here, &words));
        let text = stdout(&output) + &stderr(&output);
        assert_eq!(plurals(&text), Vec::<String>::new(), "{words}:\n{text}");
    }
    let tables = fs::read_to_string(here.join("bench/bench.md")).expect("tables");
    assert_eq!(plurals(&tables), Vec::<String>::new(), "{tables}");
}

#[test]
fn a_plane_at_infinity_changes_nothing_unless_all_is_traced() {
    let here = folder("ablate");
    scene(&here, "scene", Kind::General, 2000);
    let rows = document(lab(&here, "ablate @/scene.ply --size 64x64 --json"));
    for row in rows.as_array().unwrap() {
        let what = row["what"].as_str().unwrap();
        // Only the reading that drops a missing ray takes anything from splats that are not cut.
        let same = row["l1"].as_f64().unwrap() < 0.01;
        assert_eq!(same, !what.contains("drop"), "{row}");
    }
}

#[test]
fn a_bench_measures_every_choice_and_writes_its_tables() {
    let folder = folder("bench");
    scene(&folder, "scene", Kind::General, 2000);
    let words = "bench @/scene.ply --size 48x40 --frames 1 --steps 1 --shapes -o @/out --json";
    let report = document(lab(&folder, words));
    let rows = report["rows"].as_array().expect("rows");
    assert!(rows.len() > 20 && report["refused"].as_array().is_some_and(Vec::is_empty));
    let of = |name: &str| rows.iter().find(|row| row["name"] == name).expect("a row");
    assert!(of("exact")["l1"].as_f64() < of("hard")["l1"].as_f64());
    assert!(rows.iter().any(|row| row["undominated"] == true));
    for row in rows {
        let [l1, leak, loss] = ["l1", "leak", "loss"].map(|key| row[key].as_f64().unwrap());
        assert!((l1 - leak - loss).abs() <= 1e-9 * l1.max(1.0), "{row}");
    }
    // Four ways of cutting, at 256 and at the size asked for.
    assert_eq!(report["paper"].as_array().map(Vec::len), Some(8));
    let shapes = report["shapes"].as_array().expect("shapes");
    for shape in shapes {
        let [l1, by_centres, cut] = ["l1", "hard_l1", "cutoff"].map(|key| shape[key].as_f64());
        // A shape around everything cuts nothing, and is no worse by centres.
        assert!(cut == Some(0.0) || l1 < by_centres, "{shape}");
        assert!(shape["twin_psnr"].as_f64() > Some(60.0), "{shape}");
    }
    let shape = |name: &str| shapes.iter().find(|shape| shape["name"] == name);
    let around = shape("sphere around everything").expect("a row");
    assert!(around["cutoff"] == 0 && shape("mesh of 1280 faces").is_some());
    for name in ["bench.md", "bench.csv", "bench.json", "pareto.svg"] {
        let text = fs::read_to_string(folder.join("out").join(name)).expect(name);
        assert!(text.contains("preset fast"), "{name}");
    }
}

#[test]
fn a_report_of_one_scene_is_written_and_continued() {
    let here = folder("paper");
    scene(&here, "rings", Kind::Layers, 300);
    let run = || stderr(&done(lab(&here, "paper @/rings.ply -o @/out")));
    assert!(run().contains("index.html"));
    let page = fs::read_to_string(here.join("out/index.html")).expect("a page");
    for part in [
        "Render efficiency",
        "rings, face",
        "Topological integrity",
        "Cost by resolution",
        "data:image/png;base64,",
        "</html>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("http://localhost") && !page.contains(" src=\"maps/"));
    // Where nothing is cut, the modes draw what mode none draws.
    let rows = fs::read_to_string(here.join("out/ablation-1.csv")).expect("a table");
    for mode in ["hard", "rara", "exact"] {
        assert!(rows.contains(&format!("\"{mode}\",0,0,1,0\n")), "{rows}");
    }
    // What was measured is kept: the second run writes the same page but for nothing.
    let parts = || {
        let file = here.join("out/parts/case--rings--face.json");
        fs::metadata(file)
            .expect("a part")
            .modified()
            .expect("a time")
    };
    let before = parts();
    run();
    assert_eq!(parts(), before);
    let again = fs::read_to_string(here.join("out/index.html")).expect("a page");
    assert!(again == page, "another page from the same results");
}

#[test]
fn a_study_is_written_and_needs_answers() {
    let here = folder("study");
    scene(&here, "scene", Kind::General, 200);
    let study = document(lab(
        &here,
        "study @/study @/scene.ply --cases 2 --method exact --json",
    ));
    assert_eq!(study["cases"].as_array().map(Vec::len), Some(2));
    assert!(here.join("study/index.html").exists());
    refused(
        &lab(&here, "study @/other --method hard"),
        2,
        "--method is rara or exact",
    );
    refused(
        &lab(&here, "study-report @/scene.ply -o @/report"),
        1,
        "scene.ply",
    );
}
