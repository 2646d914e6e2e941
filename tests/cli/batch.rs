//! `rara batch`: the bytes of single commands, over any number of workers, of which some are killed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::{document, done, folder, line, line_with, refused, scene, stderr, stdout};

/// Writes jobs to a file.
fn jobs(here: &Path, jobs: &Value) -> PathBuf {
    let file = here.join("jobs.json");
    fs::write(&file, jobs.to_string()).expect("written");
    file
}

/// The files of pictures in a folder, with their bytes.
fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder");
    let files = entries.map(|entry| entry.expect("an entry").path());
    let files = files.filter(|file| file.is_file());
    files
        .map(|file| {
            let name = file
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            (name, fs::read(&file).expect("read"))
        })
        .collect()
}

/// How often each picture stands in what is noted.
fn noted(here: &Path) -> BTreeMap<String, usize> {
    let mut noted = BTreeMap::new();
    for entry in fs::read_dir(here.join("jobs.json.done")).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "jsonl") {
            for line in fs::read_to_string(path).expect("text").lines() {
                // The last line of a worker that was killed may be half of one.
                if let Ok(entry) = serde_json::from_str::<Value>(line) {
                    let picture = entry["picture"].as_str().expect("a name").to_owned();
                    *noted.entry(picture).or_default() += 1;
                }
            }
        }
    }
    noted
}

#[test]
fn a_batch_draws_what_its_commands_draw_and_nothing_twice() {
    let here = folder("batch");
    let path = |name: &str| here.join(name).display().to_string();
    let (scene, other) = (scene(&here), path("other.ply"));
    done(line(
        &here,
        "generate layers -n 500 --seed 4 -o @/other.ply",
    ));
    let scene = scene.display().to_string();
    for name in ["one", "many"] {
        fs::create_dir(here.join(name)).expect("a folder");
    }
    let all = json!({"size": "40x32", "jobs": [
        {"scene": scene, "section": "axial=0.2..0.8:4", "output": path("many/axial_{}.png")},
        {"scene": other, "clip": ["plane:x=40%", "sphere:0,0,0,0.8"], "output": path("many/other.exr"), "aov": "depth"},
        {"command": "sweep", "scene": scene, "clip_normal": "0,0,1", "frames": 5, "mode": "hard", "output": path("many/sweep_{:02}.png")},
        {"scene": scene, "path": "orbit", "frames": 3, "output": path("many/round.apng")},
        {"scene": [scene, other], "layer-clip": "other=plane:0,1,0,0", "clip": "plane:z=${z}%", "output": path("many/both_${z:03}.png"),
         "for": {"z": [20, 60]}},
        {"scene": scene, "layer_clip": "scene=plane:1,0,0,0", "output": path("many/cut.png")},
    ]});
    jobs(&here, &all);
    for words in [
        "render @/scene.ply --section axial=0.2..0.8:4 -o @/one/axial_{}.png",
        "render @/other.ply --clip plane:x=40% --clip sphere:0,0,0,0.8 --aov depth -o @/one/other.exr",
        "sweep @/scene.ply --clip-normal 0,0,1 --frames 5 --mode hard -o @/one/sweep_{:02}.png",
        "render @/scene.ply --path orbit --frames 3 -o @/one/round.apng",
        "render @/scene.ply @/other.ply --layer-clip other=plane:0,1,0,0 --clip plane:z=20% -o @/one/both_020.png",
        "render @/scene.ply @/other.ply --layer-clip other=plane:0,1,0,0 --clip plane:z=60% -o @/one/both_060.png",
        "render @/scene.ply --layer-clip scene=plane:1,0,0,0 -o @/one/cut.png",
    ] {
        done(line(&here, &format!("{words} --size 40x32 -q")));
    }
    let output = done(line(&here, "batch @/jobs.json --json"));
    let frames: Vec<Value> = stdout(&output)
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect();
    assert_eq!(frames.len(), 14, "{}", stderr(&output));
    assert!(
        frames
            .iter()
            .all(|one| one["frame"]["wall_ms"].as_f64() > Some(0.0))
    );
    let said = stderr(&output);
    assert!(said.contains("14 of 14 pictures are there\n"), "{said}");
    assert_eq!(said.matches("note: up is -y").count(), 1, "{said}");
    let (one, many) = (pictures(&here.join("one")), pictures(&here.join("many")));
    assert!(
        one.keys().eq(many.keys()),
        "{:?} {:?}",
        one.keys(),
        many.keys()
    );
    for (name, bytes) in &one {
        assert!(&many[name] == bytes, "{name}");
    }

    // Once more, nothing is drawn, and what is gone or cut short is drawn again.
    let again = done(line(&here, "batch @/jobs.json --json"));
    assert_eq!(stdout(&again), "");
    fs::remove_file(here.join("many/cut.png")).expect("removed");
    let short = &one["other.exr"][..one["other.exr"].len() / 2];
    fs::write(here.join("many/other.exr"), short).expect("written");
    refused_by_status(&here, "2 pictures are missing", "many/cut.png");
    refused_by_status(&here, "2 pictures are missing", "many/other.exr");
    let again = done(line(&here, "batch @/jobs.json --json"));
    assert_eq!(stdout(&again).lines().count(), 2);
    assert!(pictures(&here.join("many")) == one, "as they were");
    let status = document(line(&here, "batch @/jobs.json --status --json"));
    assert_eq!(
        (&status["pictures"], &status["there"]),
        (&json!(14), &json!(14))
    );
    let report = document(line(&here, "batch @/jobs.json --report --json"));
    assert_eq!(report["entries"].as_array().map(Vec::len), Some(14));
    assert_eq!(report["workers"].as_array().map(Vec::len), Some(2));

    // Another text of a job is said, and drawn only if that is asked for.
    let mut other = all.clone();
    other["jobs"][5]["layer_clip"] = "scene=plane:0,1,0,0".into();
    jobs(&here, &other);
    let before = fs::read(here.join("many/cut.png")).expect("there");
    let said = stderr(&done(line(&here, "batch @/jobs.json")));
    assert!(
        said.contains("1 picture was drawn by another job") && said.contains("--redraw"),
        "{said}"
    );
    assert!(fs::read(here.join("many/cut.png")).expect("there") == before);
    done(line(&here, "batch @/jobs.json --redraw"));
    assert!(fs::read(here.join("many/cut.png")).expect("there") != before);
}

fn refused_by_status(here: &Path, what: &str, name: &str) {
    let output = line(here, "batch @/jobs.json --status");
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains(what) && said.contains(name), "{said}");
}

#[test]
fn a_command_line_is_saved_as_the_job_that_it_is() {
    let here = folder("batch_saved");
    scene(&here);
    let words = "render @/scene.ply -o @/a.png --size 30x20 --clip plane:-1,0,0,0.25 --clip sphere:0,0,0,1 --clip-op or --trace-all";
    done(line(&here, &format!("{words} --save-job @/jobs.json")));
    done(line(
        &here,
        "sweep @/scene.ply --clip-normal -1,0,0 --frames 2 --size 8x8 -o @/s_{}.png --save-job @/jobs.json",
    ));
    assert!(!here.join("a.png").exists());
    done(line(&here, "batch @/jobs.json"));
    let drawn = fs::read(here.join("a.png")).expect("there");
    assert!(here.join("s_1.png").exists());
    done(line(&here, words));
    assert!(drawn == fs::read(here.join("a.png")).expect("there"));
}

#[test]
fn jobs_that_cannot_be_drawn_are_named_and_the_others_are_drawn() {
    let here = folder("batch_refused");
    let path = |name: &str| here.join(name).display().to_string();
    scene(&here);
    let good = json!({"scene": path("scene.ply"), "output": path("good.png"), "size": "8x8"});
    let with = |changes: Value| {
        let mut job = good.clone();
        for (key, value) in changes.as_object().expect("an object") {
            job[key] = value.clone();
        }
        jobs(&here, &json!([good, job]));
    };
    for (changes, status, what) in [
        (
            json!({"output": path("b.png"), "no_such_flag": 1}),
            2,
            "job 2: unexpected argument '--no-such-flag'",
        ),
        (json!({"output": path("b.png"), "size": "8"}), 2, "job 2: "),
        (json!({}), 2, "is a picture of "),
        (json!({"output": "-"}), 2, "- is standard output"),
        (
            json!({"output": path("b.png"), "frames": 3}),
            2,
            "--frames changes nothing without",
        ),
        (
            json!({"output": path("b.png"), "part": "1/2"}),
            1,
            "rara batch has its own",
        ),
    ] {
        with(changes);
        refused(&line(&here, "batch @/jobs.json"), status, what);
    }
    assert!(!here.join("good.png").exists());
    fs::write(here.join("jobs.json"), "{\"scene\": ").expect("written");
    refused(
        &line(&here, "batch @/jobs.json"),
        1,
        "jobs are a list in JSON",
    );

    with(json!({"scene": path("none.ply"), "output": path("b.png")}));
    let output = line(&here, "batch @/jobs.json");
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    for part in [
        "none.ply",
        "job 2",
        "1 of 2 pictures are there",
        "1 picture is missing",
        "b.png",
    ] {
        assert!(said.contains(part), "'{part}' is not in: {said}");
    }
    assert!(here.join("good.png").exists());
}

/// Many small pictures.
fn many(here: &Path, count: usize) -> usize {
    let scene = scene(here).display().to_string();
    let output = here.join("out/p_{:03}.png").display().to_string();
    jobs(
        here,
        &json!({"scene": scene, "section": format!("axial=0.2..0.8:{count}"), "output": output, "size": "48x48"}),
    );
    count
}

fn begin(here: &Path, more: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
    command.arg("batch").arg(here.join("jobs.json")).args(more);
    command.env("RARA_CACHE", "").stderr(Stdio::null());
    command.spawn().expect("the rara binary runs")
}

fn is_whole(here: &Path, count: usize) {
    let noted = noted(here);
    assert_eq!(noted.len(), count);
    let twice: Vec<_> = noted.iter().filter(|(_, times)| **times != 1).collect();
    assert!(twice.is_empty(), "{twice:?}");
    let drawn = pictures(&here.join("out"));
    let names: Vec<_> = drawn
        .keys()
        .filter(|name| !name.ends_with(".png"))
        .collect();
    assert!(names.is_empty(), "{names:?} were left");
    assert_eq!(drawn.len(), count);
    // The bytes of a run that nobody disturbs.
    fs::rename(here.join("out"), here.join("disturbed")).expect("renamed");
    done(line(here, "batch @/jobs.json --state @/alone"));
    assert!(drawn == pictures(&here.join("out")));
}

#[test]
fn a_worker_that_is_killed_at_any_moment_loses_nothing_and_doubles_nothing() {
    let here = folder("batch_killed");
    let count = many(&here, 120);
    // How long a worker takes that draws them all.
    let start = Instant::now();
    done(line(&here, "batch @/jobs.json --state @/first"));
    let whole = start.elapsed();
    fs::remove_dir_all(here.join("out")).expect("removed");
    let mut random = 12345_u64;
    for _ in 0..20 {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let share = (random >> 40) as f64 / (1_u64 << 24) as f64;
        let mut worker = begin(&here, &[]);
        std::thread::sleep(whole.mul_f64(share) + Duration::from_millis(1));
        worker.kill().expect("killed");
        worker.wait().expect("ended");
    }
    done(line(&here, "batch @/jobs.json"));
    is_whole(&here, count);
}

#[test]
fn workers_share_a_batch_and_two_of_one_part_draw_nothing_twice() {
    let here = folder("batch_shared");
    let count = many(&here, 60);
    let shares = [
        &["--part", "1/3"][..],
        &["--part", "2/3"],
        &["--shard", "2/3"],
    ];
    let workers: Vec<Child> = shares.iter().map(|share| begin(&here, share)).collect();
    for mut worker in workers {
        worker.wait().expect("ended");
    }
    let status = line(&here, "batch @/jobs.json --status");
    assert!(
        stderr(&status).contains("20 pictures are missing"),
        "{}",
        stderr(&status)
    );
    // The third share is that of an array job's last task.
    let mut last = Command::new(env!("CARGO_BIN_EXE_rara"));
    last.arg("batch")
        .arg(here.join("jobs.json"))
        .env("RARA_CACHE", "");
    last.env("JOB_COMPLETION_INDEX", "2").env("RARA_PARTS", "3");
    let output = done(last.output().expect("the rara binary runs"));
    assert!(
        stderr(&output).contains("part 3/3: 20 of 60 pictures"),
        "{}",
        stderr(&output)
    );
    is_whole(&here, count);
    let refused = line_with(
        &here,
        "batch @/jobs.json",
        Some(("JOB_COMPLETION_INDEX", "2")),
    );
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("RARA_PARTS"));
}
