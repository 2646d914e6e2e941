//! The commands' work: scenes, pictures, documents.

use std::fs;

use serde_json::Value;

use super::{document, done, folder, line, rara, refused, scene, stderr, stdout};

#[test]
fn generated_scenes_can_be_looked_into() {
    let here = folder("generate");
    for kind in ["general", "strands", "layers"] {
        done(line(
            &here,
            &format!("generate {kind} -n 1000 --seed 5 -o @/{kind}.ply"),
        ));
        let info = document(line(&here, &format!("info @/{kind}.ply --json")));
        assert_eq!(info["gaussians"], 1000, "{kind}");
        assert_eq!(
            (&info["repaired"], &info["dropped"]),
            (&0.into(), &0.into()),
            "{kind}"
        );
        assert!(info["opacity"]["max"].as_f64().unwrap() <= 1.0, "{kind}");
        let printed = done(line(&here, &format!("info @/{kind}.ply")));
        assert!(
            printed.stderr.is_empty() && stdout(&printed).contains("1 000"),
            "{}",
            stderr(&printed)
        );
    }
    let merged = document(line(&here, "info @/general.ply @/layers.ply --json"));
    assert_eq!(merged["gaussians"], 2000);
    done(line(
        &here,
        "generate general -n 1000 --seed 5 -o @/again.ply",
    ));
    assert_eq!(
        fs::read(here.join("general.ply")).unwrap(),
        fs::read(here.join("again.ply")).unwrap()
    );
}

#[test]
fn a_picture_and_its_statistics() {
    let here = folder("render");
    scene(&here);
    let words = "render @/scene.ply -o @/a.png --size 96x64 --clip plane:1,0,0,0 --json";
    let report = document(line(&here, words));
    for key in ["device", "driver", "mode"] {
        assert!(report[key].is_string(), "{key}: {report}");
    }
    assert_eq!(report["mode"], "exact");
    assert_eq!(report["size"], serde_json::json!([96, 64]));
    assert_eq!(report["scene"]["gaussians"], 2000);
    let counts = &report["counts"];
    let classes =
        ["visible", "cutoff", "invisible", "culled"].map(|class| counts[class].as_u64().unwrap());
    assert_eq!(classes.iter().sum::<u64>(), 2000, "{counts}");
    assert!(
        counts["drawn"].as_u64().unwrap() <= classes[0] + classes[1],
        "{counts}"
    );
    assert!(!report["passes"].as_array().unwrap().is_empty());
    for pass in report["passes"].as_array().unwrap() {
        assert!(pass["name"].is_string() && pass["ms"].is_number(), "{pass}");
    }
    assert!(report["gpu_ms"].is_number() && report["wall_ms"].is_number());
    assert!(report["memory"]["device_bytes"].as_u64().unwrap() > 0);
    assert!(report["memory"]["scene_bytes"].as_u64().unwrap() > 0);
    assert!(
        report["memory"]["scene_bytes_per_gaussian"]
            .as_f64()
            .unwrap()
            > 44.0
    );
    assert!(report["memory"]["peak_rss_bytes"].is_u64());
    assert!(report["skipped"].is_array());
    assert_eq!(report["frames"], serde_json::json!([]));

    // The same frame again is the same picture, and only stderr reports it to people.
    let printed = done(line(
        &here,
        "render @/scene.ply -o @/b.png --size 96x64 --clip plane:1,0,0,0",
    ));
    assert!(printed.stdout.is_empty() && stderr(&printed).contains("b.png"));
    let difference = document(line(&here, "compare @/a.png @/b.png --json"));
    assert_eq!(
        (&difference["max"], &difference["psnr"]),
        (&0.0.into(), &Value::Null)
    );
}

#[test]
fn what_a_clip_keeps_and_what_it_cuts_away_differ() {
    let here = folder("clip");
    scene(&here);
    for (name, flags) in [
        ("whole", ""),
        ("none", "--mode none --clip plane:1,0,0,0"),
        ("kept", "--clip plane:1,0,0,0"),
        ("flipped", "--clip !plane:-1,0,0,0"),
        ("away", "--clip plane:-1,0,0,0"),
        ("box", "--clip box:0,0,0,1e6,1e6,1e6"),
        ("nothing", "--clip !box:0,0,0,1e6,1e6,1e6"),
    ] {
        done(line(
            &here,
            &format!("render @/scene.ply -o @/{name}.exr --size 64x64 {flags}"),
        ));
    }
    let largest = |a: &str, b: &str| {
        let measures = document(line(&here, &format!("compare @/{a}.exr @/{b}.exr --json")));
        measures["max"].as_f64().unwrap()
    };
    assert_eq!(largest("whole", "none"), 0.0);
    assert_eq!(largest("whole", "box"), 0.0);
    assert_eq!(largest("kept", "flipped"), 0.0);
    assert!(largest("kept", "away") > 10.0);
    assert!(largest("whole", "nothing") > 10.0);
}

#[test]
fn clip_files_are_the_same_planes() {
    let here = folder("clip_file");
    scene(&here);
    let planes = r#"[{"name": "a", "normal": [2, 0, 0], "d": 0}, {"name": "b:c", "normal": [0, 1, 0], "d": 0.25},
        {"name": "a", "normal": [0, 0, 1], "d": 0.5}]"#;
    fs::write(here.join("planes.json"), planes).unwrap();
    let render = |name: &str, flags: &str| {
        let words = format!("render @/scene.ply -o @/{name}.exr --size 48x48 {flags}");
        done(line(&here, &words));
        fs::read(here.join(format!("{name}.exr"))).unwrap()
    };
    let (a, b, c) = ("plane:1,0,0,0", "plane:0,1,0,0.25", "plane:0,0,1,0.5");
    for (file, typed) in [
        ("planes.json:*", format!("--clip {a} --clip {b} --clip {c}")),
        ("planes.json:a", format!("--clip {a} --clip {c}")),
        ("planes.json:b:c", format!("--clip {b}")),
        ("planes.json:1 --clip-op or", format!("--clip {b}")),
    ] {
        let from_file = render("file", &format!("--clip-file @/{file}"));
        assert!(from_file == render("typed", &typed), "{file}");
    }
    refused(
        &line(
            &here,
            "render @/scene.ply --json --clip-file @/planes.json:d",
        ),
        2,
        "planes.json has 3 clips: ",
    );
    refused(
        &line(&here, "render @/scene.ply --json --clip-file @/none.json:a"),
        1,
        "none.json",
    );
    // A plane that stands still takes away its part of what the moving one leaves.
    let sweep = |flags: &str| {
        let words =
            format!("sweep @/scene.ply --clip-normal 1,0,0 --frames 2 --size 32x32 --json {flags}");
        let sweep = document(line(&here, &words));
        sweep["frames"][0]["counts"]["drawn"].as_u64().unwrap()
    };
    let (alone, joined) = (sweep(""), sweep("--clip-file @/planes.json:2"));
    assert!(0 < joined && joined < alone, "{joined} of {alone}");
    assert_eq!(sweep("--clip-file @/planes.json:2 --clip-op or"), alone);
}

#[test]
fn repeats_and_views_make_frames() {
    let here = folder("frames");
    scene(&here);
    let camera = |x: f64| {
        serde_json::json!({"id": 0, "img_name": format!("view_{x}"), "width": 48, "height": 32, "position": [x, 0.0, -4.0],
            "rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "fx": 40.0, "fy": 40.0})
    };
    let cameras = serde_json::json!([camera(-0.5), camera(0.0), camera(0.5)]);
    fs::write(here.join("cameras.json"), cameras.to_string()).unwrap();

    let all = document(line(
        &here,
        "render @/scene.ply --cameras @/cameras.json --view all -o @/v_{}.png --json",
    ));
    let frames = all["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 3);
    for (number, frame) in frames.iter().enumerate() {
        assert!(here.join(format!("v_{number}.png")).is_file());
        for key in ["passes", "gpu_ms", "wall_ms", "counts", "skipped"] {
            assert!(!frame[key].is_null(), "{key}");
        }
    }
    assert_eq!(all["size"], serde_json::json!([48, 32]));

    let one = document(line(
        &here,
        "render @/scene.ply --cameras @/cameras.json --view view_0.5 --json --repeat 3",
    ));
    assert_eq!(one["frames"], serde_json::json!([]));
    refused(
        &line(
            &here,
            "render @/scene.ply --cameras @/cameras.json --view 3 --json",
        ),
        2,
        "3 cameras",
    );
    refused(
        &line(
            &here,
            "render @/scene.ply --cameras @/cameras.json --view all -o @/v.png",
        ),
        2,
        "{}",
    );

    let sweep = "sweep @/scene.ply --clip-normal -1,0,0 --frames 4 --size 32x32 -o @/sweep --json";
    let sweep = document(line(&here, sweep));
    assert_eq!(sweep["frames"].as_array().unwrap().len(), 4);
    assert!(sweep["mean"]["gpu_ms"].is_number());
    assert!((0..4).all(|index| here.join(format!("sweep/frame_{index:03}.png")).is_file()));
    // The plane enters where nearly all is kept, and leaves where nearly nothing is.
    let kept = |frame: usize| {
        sweep["frames"][frame]["counts"]["visible"]
            .as_u64()
            .unwrap()
    };
    assert!(kept(0) > kept(1) && kept(1) > kept(2) && kept(2) > kept(3));
}

#[test]
fn a_device_that_is_not_there_is_status_1() {
    let here = folder("device");
    scene(&here);
    refused(
        &line(&here, "render @/scene.ply --json --device no-such-device"),
        1,
        "no-such-device",
    );
}

#[test]
fn the_devices_are_listed() {
    let list = document(rara(["devices", "--json"]));
    let devices = list.as_array().unwrap();
    assert!(
        devices.iter().any(|device| device["supported"] == true),
        "{list}"
    );
    let printed = done(rara(["devices"]));
    assert!(
        printed.stderr.is_empty()
            && stdout(&printed).contains(devices[0]["name"].as_str().unwrap())
    );
}

#[test]
fn validation_finds_nothing_to_say() {
    let here = folder("validation");
    scene(&here);
    for mode in ["none", "hard", "rara", "exact"] {
        let words = format!(
            "render @/scene.ply --json --size 64x64 --clip plane:1,0,0,0 --validation --mode {mode}"
        );
        document(line(&here, &words));
    }
}

#[test]
fn the_demo_leaves_five_pictures() {
    let here = folder("demo");
    scene(&here);
    let printed = done(line(&here, "demo @/scene.ply -o @/out --size 64x48"));
    for name in ["none", "hard", "rara", "exact", "sheet"] {
        assert!(here.join(format!("out/{name}.png")).is_file(), "{name}");
    }
    assert!(printed.stdout.is_empty() && stderr(&printed).contains("exact"));
}
