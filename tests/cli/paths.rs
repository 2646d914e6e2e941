//! Cameras that move.

use std::fs;
use std::path::Path;

use rara::Picture;
use serde_json::Value;

use super::films::files;
use super::{document, done, folder, line, refused, scene};

/// Three cameras of 48x32 pixels around the scene, the last of another focal length.
fn cameras(here: &Path) {
    let camera = |name: &str, eye: [f64; 3], axes: [[f64; 3]; 3], focal: f64| {
        serde_json::json!({"id": 0, "img_name": name, "width": 48, "height": 32, "position": eye, "rotation": axes,
            "fx": focal, "fy": focal})
    };
    let ahead = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let left = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
    let all = [
        camera("a.png", [0.0, 0.0, -4.0], ahead, 40.0),
        camera("b.png", [0.5, 0.0, -5.0], ahead, 40.0),
        camera("c.png", [4.0, 0.0, 0.0], left, 60.0),
    ];
    let json = serde_json::to_string(&all).expect("JSON");
    fs::write(here.join("cameras.json"), json).expect("writes");
}

/// What is reported of each frame.
pub(super) fn frames(report: &Value) -> &[Value] {
    report["frames"].as_array().expect("frames")
}

#[test]
fn an_orbit_begins_at_the_camera_and_goes_round_the_target() {
    let here = folder("orbit");
    scene(&here);
    let eye = "--eye 0,-1,-4 --target 0,0,0 --size 48x32 --clip plane:1,0,0,0";
    done(line(
        &here,
        &format!("render @/scene.ply -o @/one.png {eye}"),
    ));
    let words = format!(
        "render @/scene.ply -o @/o/{{:02}}_{{name}}.png --path orbit:2 --frames 4 {eye} --json"
    );
    let report = document(line(&here, &words));
    let names: Vec<_> = frames(&report)
        .iter()
        .map(|frame| frame["name"].as_str())
        .collect();
    assert_eq!(
        names,
        ["orbit_0", "orbit_1", "orbit_2", "orbit_3"].map(Some)
    );
    let picture = |name: &str| fs::read(here.join(name)).expect("a picture");
    assert!(picture("one.png") == picture("o/00_orbit_0.png"));
    // Half of two turns is one.
    assert!(picture("one.png") == picture("o/02_orbit_2.png"));
    assert!(picture("one.png") != picture("o/01_orbit_1.png"));
}

#[test]
fn an_orbit_round_a_scene_shows_all_of_it() {
    let here = folder("orbit_framed");
    scene(&here);
    for lens in ["", "--ortho fit"] {
        let words = format!(
            "render @/scene.ply -o @/o_{{}}.png --path orbit --frames 6 --size 64x64 {lens} --json"
        );
        let report = document(line(&here, &words));
        assert_eq!(frames(&report).len(), 6);
        for (number, frame) in frames(&report).iter().enumerate() {
            assert_eq!(
                (&frame["view"], &frame["counts"]["culled"]),
                (&number.into(), &0.into())
            );
            let picture = Picture::load(here.join(format!("o_{number}.png"))).expect("a picture");
            let shown = |at: &dyn Fn(u32) -> (u32, u32)| {
                (0..64).any(|i| picture.at(at(i).0, at(i).1)[3] > 0.5)
            };
            assert!(shown(&|i| (i, 32)), "something is in the middle");
            for edge in [0, 63] {
                assert!(
                    !shown(&|i| (edge, i)) && !shown(&|i| (i, edge)),
                    "{lens}: {number}"
                );
            }
        }
    }
}

#[test]
fn cameras_of_a_file_are_passed() {
    let here = folder("spline");
    scene(&here);
    cameras(&here);
    let drawn = |out: &str, flags: &str| {
        document(line(
            &here,
            &format!("render @/scene.ply -o @/{out} {flags} --json"),
        ))
    };
    drawn("all_{}.png", "--cameras @/cameras.json --view all");
    // Those beside the scene need no flag.
    let shown = drawn("path_{}.png", "--path cameras:2,a");
    assert_eq!(
        (&frames(&shown)[0]["view"], &frames(&shown)[1]["name"]),
        (&2.into(), &"a.png".into())
    );
    drawn(
        "spline_{}.png",
        "--cameras @/cameras.json --path spline --frames 5",
    );
    drawn("closed_{}.png", "--path spline:0,1,2,closed --frames 3");
    let picture = |name: &str| Picture::load(here.join(name)).expect("a picture");
    assert!(picture("path_2.png") == picture("all_2.png"));
    for (name, camera) in [
        ("spline_0", "all_0"),
        ("spline_4", "all_2"),
        ("closed_0", "all_0"),
    ] {
        let pair = [
            picture(&format!("{name}.png")),
            picture(&format!("{camera}.png")),
        ];
        let apart = pair[0]
            .pixels
            .iter()
            .flatten()
            .zip(pair[1].pixels.iter().flatten());
        let most = apart.fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
        assert!(most < 2.0 / 255.0, "{name} is the camera itself: {most}");
    }
    assert!(
        picture("closed_2.png") != picture("all_2.png"),
        "it is on the way back"
    );
}

#[test]
fn what_does_not_go_together_is_refused_by_name() {
    let here = folder("path_refusals");
    scene(&here);
    cameras(&here);
    for (flags, what) in [
        (
            "-o @/a.png --path orbit",
            "--path makes several pictures: put {}",
        ),
        ("-o - --path orbit", "--format apng or rgba"),
        ("-o - --format rgba --json", "both take standard output"),
        (
            "-o @/a.apng --format rgba",
            "--format is for standard output",
        ),
        ("-o @/{}.png --path orbit --fps 25", "--fps is for films"),
        ("-o @/a.gif", ".apng, .mp4"),
        (
            "-o @/a_{}.apng --path orbit",
            "a film or a sheet is one file",
        ),
        (
            "-o @/{name}/a.mp4 --path orbit",
            "a film or a sheet is one file",
        ),
        ("-o @/a.apng --path circle", "orbit[:TURNS]"),
        (
            "-o @/a.apng --path orbit --cameras @/cameras.json",
            "leave out the cameras",
        ),
        ("-o @/a.apng --path orbit --view 1", "--view"),
        ("-o @/a.apng --path orbit --section z=0.5", "--section"),
        (
            "-o @/a.apng --path spline --eye 0,0,0 --target 0,0,1",
            "leave out --eye",
        ),
        (
            "-o @/a.apng --cameras @/cameras.json --path spline:0,x",
            "--path spline x",
        ),
        (
            "-o @/a.apng --cameras @/cameras.json --path spline:0",
            "two cameras or more",
        ),
        (
            "-o @/a.apng --cameras @/cameras.json --path cameras --frames 9",
            "leave out --frames",
        ),
        ("-o @/a.apng --frames 9", "--path"),
        ("-o @/a.apng --path orbit --frames 0", "--frames"),
        ("-o @/a.apng --aov depth", ".exr"),
        ("-o @/a.png --panorama", "--eye, --camera or --cameras"),
        (
            "-o @/a.png --panorama --eye 0,0,0 --size 64x64",
            "twice as wide as high",
        ),
        ("-o @/a.png --panorama --eye 0,0,0 --fov-y 60", "--fov-y"),
        (
            "-o @/a.png --panorama --eye 0,0,0 --clip-near 1",
            "--clip-near",
        ),
        (
            "-o @/a.png --panorama --target 0,0,0",
            "--eye, --camera or --cameras",
        ),
        (
            "-o @/a.apng --path spline --target 0,0,0",
            "leave out --eye",
        ),
    ] {
        refused(
            &line(&here, &format!("render @/scene.ply {flags}")),
            2,
            what,
        );
    }
    assert_eq!(files(&here), 2, "nothing was written");
}

/// A path of nerfstudio's viewer is drawn within its crop box, on that box's background, and at its pace.
#[test]
fn a_path_of_nerfstudio_has_its_crop_and_its_pace() {
    let here = folder("path_crop");
    scene(&here);
    let camera = |x: f64| {
        let pose = [
            1.0, 0.0, 0.0, x, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, -4.0, 0.0, 0.0, 0.0, 1.0,
        ];
        serde_json::json!({"camera_to_world": pose, "fov": 50.0, "aspect": 1.5})
    };
    let mut path = serde_json::json!({"camera_path": [camera(0.0), camera(0.3)], "render_width": 48, "render_height": 32,
        "fps": 2, "seconds": 1, "crop": {"crop_center": [0.2, 0.0, 0.0], "crop_scale": [1.0, 2.0, 0.5], "crop_rot": [0.0, 0.0, 0.5],
        "crop_bg_color": {"r": 51, "g": 102, "b": 255}}});
    let save =
        |path: &Value| fs::write(here.join("camera_path.json"), path.to_string()).expect("writes");
    let draw = |words: &str| {
        done(line(
            &here,
            &format!("render @/scene.ply --cameras @/camera_path.json {words}"),
        ))
    };
    let same = |a: &str, b: &str| {
        let read = |name: &str| fs::read(here.join(name)).expect("a picture");
        read(a) == read(b)
    };
    let cropped = "box:0.2,0,0,0.5,1,0.25,0.9689124217106447,0,0,0.24740395925452294";
    let background = "--background 0.2,0.4,1";
    save(&path);
    let said = super::stderr(&draw("--view all -o @/a_{}.png"));
    assert!(
        said.contains("outside of the crop box of") && said.contains("camera_path.json"),
        "{said}"
    );
    draw(
        "-o @/planes.png --clip plane:1,0,0,0 --clip plane:0,1,0,0 --clip-op or --background white --save-clip @/saved.json",
    );
    for name in ["film.apng", "fast.apng"] {
        let pace = if name == "fast.apng" { "--fps 12" } else { "" };
        draw(&format!("--path cameras -o @/{name} {pace}"));
        let bytes = fs::read(here.join(name)).expect("a film");
        let control = bytes
            .windows(4)
            .position(|four| four == b"fcTL")
            .expect("a frame");
        let rate = if pace.is_empty() { 2 } else { 12 };
        assert_eq!(bytes[control + 24..control + 28], [0, 1, 0, rate]);
    }
    path["crop"] = Value::Null;
    path["fps"] = serde_json::json!(12.5);
    save(&path);
    draw(&format!(
        "--view all -o @/b_{{}}.png --clip {cropped} {background}"
    ));
    assert!((0..2).all(|n| same(&format!("a_{n}.png"), &format!("b_{n}.png"))));
    draw("-o @/again.png --clip-file @/saved.json --background white");
    assert!(same("planes.png", "again.png"));
    draw(&format!(
        "-o @/again.png --clip-expr all({cropped},any(plane:1,0,0,0,plane:0,1,0,0)) --background white"
    ));
    assert!(same("planes.png", "again.png"));
    let said = super::stderr(&draw("--path cameras -o @/film.apng"));
    assert!(
        said.contains("the camera path's rate of 12.5 a second is taken for 13"),
        "{said}"
    );
}

/// A clip moves with the camera, alike by both commands, and each picture is that of its camera and its clip.
#[test]
fn a_clip_moves_along_with_the_camera() {
    let here = folder("moved_along");
    scene(&here);
    let flags = "--path orbit:0.5 --eye 0,-1,-4 --target 0,0,0 --from plane:z=20% --to plane:z=80% --size 48x32";
    let picture = |name: &str| fs::read(here.join(name)).expect("a picture");
    let words = format!(
        "render @/scene.ply -o @/r_{{}}.png {flags} --frames 5 --save-camera @/saved.json --save-clip @/x.json"
    );
    refused(&line(&here, &words), 2, "there is no clip to save");
    done(line(&here, &words.replace(" --save-clip @/x.json", "")));
    done(line(
        &here,
        &format!("sweep @/scene.ply -o @/s_{{}}.png {flags} --frames 5"),
    ));
    let clips = ["20", "35", "50", "65", "80"];
    for (at, share) in clips.into_iter().enumerate() {
        let one = format!(
            "render @/scene.ply -o @/one.png --camera @/saved.json --view {at} --clip plane:z={share}%"
        );
        let words = one.replace("--camera ", "--cameras ");
        done(line(&here, &words));
        assert!(
            picture("one.png") == picture(&format!("r_{at}.png")),
            "{at}"
        );
        assert!(
            picture(&format!("s_{at}.png")) == picture(&format!("r_{at}.png")),
            "{at}"
        );
    }
    done(line(
        &here,
        &format!("sweep @/scene.ply -o @/e_{{}}.png {flags} --frames 5 --ease both"),
    ));
    let alike = [0, 1, 2, 3, 4]
        .map(|at| picture(&format!("e_{at}.png")) == picture(&format!("s_{at}.png")));
    assert_eq!(alike, [true, false, true, false, true], "slow at both ends");
    let report = document(line(
        &here,
        "sweep @/scene.ply --clip-normal 0,0,1 --cameras @/saved.json --path cameras:0,2,4 --size 48x32 --json",
    ));
    assert_eq!(frames(&report).len(), 3);
    for (words, says) in [
        (
            "render @/scene.ply -o @/a.png --from plane:1,0,0,0 --to plane:1,0,0,1",
            "give --path",
        ),
        (
            "render @/scene.ply -o @/a_{}.png --path orbit --section z=0.4",
            "give one of them",
        ),
        (
            "render @/scene.ply -o @/a.png --ease in",
            "--ease changes nothing without",
        ),
        (
            "sweep @/scene.ply -o @/a --from plane:1,0,0,0 --to sphere:0,0,0,1 --path orbit",
            "step by step",
        ),
    ] {
        refused(&line(&here, words), 2, says);
    }
}
