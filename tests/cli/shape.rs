//! The kernels of either kind of machine, on whatever device there is.

use super::{document, done, folder, line, line_with, scene};

/// The kernels for GPUs are another sort, and tiles with a pixel in each invocation.
/// The order of the splats is the same, so only the rounding of sums may differ.
#[test]
fn kernels_for_gpus_draw_the_picture_of_those_for_processors() {
    let here = folder("shape");
    scene(&here);
    for (name, clip) in [
        ("whole", ""),
        (
            "cut",
            "--clip plane:1,0.2,0.1,0 --clip plane:0,1,0,0.1 --clip-op or",
        ),
    ] {
        for shape in ["cpu", "gpu"] {
            let words = format!(
                "render @/scene.ply -o @/{name}_{shape}.exr --raster tiles --size 203x150 {clip}"
            );
            done(line_with(&here, &words, Some(("RARA_SHAPE", shape))));
        }
        let words = format!("compare @/{name}_cpu.exr @/{name}_gpu.exr --json");
        let difference = document(line(&here, &words));
        let max = difference["max"].as_f64().expect("a number, of 255");
        assert!(max < 0.01, "{name}: {difference}");
    }
}

/// The statistics say for what kind of machine kernels were chosen, and why; a kind that cannot be had is refused.
#[test]
fn the_shape_is_reported_with_its_reason() {
    let here = folder("shape_reported");
    scene(&here);
    let words = "render @/scene.ply --size 32x32 --json";
    let asked = document(line_with(&here, words, Some(("RARA_SHAPE", "gpu:0"))));
    let shape =
        serde_json::json!({"kind": "gpu", "subgroup": 0, "reason": "asked for by RARA_SHAPE"});
    assert_eq!(asked["shape"], shape);
    let own = document(line(&here, words));
    assert!(
        own["shape"]["reason"]
            .as_str()
            .is_some_and(|reason| !reason.is_empty())
    );
    for impossible in ["gpu:3", "gpu:1024", "apu"] {
        let output = line_with(&here, words, Some(("RARA_SHAPE", impossible)));
        assert!(!output.status.success(), "{impossible}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains("subgroups"), "{impossible}: {message}");
    }
}
