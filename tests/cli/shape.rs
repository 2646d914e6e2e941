//! The pipelines of either kind of machine, on whatever device there is.

use super::{document, folder, line, line_with, scene};

/// The statistics say for what kind of machine pipelines were chosen, and why; a kind that cannot be had is refused. The
/// pipelines for GPUs are another sort, and tiles with a pixel in each invocation, and draw the same picture but for the rounding
/// of sums; tests/shapes compares them in every mode.
#[test]
fn the_shape_is_reported_with_its_reason_and_draws_the_same() {
    let here = folder("shape");
    scene(&here);
    let render = |name: &str, variable: Option<(&str, &str)>| {
        let words = format!(
            "render @/scene.ply -o @/{name}.exr --raster tiles --size 103x75 --mode hard --clip plane:1,0.2,0.1,0 --json"
        );
        document(line_with(&here, &words, variable))
    };
    let asked = render("asked", Some(("RARA_SHAPE", "gpu:0")));
    let shape =
        serde_json::json!({"kind": "gpu", "subgroup": 0, "reason": "asked for by RARA_SHAPE"});
    assert_eq!(asked["shape"], shape);
    let own = render("own", None);
    assert!(
        own["shape"]["reason"]
            .as_str()
            .is_some_and(|reason| !reason.is_empty())
    );
    let difference = document(line(&here, "compare @/own.exr @/asked.exr --json"));
    let max = difference["max"].as_f64().expect("a number, of 255");
    assert!(max < 0.01, "{difference}");
    let words = "render @/scene.ply --size 32x32 --json";
    for impossible in ["gpu:3", "gpu:1024", "apu"] {
        let output = line_with(&here, words, Some(("RARA_SHAPE", impossible)));
        assert!(!output.status.success(), "{impossible}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains("subgroups"), "{impossible}: {message}");
    }
}
