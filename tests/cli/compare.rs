//! How far pictures are apart.

use serde_json::Value;

use super::{document, done, folder, line, scene, stderr, stdout};

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
