//! Orthographic pictures, and sections.

use std::fs;
use std::path::Path;

use rara::Picture;
use serde_json::Value;

use super::{document, done, folder, line, refused, scene};

const SIZE: &str = "--size 96x64";

/// The bytes of the picture of `scene.ply` with these flags.
fn drawn(here: &Path, flags: &str) -> Vec<u8> {
    let words = format!("render @/scene.ply -o @/drawn.exr {SIZE} {flags}");
    done(line(here, &words));
    fs::read(here.join("drawn.exr")).expect("a picture")
}

/// The same of flags in which an @ is one.
fn drawn_at(here: &Path, flags: &str) -> Vec<u8> {
    let here_text = here.to_str().expect("the test folder's name is text");
    let words = format!("render {here_text}/scene.ply -o {here_text}/drawn.exr {SIZE} {flags}");
    done(super::rara(words.split(' ')));
    fs::read(here.join("drawn.exr")).expect("a picture")
}

/// The robust bounds of `scene.ply`, least and greatest coordinates.
fn bounds(here: &Path) -> [[f64; 3]; 2] {
    let info = document(line(here, "info @/scene.ply --json"));
    let bounds = &info["robust_bounds"];
    ["min", "max"].map(|end| [0, 1, 2].map(|axis| bounds[end][axis].as_f64().expect("a number")))
}

#[test]
fn a_camera_file_says_what_the_flags_say() {
    let here = folder("ortho");
    scene(&here);
    // Looks along +z from z = -8, with y down, 16 pixels a unit.
    let flags = "--eye 0.5,0.25,-8 --target 0.5,0.25,0 --ortho 4 --clip plane:1,0,1,0";
    let file = r#"{"width": 96, "height": 64, "fx": 16, "fy": 16, "projection": "orthographic",
        "world_to_camera": [1,0,0,-0.5, 0,1,0,-0.25, 0,0,1,8, 0,0,0,1]}"#;
    fs::write(here.join("flat.json"), file).unwrap();
    let flat = drawn(&here, flags);
    assert!(flat == drawn(&here, "--camera @/flat.json --clip plane:1,0,1,0"));
    assert!(flat == drawn(&here, "--cameras @/flat.json --clip plane:1,0,1,0"));
    assert!(
        flat != drawn(&here, &flags.replace("--ortho 4", "")),
        "in perspective"
    );
    let nearer = flags.replace("-8", "-6");
    let words = format!("render @/scene.ply -o @/nearer.exr {SIZE} {nearer}");
    done(line(&here, &words));
    drawn(&here, flags);
    let apart = document(line(&here, "compare @/drawn.exr @/nearer.exr --json"));
    assert!(
        apart["max"].as_f64().unwrap() < 0.1,
        "{apart}: no perspective"
    );

    fs::write(
        here.join("flat.json"),
        file.replace("orthographic", "fisheye"),
    )
    .unwrap();
    let output = line(&here, "render @/scene.ply -o @/x.png --camera @/flat.json");
    refused(&output, 1, "`perspective` or `orthographic`");
    assert!(drawn(&here, "--ortho fit") != drawn(&here, ""));
    assert!(drawn(&here, "--ortho fit") != drawn(&here, "--ortho 1.5"));
}

/// A section across an axis is what its camera and a plane draw, which both stand where they should.
#[test]
fn a_section_faces_its_plane() {
    let here = folder("section");
    scene(&here);
    let [min, max] = bounds(&here);
    for (names, axis, sign, up) in [
        (["sagittal", "x"], 0, -1.0, [0.0, 0.0, 1.0]),
        (["coronal", "y"], 1, 1.0, [0.0, 0.0, 1.0]),
        (["axial", "z"], 2, 1.0, [0.0, -1.0, 0.0]),
    ] {
        for (flip, sign) in [("", sign), ("!", -sign)] {
            let at = min[axis] + (max[axis] - min[axis]) * 0.4;
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            let text = |v: [f64; 3]| v.map(|v| v.to_string()).join(",");
            let plane = |d: f64| format!("--clip plane:{},{d}", text(normal));
            let d = -sign * at;
            let section = format!("--section {flip}{}=0.4 --section-scale 0.0625", names[0]);
            let half = drawn(&here, &format!("{section} --save-camera @/flat.json"));
            let placed = section.replace("=0.4", &format!("@{at}"));
            assert!(half == drawn_at(&here, &placed), "{placed}");
            let file = fs::read(here.join("flat.json")).expect("a camera");
            let saved: Value = serde_json::from_slice(&file).expect("JSON");
            let number = |value: &Value| value.as_f64().expect("a number");
            let row =
                |row: usize| [0, 1, 2].map(|i| number(&saved["world_to_camera"][4 * row + i]));
            assert_eq!(
                (row(2), row(1)),
                (normal, up.map(|v| -v)),
                "{names:?} {flip}"
            );
            assert_eq!(
                (&saved["projection"], number(&saved["fx"])),
                (&"orthographic".into(), 16.0)
            );
            // It stands before all of the scene.
            let before = sign * (at - number(&saved["eye"][axis]));
            assert!(before > max[axis] - min[axis], "{names:?} {flip}: {before}");
            assert!(half == drawn(&here, &section.replace(names[0], names[1])));
            let camera = "--camera @/flat.json";
            assert!(
                half == drawn(&here, &format!("{camera} {}", plane(d))),
                "{names:?} {flip}"
            );
            let slab = drawn(&here, &format!("{section} --section-thickness 0.5"));
            let far = normal.map(|v| -v);
            let far = format!("--clip plane:{},{}", text(far), 0.5 - d);
            let placed = drawn(&here, &format!("{camera} {} {far}", plane(d)));
            assert!(slab == placed && slab != half, "{names:?} {flip}");
        }
    }
    let plain = drawn(&here, "--section z=0.4");
    assert!(plain == drawn(&here, "--section axial=40%"));
    let named =
        r#"[{"name":"low","normal":[0,0,1],"d":0.25},{"name":"axial","normal":[0,0,1],"d":0.25}]"#;
    fs::write(here.join("planes.json"), named).expect("writes");
    let low = |name: &str| {
        drawn(
            &here,
            &format!("--section {name} --clip-file @/planes.json"),
        )
    };
    assert!(low("low") == drawn_at(&here, "--section z@-0.25"));
    assert!(low("!low") == drawn_at(&here, "--section !z@-0.25"));
    // A name without a share is that of a plane, even if an axis has it too.
    assert!(low("axial") == low("low"));
    assert!(plain != drawn(&here, "--section z=0.4 --up 1,0,0"));
    // What is up along the view says nothing of the picture.
    assert!(plain == drawn(&here, "--section z=0.4 --up z"));
}

#[test]
fn a_section_cuts_layers_that_have_clips_of_their_own() {
    let here = folder("section_layers");
    scene(&here);
    let of = |flags: &str| {
        let sections = "--section z=0.3 --section z=0.6";
        let words = format!("render @/scene.ply -o @/s_{{}}.exr {SIZE} {sections} {flags}");
        done(line(&here, &words));
        [0, 1].map(|n| fs::read(here.join(format!("s_{n}.exr"))).expect("a picture"))
    };
    let ball = "sphere:0,0,0,0.8";
    let both = of(&format!("--layer-clip scene={ball}"));
    assert!(both == of(&format!("--clip {ball}")) && both != of(""));
    let slab = "--section-thickness 0.1";
    let thin = of(&format!("--layer-clip scene={ball} {slab}"));
    assert!(thin == of(&format!("--clip {ball} {slab}")) && thin != both);
    // A layer that nothing cuts is whole, in a section too.
    let whole = of("--layer-clip scene=whole");
    assert!(whole == of(&format!("--layer-clip scene=whole --clip {ball}")));
    assert!(whole != of(""));
}

#[test]
fn several_sections_are_numbered_pictures() {
    let here = folder("sections");
    scene(&here);
    let words = format!("render @/scene.ply -o @/all_{{}}.exr {SIZE} --json");
    let report = document(line(
        &here,
        &format!("{words} --section y=0.2..0.8:3 --section x=0.5"),
    ));
    assert_eq!(report["frames"].as_array().map(Vec::len), Some(4));
    for (number, section) in ["y=0.2", "y=0.5", "y=0.8", "x=0.5"].iter().enumerate() {
        let numbered = fs::read(here.join(format!("all_{number}.exr"))).expect("a picture");
        assert!(
            numbered == drawn(&here, &format!("--section {section}")),
            "{section}"
        );
    }
    assert!(!here.join("all_4.exr").exists());
    // One section is one picture, with a number in its name or without.
    done(line(
        &here,
        &format!("render @/scene.ply -o @/one_{{}}.exr {SIZE} --section x=0.5"),
    ));
    assert_eq!(
        fs::read(here.join("one_0.exr")).unwrap(),
        fs::read(here.join("all_3.exr")).unwrap()
    );
}

#[test]
fn a_section_has_the_plane_of_a_file() {
    let here = folder("section_file");
    scene(&here);
    let [min, max] = bounds(&here);
    let middle = (min[2] + max[2]) / 2.0;
    let planes = format!(
        r#"[{{"name": "mid", "normal": [0, 0, 2], "d": {}}}, {{"name": "other", "normal": [1, 0, 0], "d": 0}}]"#,
        -2.0 * middle
    );
    fs::write(here.join("planes.json"), planes).unwrap();
    // The file's other plane clips nothing, and what --clip says does.
    let of_file = "--clip-file @/planes.json --section mid";
    assert!(drawn(&here, of_file) == drawn(&here, "--section z=0.5"));
    let more = "--clip plane:0,1,0,0";
    let both = drawn(&here, &format!("{of_file} {more}"));
    assert!(both == drawn(&here, &format!("--section z=0.5 {more}")));
    let clipped = "--section z=0.5 --clip-file @/planes.json:other";
    let typed = drawn(&here, "--section z=0.5 --clip plane:1,0,0,0");
    assert!(typed == drawn(&here, clipped));
    // What clips beside the section's plane is saved, as for a section across an axis.
    for section in ["mid", "z=0.5"] {
        let file = if section == "mid" {
            "--clip-file @/planes.json"
        } else {
            ""
        };
        let words = format!("{file} --section {section} {more} --save-clip @/saved.json");
        assert!(both == drawn(&here, &words), "{section}");
        let saved = drawn(&here, "--section z=0.5 --clip-file @/saved.json");
        assert!(both == saved, "{section}");
        fs::remove_file(here.join("saved.json")).unwrap();
    }
    for (flags, what) in [
        ("--section skin", "mid, other"),
        ("--section axial", "as in axial=50%"),
        (
            "--section mid --save-clip @/saved.json",
            "give one by --clip or --clip-expr",
        ),
    ] {
        let words = format!("render @/scene.ply -o @/x.png --clip-file @/planes.json {flags}");
        refused(&line(&here, &words), 2, what);
    }
}

#[test]
fn slices_show_the_plane_and_cues_its_edge() {
    let here = folder("slices");
    scene(&here);
    let section = "--section axial=0.5";
    let plain = drawn(&here, section);
    let slice = drawn(&here, &format!("{section} --slice"));
    assert!(plain != slice);
    let outlined = drawn(
        &here,
        &format!("{section} --outline 1,1,0 --outline-width 3"),
    );
    assert!(plain != outlined);
    assert!(outlined != drawn(&here, &format!("{section} --outline 1,1,0 --rim 0,0,1")));
    // A picture that is drawn in another way has the same cues.
    let quads = drawn(&here, &format!("{section} --raster quad"));
    let outlined = drawn(&here, &format!("{section} --raster quad --outline 1,1,0"));
    let rimmed = drawn(&here, &format!("{section} --raster quad --rim 0,0,1"));
    assert!(quads != outlined && quads != rimmed && outlined != rimmed);
    let series = format!("render @/scene.ply -o @/s{{}}.png {SIZE} --slice --outline 1,0,0");
    done(line(&here, &format!("{series} --section z=0.2..0.8:3")));
    assert!((0..3).all(|number| here.join(format!("s{number}.png")).is_file()));
    // The middle of the slice is opaque, and what shows nothing stays empty.
    let alphas = |flags: &str| {
        drawn(&here, &format!("{section} --slice {flags}"));
        let picture = Picture::load(here.join("drawn.exr")).expect("a picture");
        let counted = |least: f32| picture.pixels.iter().filter(|p| p[3] > least).count();
        [counted(0.0), counted(0.999)]
    };
    let [before, after] = ["", "--opaque"].map(alphas);
    assert_eq!(before[0], after[0]);
    assert!(
        20 * before[1] < after[1] && 3 * after[1] > after[0],
        "{before:?} {after:?}"
    );
    // Labels stay at the edges.
    for (flags, is_low) in [("--scale-bar=mm", true), ("--letters dicom", false)] {
        let labelled = drawn(&here, &format!("{section} {flags}"));
        assert!(labelled != plain, "{flags}");
        let labelled = Picture::load(here.join("drawn.exr")).expect("a picture");
        drawn(&here, section);
        let without = Picture::load(here.join("drawn.exr")).expect("a picture");
        let (width, height) = (labelled.width, labelled.height);
        for y in 0..height {
            for x in 0..width {
                let is_inside = y < height / 2 || !is_low;
                let is_middle = (width / 3..2 * width / 3).contains(&x);
                let is_middle = is_middle && (height / 3..2 * height / 3).contains(&y);
                let is_kept = is_inside && (is_low || is_middle);
                assert!(
                    !is_kept || labelled.at(x, y) == without.at(x, y),
                    "{flags}: {x}, {y}"
                );
            }
        }
    }
    // A box without a section has lines around its faces; both layers of a scene have lines of their own.
    let boxed = "--clip box:0,0,0,.5,.5,.5";
    let whole = drawn(&here, boxed);
    let outlined = drawn(&here, &format!("{boxed} --outline 1,1,0"));
    assert!(whole != outlined);
    assert!(outlined == drawn(&here, &format!("{boxed} --outline scene=1,1,0")));
    for (words, what) in [
        ("render x.ply -o a.png --slice", "--section"),
        (
            "render x.ply -o a.png --section z=.5 --outline-width 2",
            "--outline",
        ),
        (
            "render x.ply -o a.exr --section z=.5 --slice --aov depth",
            "--aov",
        ),
        (
            "render x.ply -o a.png --section z=.5 --slice --raster quad",
            "--slice needs --raster tiles or auto, and not quad",
        ),
        (
            "render x.ply -o a.png --section z=.5 --slice --raster mesh",
            "--raster tiles or auto, and not mesh",
        ),
        (
            "render @/scene.ply -o @/a.png --scale-bar",
            "without perspective",
        ),
        (
            "render x.ply -o a.png --section z=.5 --letters world",
            "dicom, nifti, axes",
        ),
        (
            "render x.ply -o a.png --section z=.5 --outline 1,1,2",
            "between 0 and 1",
        ),
        (
            "render @/scene.ply -o @/a.png --section z=.5 --outline skin=red",
            "no layer is called 'skin'",
        ),
        (
            "render @/scene.ply -o @/a.png --clip sphere:0,0,0,1 --outline red",
            "planes, slabs and boxes",
        ),
        ("render x.ply -o a.png --outline red", "--section"),
        (
            "render x.ply -o a.png --panorama --eye 0,0,0 --clip plane:1,0,0,0 --rim red",
            "cannot mark a --panorama",
        ),
    ] {
        refused(&line(&here, words), 2, what);
    }
}
