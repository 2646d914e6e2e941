//! How far pictures are apart.

use rara::Picture;
use serde_json::Value;

use super::{document, done, folder, line, refused, scene, stderr, stdout};

#[test]
fn a_limit_that_pictures_do_not_keep_is_status_1() {
    let here = folder("compare_limits");
    scene(&here);
    for (name, flags) in [
        ("white", "white"),
        ("same", "#fff"),
        ("grey", "0.5,0.5,0.5"),
    ] {
        let words = format!("render @/scene.ply -o @/{name}.png --size 32x32 --background {flags}");
        done(line(&here, &words));
    }
    let compare = |words: &str| line(&here, &format!("compare @/white.png {words}"));
    let table = stdout(&done(compare("@/same.png --min-psnr 99 --max-l1 0")));
    assert!(table.contains("PSNR          equal"), "{table}");
    let measured = document(compare("@/grey.png --min-psnr 1 --max-l1 250 --json"));
    assert!(measured["l1"].as_f64() > Some(1.0));
    for (limit, what) in [("--min-psnr 60", "PSNR"), ("--max-l1 0.5", "L1")] {
        let output = compare(&format!("@/grey.png {limit}"));
        assert_eq!(output.status.code(), Some(1), "{limit}");
        assert!(
            stdout(&output).contains("RMSE"),
            "the measures are printed all the same"
        );
        assert!(stderr(&output).contains(what) && stderr(&output).lines().count() == 1);
    }
    assert_eq!(compare("@/grey.png --min-psnr none").status.code(), Some(2));
}

#[test]
fn pictures_are_compared_over_a_background_and_alpha_for_itself() {
    let here = folder("compare_background");
    scene(&here);
    let drawn = |name: &str, flags: &str| {
        let words = format!("render @/scene.ply -o @/{name}.exr --size 64x48 {flags}");
        done(line(&here, &words));
    };
    drawn("clear", "");
    drawn("black", "--background black");
    drawn("white", "--background white");
    let apart = |flags: &str| document(line(&here, &format!("compare {flags} --json")));
    let of = |apart: &Value, name: &str| apart[name].as_f64().unwrap();
    let black = apart("@/clear.exr @/black.exr");
    assert_eq!((of(&black, "l1"), &black["psnr"]), (0.0, &Value::Null));
    assert!(of(&black, "alpha_l1") > 1.0 && of(&black, "alpha_max") > 200.0);
    let white = apart("@/clear.exr @/white.exr --background white");
    assert!(of(&white, "max") < 1e-3 && of(&apart("@/clear.exr @/white.exr"), "l1") > 1.0);
    let table = stdout(&line(&here, "compare @/clear.exr @/black.exr"));
    assert!(table.contains("PSNR          equal") && table.contains("alpha         L1 "));
}

#[test]
fn a_map_shows_where_pictures_differ_over_the_background_and_has_its_scale_below() {
    let here = folder("compare_map");
    let picture = |name: &str, right: [f32; 4]| {
        let mut picture = Picture::filled(160, 20, [0.5, 0.5, 0.5, 1.0]);
        for row in picture.pixels.chunks_mut(160) {
            row[80..].fill(right);
        }
        picture.save(here.join(name)).expect("it is saved");
    };
    picture("a.exr", [0.0; 4]);
    picture("b.exr", [1.0; 4]);
    let map = |flags: &str| {
        let words = format!("compare @/a.exr @/b.exr --map @/map.png {flags}");
        assert!(stdout(&done(line(&here, &words))).contains("RMSE"));
        Picture::load(here.join("map.png")).expect("a map")
    };
    let (black, white) = (map(""), map("--background white"));
    assert_eq!((black.width, black.height), (160, 53));
    let bright = |picture: &Picture, x, y| picture.at(x, y)[..3].iter().sum::<f32>();
    assert_eq!(
        (bright(&black, 40, 10), bright(&white, 120, 10)),
        (3.0, 3.0)
    );
    let darkest = bright(&black, 120, 10);
    assert_eq!(darkest, bright(&black, 159, 36), "the end of the scale");
    assert!(darkest < 1.5 && bright(&black, 0, 36) > bright(&black, 80, 36));
    let has_ink = |rows: std::ops::Range<u32>| {
        let mut places = rows.flat_map(|y| (0..160).map(move |x| (x, y)));
        places.any(|(x, y)| bright(&black, x, y) == 0.0)
    };
    assert!(has_ink(23..30) && has_ink(43..50), "words and numbers");
    Picture::filled(3, 2, [0.0; 4])
        .save(here.join("small.exr"))
        .expect("it is saved");
    done(line(
        &here,
        "compare @/small.exr @/small.exr --map @/map.png",
    ));
    let small = Picture::load(here.join("map.png")).expect("a map");
    assert_eq!((small.width, small.height), (120, 35));
    for (words, status, what) in [
        ("@/a.exr @/small.exr --map @/none.png", 1, "160x20"),
        ("@/a.exr @/b.exr --map @/a.exr/none.png", 1, "not a folder"),
        ("@/a.exr @/b.exr --map -", 2, "name a file"),
        ("@/a.exr @/b.exr --map none.txt", 2, ".png"),
    ] {
        refused(&line(&here, &format!("compare {words}")), status, what);
    }
    assert!(!here.join("none.png").exists());
}
