//! The paper's experiments and its user study as commands.

use std::fs;

use super::{document, done, folder, line, refused, stderr};

#[test]
fn a_report_of_one_scene_is_written_and_continued() {
    let here = folder("paper");
    done(line(
        &here,
        "generate layers -n 300 --seed 4 -o @/rings.ply",
    ));
    let run = || stderr(&done(line(&here, "paper @/rings.ply -o @/out")));
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
    done(line(
        &here,
        "generate general -n 200 --seed 4 -o @/scene.ply",
    ));
    let study = document(line(
        &here,
        "study @/study @/scene.ply --cases 2 --method exact --json",
    ));
    assert_eq!(study["cases"].as_array().map(Vec::len), Some(2));
    assert!(here.join("study/index.html").exists());
    refused(
        &line(&here, "study @/other --method hard"),
        2,
        "--method is rara or exact",
    );
    refused(
        &line(&here, "study-report @/scene.ply -o @/report"),
        1,
        "scene.ply",
    );
}
