//! `rara bake`: what it writes, what it prints, and what it refuses.

use std::fs;

use super::{document, done, folder, line, refused, scene, stderr};

#[test]
fn a_baked_scene_shows_the_cut_without_a_clip() {
    let here = folder("bake");
    scene(&here);
    let words = "bake @/scene.ply -o @/cut.ply --clip plane:1,0,0,0 --views 3 --size 96x96 --json";
    let report = document(line(&here, words));
    let counts = &report["counts"];
    let count = |name: &str| counts[name].as_u64().expect("a count");
    let classes: u64 = ["visible", "cutoff", "invisible"]
        .iter()
        .map(|c| count(c))
        .sum();
    assert_eq!(classes, 2000, "{counts}");
    let written = count("visible") + count("left") + count("children");
    assert_eq!(report["written"], written, "{report}");
    assert_eq!(
        document(line(&here, "info @/cut.ply --json"))["gaussians"],
        written
    );

    // Each view is nearer to the exact cut than by centres, and so are all together.
    let l1 = |of: &serde_json::Value, what: &str| of[what]["l1"].as_f64().expect("a number");
    let views = report["views"].as_array().expect("a list");
    assert_eq!(views.len(), 3);
    for of in views.iter().chain([&report]) {
        assert!(l1(of, "baked") < 0.7 * l1(of, "hard"), "{of}");
        assert!(
            of["baked"]["psnr"].as_f64() > of["hard"]["psnr"].as_f64(),
            "{of}"
        );
    }

    // Once is twice, but for what reading and writing rotations rounds.
    let again = "bake @/cut.ply -o @/again.ply --clip plane:1,0,0,0 --views 0 --json";
    let again = document(line(&here, again));
    assert_eq!(
        (&again["written"], &again["counts"]["children"]),
        (&written.into(), &0.into())
    );
    assert!(again["baked"].is_null() && again["views"].as_array().is_some_and(Vec::is_empty));
    for name in ["cut", "again"] {
        done(line(
            &here,
            &format!("render @/{name}.ply -o @/{name}.exr --size 64x64"),
        ));
    }
    let difference = document(line(&here, "compare @/cut.exr @/again.exr --json"));
    assert!(
        difference["l1"].as_f64().expect("a number") < 1e-4,
        "{difference}"
    );
}

#[test]
fn modes_say_what_is_cut_and_children_how_it_is_replaced() {
    let here = folder("bake-modes");
    scene(&here);
    let bake = |flags: &str| {
        let words = format!(
            "bake @/scene.ply -o @/a.ply --clip box:0,0,0,0.4,0.3,0.5 --views 0 --json {flags}"
        );
        document(line(&here, &words))
    };
    let hard = bake("--mode hard");
    let exact = bake("");
    let rara = bake("--mode rara");
    let three = bake("--children 3");
    assert_eq!(
        (&hard["counts"]["cutoff"], &hard["counts"]["children"]),
        (&0.into(), &0.into())
    );
    let count = |of: &serde_json::Value, name: &str| of["counts"][name].as_u64().expect("a count");
    assert!(count(&rara, "cutoff") >= count(&exact, "cutoff") && count(&exact, "cutoff") > 0);
    let wide = bake("--mode rara --sigma 6");
    assert!(count(&wide, "cutoff") > count(&rara, "cutoff"));
    assert!(count(&three, "children") > 2 * count(&exact, "children"));
    assert!(count(&bake("--leave 2"), "left") < count(&exact, "left"));
    // A hard bake is the hard cut: the same splats are drawn.
    done(line(
        &here,
        "bake @/scene.ply -o @/hard.ply --clip box:0,0,0,0.4,0.3,0.5 --views 0 --mode hard",
    ));
    for words in [
        "render @/hard.ply -o @/a.exr --size 64x64 --eye 3,-2,-5 --target 0,0,0",
        "render @/scene.ply -o @/b.exr --size 64x64 --eye 3,-2,-5 --target 0,0,0 --mode hard --clip box:0,0,0,0.4,0.3,0.5",
    ] {
        done(line(&here, words));
    }
    let difference = document(line(&here, "compare @/a.exr @/b.exr --json"));
    assert!(
        difference["max"].as_f64().expect("a number") < 0.01,
        "{difference}"
    );
}

#[test]
fn several_scenes_become_one_file_or_one_each() {
    let here = folder("bake-layers");
    scene(&here);
    done(line(
        &here,
        "generate layers -n 1000 --seed 2 -o @/other.ply",
    ));
    let words = "bake @/scene.ply @/other.ply -o @/OUT --clip plane:0,1,0,0.1 --views 0 --json";
    let merged = document(line(&here, &words.replace("OUT", "all.ply")));
    let apart = document(line(&here, &words.replace("OUT", "cut_{}.ply")));
    assert_eq!(merged["counts"], apart["counts"]);
    let gaussians = |name: &str| {
        let info = document(line(&here, &format!("info @/{name}.ply --json")));
        info["gaussians"].as_u64().expect("a count")
    };
    let (scene, other) = (gaussians("cut_scene"), gaussians("cut_other"));
    assert!(scene > 0 && other > 0);
    assert_eq!(gaussians("all"), scene + other);
    assert_eq!(merged["files"].as_array().map(Vec::len), Some(1));
    assert_eq!(apart["files"].as_array().map(Vec::len), Some(2));
}

/// One file of several layers has no place for the fade of one. A file for each has the layer's own opacities: the fade stays
/// in the list.
#[test]
fn a_faded_layer_is_baked_as_opaque_as_it_is() {
    let here = folder("bake-faded");
    let file = scene(&here);
    let list = r#"{"layers": [{"name": "skin", "path": "scene.ply", "opacity": 0.5}]}"#;
    fs::write(here.join("list.json"), list).expect("a list");
    let words = "bake @/list.json -o @/OUT --clip plane:1,0,0,1e6 --views 0";
    let merged = line(&here, &words.replace("OUT", "all.ply"));
    refused(&merged, 2, "layer 'skin' is placed or faded");
    done(line(&here, &words.replace("OUT", "cut_{}.ply")));
    let [own, baked] = [file, here.join("cut_skin.ply")].map(|path| {
        let loaded = rara::scene::load(&path, &mut |_, _| ()).expect("a scene");
        loaded.gaussians.into_arrays().opacities
    });
    assert_eq!(own.len(), baked.len());
    let apart = own.iter().zip(&baked).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f32::max) < 1e-6);
}

#[test]
fn a_clip_that_keeps_nothing_leaves_an_empty_scene_and_says_so() {
    let here = folder("bake-empty");
    scene(&here);
    let words = "bake @/scene.ply -o @/none.ply --clip plane:1,0,0,-1e6 --size 32x32 --views 1";
    let printed = stderr(&done(line(&here, words)));
    assert!(
        printed.contains("keeps nothing") && printed.contains("2 000"),
        "{printed}"
    );
    assert_eq!(
        document(line(&here, "info @/none.ply --json"))["gaussians"],
        0
    );
    let words =
        "bake @/scene.ply -o @/all.ply --clip plane:1,0,0,1e6 --views 1 --size 32x32 --json";
    let all = document(line(&here, words));
    assert_eq!(
        (&all["written"], &all["counts"]["visible"]),
        (&2000.into(), &2000.into())
    );
    assert!(
        all["baked"]["psnr"].is_null(),
        "the pictures are equal: {all}"
    );
}

/// Baking writes as converting does, and warns of the same.
#[test]
fn a_cut_is_written_in_every_format_that_scenes_are_converted_to() {
    let here = folder("bake-formats");
    scene(&here);
    let clip = "--clip plane:1,0,0,0";
    let ply = document(line(
        &here,
        &format!("bake @/scene.ply -o @/cut.ply {clip} --views 0 --json"),
    ));
    for ending in ["compressed.ply", "spz", "sog", "glb"] {
        let words = format!("bake @/scene.ply -o @/cut.{ending} {clip} --views 0 --json");
        let report = document(line(&here, &words));
        assert_eq!(report["written"], ply["written"], "{ending}");
        let info = document(line(&here, &format!("info @/cut.{ending} --json")));
        assert_eq!(info["gaussians"], ply["written"], "{ending}");
        // What the format says less of is the same as of the baked scene by itself.
        let words = format!("convert @/cut.ply -o @/again.{ending} --json");
        let again = document(line(&here, &words));
        assert_eq!(report["notes"], again["notes"], "{ending}");
    }
    done(line(
        &here,
        &format!("bake @/scene.ply @/cut.ply -o @/{{}}.b.glb {clip} --views 0"),
    ));
    let info = document(line(&here, "info @/cut.b.glb --json"));
    assert!(info["gaussians"].as_u64() > Some(0), "{info}");
    let far = "--low-pass 0.1 --views 0";
    let said = stderr(&done(line(
        &here,
        &format!("bake @/scene.ply -o @/far.spz {clip} {far}"),
    )));
    assert!(said.contains("draw the file with --low-pass 0.1"), "{said}");
}

#[test]
fn what_cannot_be_baked_is_refused_and_nothing_is_written() {
    let here = folder("bake-refused");
    let file = scene(&here);
    fs::create_dir(here.join("sub")).expect("a folder");
    fs::copy(&file, here.join("sub/scene.ply")).expect("a copy");
    let before = fs::read(&file).expect("the scene");
    for (words, status, what) in [
        ("bake @/scene.ply -o @/a.ply", 2, "no clip"),
        (
            "bake @/scene.ply -o @/a.ply --layer-clip scene=frame",
            2,
            "no clip",
        ),
        (
            "bake @/scene.ply -o @/a.ply --layer-clip scene=whole",
            2,
            "no clip",
        ),
        (
            "bake @/scene.ply -o @/a.txt --clip plane:1,0,0,0",
            2,
            ".ply",
        ),
        ("bake @/scene.ply --clip plane:1,0,0,0", 2, "--output"),
        (
            "bake @/scene.ply -o @/a.ply --clip plane:1,0,0,0 --mode none",
            2,
            "[possible values: hard, rara, exact]",
        ),
        (
            "bake @/scene.ply -o @/a.ply --clip plane:1,0,0,0 --children 4",
            2,
            "4",
        ),
        (
            "bake @/scene.ply -o @/a.ply --clip plane:1,0,0,0 --leave -1",
            2,
            "zero or more",
        ),
        (
            "bake @/scene.ply -o @/a.ply --clip plane:1,0,0,0 --size 0x8",
            2,
            "0x8",
        ),
        (
            "bake @/scene.ply -o @/scene.ply --clip plane:1,0,0,0",
            2,
            "name another file",
        ),
        (
            "bake @/scene.ply -o @/sub/../scene.ply --clip plane:1,0,0,0",
            2,
            "name another file",
        ),
        (
            "bake @/scene.ply -o @/{}.ply --clip plane:1,0,0,0",
            2,
            "name another file",
        ),
        (
            "bake @/scene.ply @/sub/scene.ply -o @/x_{}.ply --clip plane:1,0,0,0",
            2,
            "two of the scenes",
        ),
        (
            "bake @/scene.ply -o @/scene.ply/a.ply --clip plane:1,0,0,0",
            1,
            "not a folder",
        ),
        (
            "bake @/none.ply -o @/a.ply --clip plane:1,0,0,0",
            1,
            "none.ply",
        ),
        (
            "bake @/scene.ply -o @/a.ply --clip plane:1,0,0,0 --device nosuch",
            1,
            "nosuch",
        ),
    ] {
        refused(&line(&here, words), status, what);
    }
    assert_eq!(fs::read(&file).expect("the scene"), before);
    assert_eq!(
        fs::read_dir(&*here).expect("the folder").count(),
        2,
        "nothing was written"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_that_names_the_file() {
    let here = folder("bake-full");
    scene(&here);
    std::os::unix::fs::symlink("/dev/full", here.join("full.ply")).expect("a link");
    let words = "bake @/scene.ply -o @/full.ply --clip plane:1,0,0,0 --views 0";
    refused(&line(&here, words), 1, "full.ply");
}
