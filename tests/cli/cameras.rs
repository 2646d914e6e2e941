//! Which cameras draw, and that what is said of them draws the same pictures again.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{document, done, folder, line, refused, scene, stderr};

/// The bytes of the picture, or the pictures, that these words draw, and the statistics.
fn drawn(here: &Path, words: &str) -> (Vec<u8>, Value) {
    let words = format!("render @/scene.ply -o @/drawn.exr --repeat 1 --json {words}");
    let report = document(line(here, &words));
    let bytes = fs::read(here.join("drawn.exr")).expect("a picture");
    (bytes, report)
}

/// Four cameras of 48x32 pixels that look at the scene from -z, farther and farther.
fn cameras(here: &Path) {
    let camera = |number: i32| {
        json!({"img_name": format!("v{number}.png"), "width": 48, "height": 32,
            "position": [0.1 * f64::from(number), 0.0, -4.0 - f64::from(number)],
            "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "fx": 40.0, "fy": 40.0})
    };
    let all: Vec<_> = (0..4).map(camera).collect();
    fs::write(here.join("cameras.json"), json!(all).to_string()).expect("writes");
}

#[test]
fn the_camera_that_is_reported_or_saved_draws_the_same_bytes() {
    let here = folder("cameras_again");
    scene(&here);
    let planes = "--clip plane:0,0.6,0.8,-0.1";
    for (words, clip) in [
        ("--size 97x64", ""),
        ("--size 97x64 --up 0.3,-1,0.2 --fov-y 37", planes),
        ("--size 64x97 --ortho fit", ""),
        (
            "--eye 1,-2,-5 --target 0.1,0.2,0.3 --size 64x48 --ortho 3.1",
            planes,
        ),
        ("--size 64x48 --clip-near 3 --clip-far 4 --near-cut 2.5", ""),
    ] {
        let (bytes, report) = drawn(&here, &format!("{words} {clip} --save-camera @/saved.json"));
        let saved = fs::read_to_string(here.join("saved.json")).expect("a camera");
        let saved: Value = serde_json::from_str(&saved).expect("JSON");
        assert_eq!(saved, report["camera"], "{words}");
        let (again, _) = drawn(&here, &format!("--camera @/saved.json {clip}"));
        assert!(bytes == again, "{words}");
        let again = drawn(&here, &format!("--cameras @/saved.json {clip}"));
        assert!(bytes == again.0, "{words}");
        // What is reported of the picture that is drawn again is what was reported before.
        assert_eq!(again.1["camera"], saved, "{words}");
    }
}

/// Lenses that bend lines are refused where one is drawn, and --undistort draws their pinholes.
#[test]
fn lenses_that_bend_lines_are_drawn_as_pinholes_on_request() {
    let here = folder("cameras_lenses");
    scene(&here);
    fs::create_dir(here.join("model")).expect("a folder");
    let put =
        |name: &str, text: &str| fs::write(here.join("model").join(name), text).expect("writes");
    put(
        "cameras.txt",
        "1 PINHOLE 48 32 40 40 24 16\n2 OPENCV 48.25 32 40 40 24 16 .1 0 0 0\n3 OTHER 1 1\n",
    );
    put(
        "images.txt",
        "1 1 0 0 0 0 0 4 1 a\n\n2 1 0 0 0 0 0 4 2 b\n\n3 1 0 0 0 0 0 4 2 c\n\n4 1 0 0 0 0 0 4 3 d\n\n",
    );
    let render = |words: &str| {
        line(
            &here,
            &format!("render @/scene.ply -o @/l_{{}}.exr --repeat 1 --cameras @/model {words}"),
        )
    };
    done(render("--view a"));
    for (view, says) in [
        ("b", "`b` (camera 2 of cameras.txt) has the lens OPENCV"),
        ("all", "--undistort draws that of the same focal lengths"),
        ("d --undistort", "of the model OTHER, which is not known"),
    ] {
        let output = render(&format!("--view {view}"));
        assert!(stderr(&output).contains("images.txt"));
        refused(&output, 1, says);
    }
    let output = render("--view 0..2 --undistort");
    let said = stderr(&output);
    for says in [
        "note: camera b: its OPENCV lens is drawn as a pinhole, without distortion; 1 other camera is changed likewise",
        "note: camera b: its width of 48.25 pixels is taken for 48; 1 other camera is changed likewise",
    ] {
        assert!(said.contains(says), "{said}");
    }
    done(output);
    let picture = |number: u32| fs::read(here.join(format!("l_{number}.exr"))).expect("a picture");
    assert!(picture(0) == picture(1) && picture(1) == picture(2));
    let output = line(&here, "render @/scene.ply -o @/x.png --undistort");
    refused(&output, 2, "--undistort changes nothing without");
}

#[test]
fn a_section_s_camera_and_plane_draw_it_again() {
    let here = folder("cameras_section");
    scene(&here);
    let words = "render @/scene.ply -o @/s_{}.exr --size 96x64 --section coronal=0.3 --section !z=0.6 --repeat 1 --json \
                 --save-camera @/saved.json";
    let report = document(line(&here, words));
    for number in 0..2 {
        let frame = &report["frames"][number];
        fs::write(here.join("one.json"), frame["camera"].to_string()).expect("writes");
        let plane: Vec<_> = frame["plane"].as_array().expect("a plane").iter().collect();
        let plane: Vec<_> = plane.iter().map(|value| value.to_string()).collect();
        let clip = format!("--clip plane:{}", plane.join(","));
        let picture = fs::read(here.join(format!("s_{number}.exr"))).expect("a picture");
        let name = frame["name"].as_str().expect("a name");
        for camera in [
            "--camera @/one.json".to_owned(),
            format!("--cameras @/saved.json --view {number}"),
            format!("--cameras @/saved.json --view {name}"),
            format!("--camera @/saved.json --view {name}"),
        ] {
            let (again, _) = drawn(&here, &format!("{camera} {clip}"));
            assert!(again == picture, "{camera} {clip}");
        }
    }
    let output = line(&here, "render @/scene.ply -o @/x.png --camera @/saved.json");
    refused(&output, 2, "has 2 cameras: choose by --view");
}

#[test]
fn cameras_of_a_path_and_of_a_panorama_draw_their_frames_again() {
    let here = folder("cameras_path");
    scene(&here);
    cameras(&here);
    for path in ["spline:0,3,1", "orbit:0.37"] {
        let words = format!(
            "render @/scene.ply -o @/p_{{}}.exr --path {path} --frames 4 --size 48x32 --repeat 1 --save-camera @/saved.json"
        );
        done(line(&here, &words));
        let kind = path.split(':').next().expect("a kind");
        for number in 0..4 {
            let picture = fs::read(here.join(format!("p_{number}.exr"))).expect("a picture");
            let words = format!("--cameras @/saved.json --view {kind}_{number}");
            assert!(drawn(&here, &words).0 == picture, "{words}");
        }
        let again = "render @/scene.ply -o @/q_{}.exr --cameras @/saved.json --view all --repeat 1";
        done(line(&here, again));
        let picture = |name: &str| fs::read(here.join(name)).expect("a picture");
        assert!((0..4).all(|n| picture(&format!("p_{n}.exr")) == picture(&format!("q_{n}.exr"))));
    }
    let panorama = "--panorama --size 64x32";
    let around = format!("{panorama} --eye 0,0,-1 --target 0.2,-0.4,0 --save-camera @/around.json");
    let (bytes, _) = drawn(&here, &around);
    assert!(drawn(&here, &format!("{panorama} --camera @/around.json")).0 == bytes);
}

#[test]
fn a_sweep_s_camera_is_that_of_each_frame() {
    let here = folder("cameras_sweep");
    scene(&here);
    let words = "sweep @/scene.ply --clip-normal 0,0,1 --frames 3 --size 48x32 --json --save-camera @/saved.json";
    let report = document(line(&here, words));
    let saved = fs::read_to_string(here.join("saved.json")).expect("a camera");
    let saved: Value = serde_json::from_str(&saved).expect("JSON");
    assert_eq!(report["camera"], saved);
    for frame in report["frames"].as_array().expect("frames") {
        assert_eq!(frame["camera"], saved);
    }
    let words = "render @/scene.ply --size 48x32 --json --repeat 1";
    assert_eq!(document(line(&here, words))["camera"], saved);
}

#[test]
fn ranges_and_lists_choose_cameras() {
    let here = folder("cameras_ranges");
    scene(&here);
    cameras(&here);
    let numbers = |view: &str| {
        let words = format!("render @/scene.ply --json --repeat 1 --view {view}");
        let report = document(line(&here, &words));
        let frames = report["frames"].as_array().expect("frames");
        let number = |frame: &Value| frame["view"].as_u64().expect("a number");
        frames.iter().map(number).collect::<Vec<_>>()
    };
    assert_eq!(numbers("1..3"), [1, 2, 3]);
    assert_eq!(numbers("3..2,v0"), [3, 2, 0]);
    let words = "render @/scene.ply -o @/p_{}.png --json --repeat 1 --path cameras:1..2,0";
    assert_eq!(document(line(&here, words))["frames"][1]["view"], 2);
    for (words, says) in [
        (
            "render @/scene.ply -o @/x.png --view 1..2",
            "--view 1..2 makes several pictures: put {}",
        ),
        (
            "render @/scene.ply -o @/{}.png --view 1..4",
            "--view 1..4: ",
        ),
        (
            "render @/scene.ply -o @/{}.png --view 0,0",
            "would be one file",
        ),
        (
            "sweep @/scene.ply --clip-normal 0,0,1 --view 1..2",
            "a sweep without --path has one camera, and these are 2",
        ),
    ] {
        let output = line(&here, words);
        assert!(
            stderr(&output).contains(says),
            "{words}: {}",
            stderr(&output)
        );
        assert!(output.status.code() == Some(2) && output.stdout.is_empty());
    }
}

#[test]
fn an_eye_or_a_target_by_itself_is_enough_and_a_view_along_up_has_another() {
    let here = folder("cameras_partial");
    scene(&here);
    let camera = |words: &str| drawn(&here, &format!("--size 48x32 {words}")).1["camera"].clone();
    let numbers = |value: &Value| {
        let array = value.as_array().expect("numbers").iter();
        array
            .map(|n| n.as_f64().expect("a number"))
            .collect::<Vec<_>>()
    };
    let usual = camera("");
    let from = camera("--eye -1,-2,-4");
    assert_eq!(numbers(&from["eye"]), [-1.0, -2.0, -4.0]);
    // The middle of the scene, which is near the origin, is in the middle of the picture.
    let matrix = numbers(&from["world_to_camera"]);
    assert!(
        matrix[3].abs() < 0.3 && matrix[7].abs() < 0.3 && matrix[11] > 4.0,
        "{matrix:?}"
    );
    let at = camera("--target 7,0,0");
    let (usual, at) = (
        numbers(&usual["world_to_camera"]),
        numbers(&at["world_to_camera"]),
    );
    let axes = |matrix: &[f64]| {
        (0..3)
            .flat_map(|row| matrix[4 * row..4 * row + 3].to_vec())
            .collect::<Vec<_>>()
    };
    assert_eq!(axes(&usual), axes(&at));
    let seen = |row: usize| 7.0 * at[4 * row] + at[4 * row + 3];
    assert!(seen(0).abs() < 1e-9 && seen(1).abs() < 1e-9 && (seen(2) - usual[11]).abs() < 0.3);
    let orbit = "render @/scene.ply -o @/o_{}.exr --size 48x32 --repeat 1 --path orbit --frames 2 --eye -1,-2,-4";
    done(line(&here, orbit));
    let above = "render @/scene.ply -o @/above_{}.png --size 8x8 --repeat 1 --path orbit --frames 2 --eye 0,-3,0 --target 0,0,0";
    let printed = stderr(&done(line(&here, above)));
    assert!(
        printed.contains("looks along what is up; up in the picture is z"),
        "{printed}"
    );
    let first = fs::read(here.join("o_0.exr")).expect("a picture");
    assert!(first == drawn(&here, "--size 48x32 --eye -1,-2,-4").0);

    for (eye, up, other) in [
        ("0,-4,0", "-y", "z"),
        ("0,0,5", "z", "-y"),
        ("0.3,0,0", "0.5,0,0", "z"),
    ] {
        let words = format!(
            "render @/scene.ply -o @/along.exr --size 48x32 --repeat 1 --eye {eye} --target 0,0,0"
        );
        let printed = stderr(&done(line(&here, &format!("{words} --up {up}"))));
        let says = format!("looks along what is up; up in the picture is {other}");
        assert!(printed.contains(&says), "{printed}");
        let along = fs::read(here.join("along.exr")).expect("a picture");
        let printed = stderr(&done(line(&here, &format!("{words} --up {other}"))));
        assert!(!printed.contains("looks along"), "{printed}");
        assert!(
            along == fs::read(here.join("along.exr")).expect("a picture"),
            "{eye}"
        );
    }
}

/// What the near cut takes is said, with the depth that draws it.
#[test]
fn what_is_nearer_than_splats_are_drawn_is_counted() {
    let here = folder("cameras_near");
    scene(&here);
    done(line(
        &here,
        "convert @/scene.ply -o @/tiny.ply --place scale:0.01",
    ));
    let draw = |scene: &str, words: &str| {
        let output = done(line(
            &here,
            &format!("render @/{scene} -o @/n_{{}}.png --size 32x32 --repeat 1 {words}"),
        ));
        stderr(&output)
    };
    let remedy = |said: &str| {
        let depth = said
            .split("--near-cut ")
            .nth(1)
            .expect("a remedy")
            .split(' ')
            .next()
            .expect("a depth");
        assert!(
            said.contains(&format!("--near-cut {depth} draws them")),
            "{said}"
        );
        depth.to_owned()
    };
    // All of it, which is an empty picture, and some.
    let tiny = "--eye 0,0,-0.05 --target 0,0,0";
    let said = draw("tiny.ply", tiny);
    assert!(
        said.contains("warning: the picture is empty: the 2 000 Gaussians in view are nearer"),
        "{said}"
    );
    let said = draw("tiny.ply", &format!("{tiny} --near-cut {}", remedy(&said)));
    assert!(!said.contains("nearer"), "{said}");
    // A layer that is placed says what its file says. Its own clip stands in the world, in place of the frame's.
    let half = "plane:1,0,0,-0.002";
    let nearer = |scene: &str, words: &str| {
        let said = draw(scene, &format!("{tiny} {words}"));
        let line = said.lines().find(|line| line.contains("nearer"));
        line.unwrap_or_else(|| panic!("{words}: {said}")).to_owned()
    };
    let placed = "scene.ply --place scale:0.01";
    assert_eq!(nearer(placed, ""), nearer("tiny.ply", ""));
    let cut = nearer("tiny.ply", &format!("--clip {half}"));
    assert!(!cut.contains("2 000"), "{cut}");
    for words in [
        format!("--clip {half}"),
        format!("--layer-clip scene={half}"),
        format!("--layer-clip scene={half} --clip plane:0,0,1,-1"),
    ] {
        assert_eq!(nearer(placed, &words), cut, "{words}");
    }
    let said = draw(
        "scene.ply",
        "--eye 0,0,-0.3 --target 0,0,0 --path orbit --frames 3",
    );
    assert!(
        said.contains("note: ")
            && said.contains(" Gaussians of orbit_")
            && said.contains("would be in view"),
        "{said}"
    );
    let said = draw(
        "scene.ply",
        &format!(
            "--eye 0,0,-0.3 --target 0,0,0 --path orbit --frames 3 --near-cut {}",
            remedy(&said)
        ),
    );
    assert!(!said.contains("would be in view"), "{said}");
    // What is cut away, or beside the picture, is not missed, and a scene of usual units has nothing so near.
    for words in [
        "--eye 0,0,-0.3 --target 0,0,0 --clip plane:0,0,1,-5",
        "--eye 0,0,-0.3 --target 0,0,0 --clip-near 0.25",
        "--eye 0,0,-9 --target 0,0,-10",
        "--eye 0,0,-4 --target 0,0,0",
    ] {
        let said = draw("scene.ply", words);
        assert!(!said.contains("nearer"), "{words}: {said}");
    }
}
