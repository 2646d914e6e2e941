//! Panoramas.

use std::fs;
use std::path::Path;

use rara::Picture;

use super::films::decoded;
use super::paths::frames;
use super::{document, done, folder, line, scene, stderr};

/// A splat: where it is, its colour, and the logarithm of its size.
type Splat = ([f64; 3], [f64; 3], f64);

fn write(file: &Path, splats: impl IntoIterator<Item = Splat>) {
    let names =
        "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3";
    let names: String = names
        .split(' ')
        .map(|name| format!("property float {name}\n"))
        .collect();
    let line = |([x, y, z], colour, size): Splat| {
        let [r, g, b] = colour.map(|value: f64| (value - 0.5) / 0.282_094_8);
        format!("{x} {y} {z} {r} {g} {b} 8 {size} {size} {size} 1 0 0 0\n")
    };
    let lines: Vec<_> = splats.into_iter().map(line).collect();
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\n{names}end_header\n{}",
        lines.len(),
        lines.concat()
    );
    fs::write(file, text).expect("writes");
}

/// Splats of one colour each in the six directions of the axes.
const COMPASS: [([f64; 3], [f64; 3]); 6] = [
    ([0.0, 0.0, 1.0], [1.0, 1.0, 1.0]),
    ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
    ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]),
    ([-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ([0.0, -1.0, 0.0], [1.0, 1.0, 0.0]),
    ([0.0, 1.0, 0.0], [0.0, 1.0, 1.0]),
];

#[test]
fn a_panorama_has_every_direction_in_its_place() {
    let here = folder("panorama");
    let compass = COMPASS.map(|(at, colour)| (at.map(|way| 5.0 * way), colour, -1.0));
    write(&here.join("compass.ply"), compass);
    let words = "render @/compass.ply -o @/p.exr --panorama --size 128x64 --json --eye 0,0,0";
    let report = document(line(&here, words));
    assert_eq!(
        (&report["size"], frames(&report).len()),
        (&serde_json::json!([128, 64]), 6)
    );
    let faces: Vec<_> = frames(&report)
        .iter()
        .map(|frame| frame["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(faces[0], "camera front");
    // It takes as long as all of them.
    for time in ["gpu_ms", "wall_ms"] {
        let together: f64 = frames(&report)
            .iter()
            .map(|frame| frame[time].as_f64().expect("a time"))
            .sum();
        assert!((report[time].as_f64().expect("a time") - together).abs() < 1e-9 * together);
    }
    let words = "render @/compass.ply -o @/p.png --panorama --size 64x32 --eye 0,0,0 --repeat 2";
    let printed = stderr(&done(line(&here, words)));
    for part in ["6 frames together:", "(the median of 2 pictures)"] {
        assert!(printed.contains(part), "{printed}");
    }
    let here_is = |name: &str, at: (u32, u32), expected: [f64; 3]| {
        let [r, g, b, a] = Picture::load(here.join(name))
            .expect("a picture")
            .at(at.0, at.1);
        let seen = [r, g, b].map(|value| f64::from(value / a));
        let apart = seen.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(
            apart.fold(0.0, f64::max) < 0.02 && a > 0.8,
            "{name} {at:?}: {seen:?}, {a}"
        );
    };
    let places = [(64, 32), (96, 32), (0, 32), (32, 32), (100, 0), (20, 63)];
    for ((_, colour), at) in COMPASS.into_iter().zip(places) {
        here_is("p.exr", at, colour);
    }
    // What the camera looks at is in the middle, and a tilt leaves the horizon level.
    let words =
        "render @/compass.ply -o @/t.exr --panorama --size 128x64 --eye 0,0,0 --target 1,-0.7,0";
    done(line(&here, words));
    here_is("t.exr", (64, 32), COMPASS[1].1);
    here_is("t.exr", (32, 32), COMPASS[0].1);
    // With z up it looks along y.
    done(line(
        &here,
        "render @/compass.ply -o @/z.exr --panorama --size 128x64 --eye 0,0,0 --up z",
    ));
    here_is("z.exr", (64, 32), COMPASS[5].1);
    here_is("z.exr", (64, 0), COMPASS[0].1);
    // A path of them is a film of them.
    let words =
        "render @/compass.ply -o @/p.apng --panorama --size 32x16 --path orbit --frames 2 --json";
    assert_eq!(frames(&document(line(&here, words))).len(), 12);
    assert_eq!(decoded(&here.join("p.apng"))[1].len(), 32 * 16 * 4);
}

/// The cameras of a file have a place and axes in a panorama, and no aspect.
#[test]
fn cameras_of_any_size_make_panoramas() {
    let here = folder("panorama_cameras");
    scene(&here);
    let camera = |number: u32| {
        let (width, eye) = (48 + 16 * number, [f64::from(number), 0.0, -4.0]);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        serde_json::json!({"id": number, "img_name": "a", "width": width, "height": 32, "position": eye, "rotation": axes,
            "fx": 40.0, "fy": 40.0})
    };
    let json = serde_json::json!([camera(0), camera(1)]);
    fs::write(here.join("cameras.json"), json.to_string()).expect("writes");
    let words = "render @/scene.ply -o @/a.apng --panorama --path spline --frames 2 --size 32x16";
    let printed = stderr(&done(line(&here, words)));
    assert!(!printed.contains("aspect"), "{printed}");
}

/// How far apart two panoramas are of which one is turned by half a picture, so that its seams are where the other has none:
/// the mean, and that of the worst column, of 255. And what is said of the seams of the first.
fn seams(here: &Path) -> (f64, f64, [f64; 2]) {
    let flags = "--panorama --size 256x128 --eye 0,0,0 --background 0,0,0 --json";
    let said = [("a", "0,0,1"), ("b", "1,0,1")].map(|(name, target)| {
        let words = format!("render @/scene.ply -o @/{name}.exr {flags} --target {target}");
        let output = done(line(here, &words));
        assert!(stderr(&output).contains("of 255 where they meet, and by"));
        let report = document(output);
        ["mean", "largest"].map(|key| report["seams"][key].as_f64().expect("a number"))
    });
    let load = |name: &str| Picture::load(here.join(name)).expect("a picture");
    let (a, b) = (load("a.exr"), load("b.exr"));
    let column = |x: u32| {
        let apart = (0..128).map(|y| {
            let (a, b) = (a.at((x + 32) % 256, y), b.at(x, y));
            (0..3).map(|c| f64::from((a[c] - b[c]).abs())).sum::<f64>() / 3.0
        });
        apart.sum::<f64>() / 128.0 * 255.0
    };
    let all: Vec<f64> = (0..256).map(column).collect();
    let most = all.iter().fold(0.0_f64, |most, one| most.max(*one));
    (all.iter().sum::<f64>() / 256.0, most, said[0])
}

/// Splats are projected by an approximation, the better the smaller they are as they are seen, and ordered by their depths
/// along the view axis. The six pictures of a panorama share neither.
#[test]
fn the_seams_of_a_panorama_are_faint() {
    let here = folder("seams");
    // A hollow ball of 3000 splats around the eye, each 1.5 degrees wide.
    let ball = (0..3000).map(|index| {
        let (turn, share) = (
            f64::from(index) * 2.399_963,
            (f64::from(index) + 0.5) / 3000.0,
        );
        let (y, level) = (1.0 - 2.0 * share, 2.0 * (share * (1.0 - share)).sqrt());
        let at = [level * turn.cos(), y, level * turn.sin()];
        let colour = at.map(|way| 0.5 + 0.4 * (9.0 * way).sin());
        (
            at.map(|way| 5.0 * way),
            colour,
            (5.0 * 1.5_f64.to_radians()).ln(),
        )
    });
    write(&here.join("scene.ply"), ball);
    let (mean, most, around) = seams(&here);
    println!("around the eye: {mean:.3} of 255, {most:.3} in the worst column, {around:?} said");
    assert!(mean > 0.0 && mean < 3.0 && most < 5.0, "{mean}, {most}");
    // In the middle of a cloud splats are as wide as the view, and some reach behind the eye.
    done(line(
        &here,
        "generate general -n 3000 --seed 5 -o @/scene.ply",
    ));
    let (mean, most, midst) = seams(&here);
    println!(
        "in the midst of splats: {mean:.3} of 255, {most:.3} in the worst column, {midst:?} said"
    );
    assert!(mean < 12.0 && most < 24.0, "{mean}, {most}");
    // What is said tells the one from the other.
    assert!(
        around[0] < midst[0] && around[1] < midst[1] && midst[1] > midst[0],
        "{around:?} {midst:?}"
    );
}
