//! What training leaves opens as it is.

use std::fs;
use std::path::Path;

use serde_json::json;

use super::{document, done, folder, line, refused, scene, stderr};

/// A 3DGS training folder `@/trained` of `@/scene.ply`.
fn trained(here: &Path) {
    for (iteration, from) in [("7000", "few.ply"), ("30000", "scene.ply")] {
        let inner = here.join(format!("trained/point_cloud/iteration_{iteration}"));
        fs::create_dir_all(&inner).expect("folders");
        fs::copy(here.join(from), inner.join("point_cloud.ply")).expect("a copy");
    }
    let camera = |name: &str, z: f64| {
        json!({"id": 0, "img_name": name, "width": 48, "height": 32, "position": [0.0, 0.0, z],
            "rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "fx": 40.0, "fy": 40.0})
    };
    let cameras = json!([camera("near", -3.0), camera("far", -6.0)]);
    fs::write(here.join("trained/cameras.json"), cameras.to_string()).expect("writes");
}

#[test]
fn a_training_folder_is_its_last_iteration_and_has_its_cameras() {
    let here = folder("trained");
    scene(&here);
    done(line(&here, "generate general -n 100 -o @/few.ply"));
    trained(&here);
    let info = document(line(&here, "info @/trained --json"));
    assert_eq!(
        (&info["gaussians"], &info["layers"][0]["name"]),
        (&2000.into(), &"trained".into())
    );
    let inner = "@/trained/point_cloud/iteration_30000/point_cloud.ply";
    for (name, scene) in [("a", "@/trained"), ("b", inner)] {
        let words = format!("render {scene} --view far -o @/{name}.exr --repeat 1");
        let printed = done(line(&here, &words));
        assert!(
            stderr(&printed).contains("cameras.json"),
            "{}",
            stderr(&printed)
        );
    }
    let named =
        "render @/scene.ply --cameras @/trained/cameras.json --view far -o @/c.exr --repeat 1";
    done(line(&here, named));
    let read = |name: &str| fs::read(here.join(name)).expect("a picture");
    assert!(read("a.exr") == read("c.exr") && read("b.exr") == read("c.exr"));
    refused(
        &line(&here, "render @/scene.ply --view 0 --json"),
        2,
        "no cameras.json",
    );
    // A nerfstudio output without an export says how to make one.
    fs::create_dir_all(here.join("output/nerfstudio_models")).expect("a folder");
    refused(&line(&here, "info @/output"), 1, "ns-export");
}

#[test]
fn nerfstudios_cameras_go_where_its_gaussians_are() {
    let here = folder("nerfstudio");
    scene(&here);
    let out = here.join("out");
    fs::create_dir_all(&out).expect("a folder");
    let words = "convert @/scene.ply -o @/out/splat.ply --scale 0.5 --rotate 0,0,1,90 --move 1,2,3";
    done(line(&here, words));
    // scale (R x + t) is what convert did.
    let transforms = json!({"transform": [[0.0, -1.0, 0.0, 2.0], [1.0, 0.0, 0.0, 4.0], [0.0, 0.0, 1.0, 6.0]], "scale": 0.5});
    fs::write(
        out.join("dataparser_transforms.json"),
        transforms.to_string(),
    )
    .expect("writes");
    // OpenGL's axes, turned so that -z is our forward and +y our up.
    let cameras = json!({"w": 96, "h": 64, "fl_x": 90.0, "fl_y": 90.0, "cx": 48.0, "cy": 32.0, "frames": [
        {"file_path": "a.png", "transform_matrix": [[1.0, 0.0, 0.0, 0.1], [0.0, -1.0, 0.0, 0.2], [0.0, 0.0, -1.0, -3.0], [0.0, 0.0, 0.0, 1.0]]}]});
    fs::write(here.join("transforms.json"), cameras.to_string()).expect("writes");
    let draw = |scene: &str, name: &str| {
        let words = format!("render @/{scene} --cameras @/transforms.json -o @/{name} --repeat 1");
        stderr(&done(line(&here, &words)))
    };
    assert!(!draw("scene.ply", "a.exr").contains("dataparser"));
    assert!(draw("out/splat.ply", "b.exr").contains("dataparser_transforms.json"));
    assert!(draw("out", "c.exr").contains("dataparser_transforms.json"));
    let apart = document(line(&here, "compare @/a.exr @/b.exr --json"));
    assert!(
        apart["psnr"].as_f64().is_none_or(|psnr| psnr > 50.0),
        "{apart}"
    );
    assert_eq!(
        fs::read(here.join("b.exr")).expect("a"),
        fs::read(here.join("c.exr")).expect("b")
    );
    fs::write(
        out.join("dataparser_transforms.json"),
        r#"{"transform": [], "scale": 1}"#,
    )
    .expect("writes");
    let words = "render @/out --cameras @/transforms.json --json";
    refused(
        &line(&here, words),
        1,
        "dataparser_transforms.json: field `transform`",
    );
}
