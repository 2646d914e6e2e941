//! Traces, statistics, and messages of the validation layer.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{document, done, folder, line, line_with, refused, scene, stderr};

/// A trace's spans of one lane: name, begin, end, in microseconds.
fn spans(trace: &Value, lane: &str) -> Vec<(String, f64, f64)> {
    let events = trace["traceEvents"].as_array().expect("events");
    let is_name = |event: &&Value| event["name"] == "process_name" && event["args"]["name"] == lane;
    let pid = &events.iter().find(is_name).expect("the lane's name")["pid"];
    let of_lane = events.iter().filter(|e| e["ph"] == "X" && e["pid"] == *pid);
    of_lane
        .map(|event| {
            let begin = event["ts"].as_f64().expect("a time");
            let length = event["dur"].as_f64().expect("a duration");
            let name = event["name"].as_str().expect("a name");
            (name.to_owned(), begin, begin + length)
        })
        .collect()
}

fn load(file: &Path) -> Value {
    let text = fs::read_to_string(file).expect("the trace was written");
    serde_json::from_str(&text).expect("a trace is JSON")
}

/// The error that a sum of two times may have, us.
const ROUNDING: f64 = 1e-3;

/// Asserts that spans are in order, and each within or after the ones before.
fn assert_nested(spans: &[(String, f64, f64)]) {
    let mut open: Vec<f64> = Vec::new();
    let mut last = 0.0;
    for (name, begin, end) in spans {
        assert!(*begin >= last && end >= begin, "{name}: {begin} to {end}");
        last = *begin;
        open.retain(|until| *until > begin + ROUNDING);
        let holder = open.last().copied().unwrap_or(f64::INFINITY);
        assert!(
            *end <= holder + ROUNDING,
            "{name} outlasts what it began in"
        );
        open.push(*end);
    }
}

#[test]
fn a_trace_has_every_stage_of_every_frame() {
    let here = folder("trace");
    scene(&here);
    for (words, frames) in [
        (
            "render @/scene.ply -o @/a.png --size 96x64 --clip plane:1,0,0,0 --json",
            1,
        ),
        (
            "sweep @/scene.ply -o @/frames --size 64x48 --clip-normal 1,0,0 --frames 4 --independent --json",
            4,
        ),
    ] {
        let report = document(line(&here, &format!("{words} --trace @/trace.json")));
        let trace = load(&here.join("trace.json"));
        let (cpu, gpu) = (spans(&trace, "CPU"), spans(&trace, "GPU"));
        assert_nested(&cpu);
        let count = |name: &str| cpu.iter().filter(|span| span.0 == name).count();
        for (name, least) in [
            ("load", 1),
            ("open", 1),
            ("upload", 1),
            ("render", frames),
            ("configure", frames),
            ("record", frames),
            ("submit and wait", frames),
            ("readback", frames),
            ("encode", frames),
        ] {
            assert!(count(name) >= least, "{name}: {}", count(name));
        }
        let passes = report["passes"].as_array().expect("passes");
        let clock = trace["metadata"]["gpu_clock"].as_str().expect("the clock");
        if passes.is_empty() {
            assert!(clock.starts_with("none"), "{clock}");
            continue;
        }
        assert_nested(&gpu);
        for pass in passes {
            let found = gpu.iter().filter(|span| pass["name"] == *span.0);
            assert!(found.count() >= frames, "{pass}");
        }
        if frames == 1 {
            // The stages of the last submission are those of the statistics.
            let last = &gpu[gpu.len() - passes.len()..];
            for (pass, (_, begin, end)) in passes.iter().zip(last) {
                let ms = pass["ms"].as_f64().expect("a time");
                assert!(((end - begin) / 1e3 - ms).abs() < 1e-3, "{pass}");
            }
        }
        assert!(
            clock.starts_with("calibrated") || clock.starts_with("aligned"),
            "{clock}"
        );
        if clock.starts_with("calibrated") {
            let within = trace["metadata"]["gpu_clock_within_us"].as_f64();
            let slack = 1000.0 + within.expect("how well");
            let waits: Vec<_> = cpu.iter().filter(|s| s.0 == "submit and wait").collect();
            for (name, begin, end) in &gpu {
                let waited = waits
                    .iter()
                    .any(|(_, from, to)| from - slack <= *begin && *end <= to + slack);
                assert!(waited, "{name} at {begin} is in no submission");
            }
        }
    }
    refused(
        &line(
            &here,
            "render none.ply --json --trace @/scene.ply/trace.json",
        ),
        1,
        "not a folder",
    );
}

#[test]
fn statistics_are_there_when_asked_for() {
    let here = folder("statistics");
    scene(&here);
    for raster in ["tiles", "quad"] {
        // On a background tiles are drawn too.
        let words = format!(
            "render @/scene.ply --size 64x48 --clip plane:1,0,0,0 --background 0,0,0 --raster {raster} --validation --json"
        );
        assert!(document(line(&here, &words)).get("statistics").is_none());
        let output = done(line(&here, &format!("{words} --statistics")));
        if stderr(&output).contains("counts nothing") {
            continue;
        }
        let report = document(output);
        let statistics = report["statistics"].as_array().expect("statistics");
        let of = |name: &str, what: &str| {
            let pass = statistics.iter().find(|pass| pass["name"] == name);
            pass.and_then(|pass| pass[what].as_u64()).expect("a count")
        };
        assert!(of("project", "compute_invocations") > 0);
        assert!(of("splat", "fragment_invocations") > 0, "{raster}");
        assert_eq!(of("splat", "compute_invocations"), 0);
        for pass in report["passes"].as_array().expect("passes") {
            let counted = statistics.iter().any(|of| of["name"] == pass["name"]);
            assert!(counted, "{pass}");
        }
    }
    let printed = done(line(
        &here,
        "render @/scene.ply -o @/a.png --size 64x48 --statistics",
    ));
    let printed = stderr(&printed);
    assert!(
        printed.contains("invocations") || printed.contains("counts nothing"),
        "{printed}"
    );
}

#[test]
fn dispatches_are_measured_instead_of_stages_when_asked_for() {
    let here = folder("dispatches");
    scene(&here);
    let words = "render @/scene.ply --size 64x48 --raster tiles --validation --json";
    let times = |variable| -> Vec<(String, f64)> {
        let report = document(line_with(&here, words, variable));
        let passes = report["passes"].as_array().expect("passes");
        let time = |pass: &Value| {
            let name = pass["name"].as_str().expect("a name");
            (name.to_owned(), pass["ms"].as_f64().expect("a time"))
        };
        passes.iter().map(time).collect()
    };
    let stages = times(None);
    let dispatches = times(Some(("RARA_TIMES", "dispatches")));
    let has = |times: &[(String, f64)], name: &str| times.iter().any(|(known, _)| known == name);
    for (name, is_stage, is_dispatch) in [
        ("compact", true, true),
        ("compact_scan", false, true),
        ("bin", true, false),
    ] {
        assert_eq!(has(&stages, name), is_stage, "{stages:?}");
        assert_eq!(has(&dispatches, name), is_dispatch, "{dispatches:?}");
    }
    assert!(
        dispatches.iter().all(|(_, ms)| *ms >= 0.0),
        "{dispatches:?}"
    );
}

#[test]
fn memory_is_listed_by_what_it_is_for() {
    let here = folder("purposes");
    scene(&here);
    let words = "render @/scene.ply --size 64x48 --background 0,0,0 --json";
    let report = document(line(&here, words));
    let memory = &report["memory"];
    let purposes = memory["purposes"].as_array().expect("purposes");
    let sum: u64 = purposes.iter().filter_map(|p| p["bytes"].as_u64()).sum();
    // Only this sum includes what alignment adds.
    let taken = memory["device_bytes"].as_u64().expect("bytes");
    assert!((taken..taken + 65_536).contains(&sum), "{sum} of {taken}");
    for name in ["gaussians", "sh", "splats", "target"] {
        assert!(
            purposes.iter().any(|purpose| purpose["name"] == name),
            "{name}"
        );
    }
}

#[test]
fn a_machine_without_a_driver_prints_what_to_install() {
    let here = folder("no_driver");
    scene(&here);
    let output = Command::new(env!("CARGO_BIN_EXE_rara"))
        .args(["render", "scene.ply", "--json"])
        .current_dir(&*here)
        .env("VK_DRIVER_FILES", here.join("none.json"))
        .env("VK_ICD_FILENAMES", here.join("none.json"))
        .output()
        .expect("the rara binary runs");
    refused(&output, 1, "no Vulkan device was found; install");
}

#[test]
fn a_trace_is_no_picture_and_shows_how_far_failing_work_came() {
    let here = folder("trace_refused");
    scene(&here);
    let both = "render @/scene.ply -o @/a.png --trace @/a.png";
    refused(&line(&here, both), 2, "one file");
    assert!(!here.join("a.png").exists());
    fs::write(here.join("broken.ply"), "ply\n").expect("writes");
    let words = "render @/broken.ply -o @/a.png --trace @/trace.json";
    refused(&line(&here, words), 1, "broken.ply");
    let cpu = spans(&load(&here.join("trace.json")), "CPU");
    assert_eq!(cpu.len(), 1);
    assert_eq!(cpu[0].0, "load");
}
