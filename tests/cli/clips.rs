//! Clips that are saved and read, and layers with names and clips of their own.

use std::fs;

use rara::Picture;

use super::{Folder, document, done, folder, line, refused, scene};

#[test]
fn clips_of_files_are_what_was_saved() {
    let here = folder("saved_clips");
    scene(&here);
    let drawn = |flags: &str| {
        let words = format!("render @/scene.ply --size 48x32 -o @/a.png --json {flags}");
        document(line(&here, &words));
        fs::read(here.join("a.png")).unwrap()
    };
    let flags =
        "--clip sphere:0.2,0,0,0.7 --clip-expr not(box:0,0,0,.4,.4,.4) --clip !plane:0,1,0,.6";
    let typed = drawn(&format!("{flags} --save-clip @/core.json"));
    assert_ne!(typed, drawn(""));
    for saved in ["core.json", "core.json:core", "core.json:0"] {
        assert_eq!(drawn(&format!("--clip-file @/{saved}")), typed, "{saved}");
    }
    refused(
        &line(
            &here,
            "render @/scene.ply --json --clip-file @/core.json:croe",
        ),
        2,
        "did you mean 'core'?",
    );
    // What stands still in a sweep may be of any shape.
    let words = "sweep @/scene.ply --clip-normal 0,0,1 --clip !box:0,0,0,.4,.4,.4 --frames 2 --size 32x32 --json";
    assert_eq!(
        document(line(&here, words))["frames"]
            .as_array()
            .unwrap()
            .len(),
        2
    );
}

#[test]
fn one_of_several_named_clips_is_asked_for() {
    let here = folder("alternatives");
    scene(&here);
    let planes = r#"[{"name": "axial", "normal": [0, 0, 1], "d": 0}, {"name": "coronal", "normal": [0, 1, 0], "d": 0}]"#;
    fs::write(here.join("planes.json"), planes).unwrap();
    let drawn = |flags: &str| {
        let words = format!("render @/scene.ply --size 48x32 -o @/a.png --json {flags}");
        document(line(&here, &words));
        fs::read(here.join("a.png")).unwrap()
    };
    let words = "render @/scene.ply --json --clip-file @/planes.json";
    for part in ["axial, coronal", "planes.json:axial", "planes.json:*"] {
        refused(&line(&here, words), 2, part);
    }
    let axial = "--clip plane:0,0,1,0";
    assert_eq!(drawn("--clip-file @/planes.json:axial"), drawn(axial));
    let both = format!("{axial} --clip plane:0,1,0,0");
    assert_eq!(drawn("--clip-file @/planes.json:*"), drawn(&both));
    // Clips without names are the parts of one.
    fs::write(
        here.join("parts.json"),
        planes.replace("\"name\"", "\"note\""),
    )
    .unwrap();
    assert_eq!(drawn("--clip-file @/parts.json"), drawn(&both));
}

#[test]
fn clips_at_shares_lie_between_the_bounds_that_info_prints() {
    let here = folder("shares");
    scene(&here);
    let info = document(line(&here, "info @/scene.ply --json"));
    let bound = |end: &str, axis: usize| info["robust_bounds"][end][axis].as_f64().unwrap();
    let at = |axis, share: f64| {
        let (low, high) = (bound("min", axis), bound("max", axis));
        low + (high - low) * share
    };
    let drawn = |command: &str, flags: &str| {
        let words = format!("{command} @/scene.ply {flags}");
        done(line(&here, &words));
    };
    let same = |share: &str, absolute: &str| {
        let picture = |flags: &str| {
            drawn("render", &format!("--size 48x32 -o @/a.png {flags}"));
            fs::read(here.join("a.png")).unwrap()
        };
        assert_eq!(picture(share), picture(absolute), "{share}, {absolute}");
    };
    let plane = format!("plane:1,0,0,{}", -at(0, 0.4));
    same("--clip plane:x=40%", &format!("--clip {plane}"));
    same("--clip !plane:sagittal=40%", &format!("--clip !{plane}"));
    let slab = format!("slab:0,0,1,{},{}", -at(2, 0.25), at(2, 0.5) - at(2, 0.25));
    same(
        "--clip-expr any(slab:axial=25%..50%,plane:x=40%)",
        &format!("--clip-expr any({slab},{plane})"),
    );
    same("--layer-clip scene=plane:x=40%", &format!("--clip {plane}"));
    let core = |region: &str| format!("--select core=inside({region}) --hide scene");
    same(&core("plane:x=40%"), &core(&plane));
    let other = format!("plane:1,0,0,{}", -at(0, 0.7));
    let swept = |from: &str, to: &str| {
        let ends = format!("--from {from} --to {to}");
        drawn(
            "sweep",
            &format!("--size 24x24 --frames 2 -o @/s_{{}}.png {ends}"),
        );
        [0, 1].map(|n| fs::read(here.join(format!("s_{n}.png"))).unwrap())
    };
    let steps = swept("plane:x=40%", "plane:x=70%");
    assert!(steps == swept(&plane, &other) && steps[0] != steps[1]);
    // What is saved says where it lies.
    drawn(
        "render",
        "--size 8x8 -o @/a.png --clip plane:x=40% --save-clip @/saved.json",
    );
    same("--clip-file @/saved.json", &format!("--clip {plane}"));
    let written = |flags: &str| {
        drawn("convert", &format!("{flags} -o @/kept.ply"));
        fs::read(here.join("kept.ply")).unwrap()
    };
    assert_eq!(
        written("--clip plane:x=40%"),
        written(&format!("--clip {plane}"))
    );
    refused(
        &line(&here, "render @/scene.ply --json --clip plane:x=0.4"),
        2,
        "in percent",
    );
}

#[test]
fn shares_in_a_list_are_those_of_all_that_it_lists() {
    let here = folder("listed_shares");
    scene(&here);
    let list = |name: &str, clip: &str, region: &str| {
        let list = serde_json::json!({"layers": [
            {"path": "scene.ply", "name": "near", "clip_expr": clip},
            {"path": "scene.ply", "name": "far", "scale": 2,
                "select": [{"name": "part", "where": format!("inside({region})"), "opacity": 0.3}]},
        ]});
        fs::write(here.join(name), list.to_string()).unwrap();
    };
    let drawn = |name: &str, flags: &str| {
        let words = format!("render @/{name} --size 48x32 -o @/a.exr {flags}");
        done(line(&here, &words));
        fs::read(here.join("a.exr")).unwrap()
    };
    list("shares.json", "plane:x=40%", "plane:x=70%");
    let info = document(line(&here, "info @/shares.json --json"));
    let plane = |percent: f64| {
        let [low, high] = ["min", "max"].map(|end| info["robust_bounds"][end][0].as_f64().unwrap());
        format!("plane:1,0,0,{}", -(low + (high - low) * percent / 100.0))
    };
    list("places.json", &plane(40.0), &plane(70.0));
    list("others.json", &plane(50.0), &plane(70.0));
    for flags in ["", "--hide far", "--place near=move:0.1,0,0"] {
        let shown = drawn("shares.json", flags);
        assert!(shown == drawn("places.json", flags), "{flags}");
        assert!(shown != drawn("others.json", flags), "{flags}");
    }
}

#[test]
fn clips_of_layers_are_saved_with_the_frames() {
    let here = folder("saved_layer_clips");
    scene(&here);
    for seed in [2, 3] {
        let words = format!("generate layers -n 300 --seed {seed} -o @/more{seed}.ply");
        done(line(&here, &words));
    }
    let drawn = |flags: &str| {
        let scenes = "@/scene.ply @/more2.ply @/more3.ply";
        let words = format!("render {scenes} --size 48x32 -o @/a.exr {flags}");
        done(line(&here, &words));
        fs::read(here.join("a.exr")).unwrap()
    };
    let frame = "--clip plane:1,0,0,0";
    let flags = format!("{frame} --layer-clip more2=whole --layer-clip more3=sphere:0,0,0,.4");
    let typed = drawn(&format!("{flags} --save-clip @/saved.json"));
    assert!(typed != drawn(frame) && typed == drawn("--clip-file @/saved.json"));
    // The clip of a name comes with those of the layers, and that of a layer comes alone.
    assert!(typed == drawn("--clip-file @/saved.json:saved"));
    let alone = drawn("--clip-file @/saved.json:more3");
    assert!(alone != drawn("") && alone == drawn("--layer-clip more3=sphere:0,0,0,.4"));
    let taken_back = "--layer-clip more2=plane:1,0,0,0 --layer-clip more3=plane:1,0,0,0";
    assert!(drawn(&format!("--clip-file @/saved.json {taken_back}")) == drawn(frame));
    refused(
        &line(&here, "render @/scene.ply --json --clip-file @/saved.json"),
        2,
        "no layer is called 'more2'",
    );
}

#[test]
fn a_lasso_holds_what_the_first_picture_shows_in_it() {
    let here = folder("lasso");
    scene(&here);
    let draw = |name: &str, flags: &str| {
        let words = format!("render @/scene.ply -o @/{name} --size 64x48 {flags}");
        done(line(&here, &words));
        Picture::load(here.join(name)).expect("a picture")
    };
    let whole = draw("whole.exr", "");
    let kept = draw(
        "kept.exr",
        "--lasso 0,0;32,0;32,48;0,48 --save-clip @/kept.json",
    );
    let rest = draw("rest.exr", "--lasso !0,0;32,0;32,48;0,48");
    // Splats are cut where the picture is: what is far from the outline is whole, or away.
    for (x, y) in [(8, 24), (20, 10), (44, 30), (58, 24)] {
        let [held, left] = [&kept, &rest].map(|picture| picture.at(x, y));
        let (shown, away) = if x < 32 { (held, left) } else { (left, held) };
        let all = whole.at(x, y);
        assert!((0..4).all(|i| (shown[i] - all[i]).abs() < 2e-3), "{x} {y}");
        assert!(away[3] < 2e-3, "{x} {y}: {away:?}");
    }
    let again = draw("again.exr", "--clip-file @/kept.json");
    assert!(again == kept, "the cone was saved");
    let turned = "--eye 4,0,0 --target 0,0,0";
    let from_aside = draw("aside.exr", &format!("{turned} --clip-file @/kept.json"));
    let uncut = draw("aside_whole.exr", turned);
    assert!(from_aside != uncut);
    for (flags, says) in [
        ("--lasso 0,0;32,0", "three corners"),
        ("--lasso 0,0;9,9;9,0;0,9", "edges that cross"),
        ("--lasso 0,0;9", "'9' is not a corner"),
    ] {
        refused(
            &line(&here, &format!("render @/scene.ply -o @/a.png {flags}")),
            2,
            says,
        );
    }
    let plot = r#"{"type": "Polygon", "coordinates": [[[-0.5, -0.5], [0.6, -0.4], [0, 0.5]]]}"#;
    fs::write(here.join("plot.geojson"), plot).unwrap();
    let of_file = draw("file.exr", "--clip polygon:z=-1..1;@/plot.geojson");
    let typed = draw("typed.exr", "--clip polygon:z=-1..1;-.5,-.5;.6,-.4;0,.5");
    assert!(of_file == typed);
}

#[test]
fn layers_have_names_and_clips_of_their_own() {
    let here = folder("named_layers");
    scene(&here);
    done(line(&here, "generate layers -n 800 --seed 2 -o @/more.ply"));
    let counts = |flags: &str| {
        let report = document(line(&here, &format!("render {flags} --size 48x32 --json")));
        let counts = ["visible", "cutoff", "invisible"]
            .map(|class| report["counts"][class].as_u64().unwrap());
        let names = report["scene"]["layers"].as_array().unwrap();
        let names: Vec<String> = names
            .iter()
            .map(|l| l["name"].as_str().unwrap().into())
            .collect();
        (counts, names)
    };
    let both = "outer=@/scene.ply inner=@/more.ply --clip plane:1,0,0,0";
    let (cut, names) = counts(both);
    assert_eq!(names, ["outer", "inner"]);
    let ([_, _, invisible], _) = counts(&format!("{both} --layer-clip inner=whole"));
    assert!(0 < invisible && invisible < cut[2]);
    let (whole, _) = counts("outer=@/scene.ply inner=@/more.ply --layer-clip inner=whole");
    assert_eq!(whole[1..], [0, 0]);
    let ([hidden, _, _], _) = counts("outer=@/scene.ply inner=@/more.ply --hide outer");
    assert!(hidden <= 800);
    for (flags, words) in [
        ("--hide skin", "the layers are outer, inner"),
        ("--unhide skin", "the layers are outer, inner"),
        ("--layer-clip inner", "NAME=EXPRESSION"),
        ("--layer-clip inner=some(box:0)", "column 1"),
    ] {
        let words_of = format!("render {both} --json {flags}");
        refused(&line(&here, &words_of), 2, words);
    }

    let list = serde_json::json!({"layers": [
        {"path": "scene.ply", "name": "outer", "clip_expr": "plane:1,0,0,0"},
        {"path": "more.ply", "name": "inner", "clip": {"plane": {"normal": [1, 0, 0], "d": 0}}},
    ]});
    fs::write(here.join("list.json"), list.to_string()).unwrap();
    assert_eq!(counts("@/list.json"), (cut, names));
    let listed = document(line(&here, "info @/list.json --json"));
    assert_eq!(listed["layers"][1]["name"], "inner");
    // Flags take back what a list says. A name may hold the sign that a clip begins with.
    let list = serde_json::json!({"layers": [
        {"path": "scene.ply", "name": "k=v", "clip_expr": "whole"},
        {"path": "more.ply", "name": "inner", "visible": false},
    ]});
    fs::write(here.join("list.json"), list.to_string()).unwrap();
    let taken_back = "--clip plane:1,0,0,0 --layer-clip k=v=frame --unhide inner";
    assert_eq!(counts(&format!("@/list.json {taken_back}")).0, cut);
    assert_ne!(counts("@/list.json --clip plane:1,0,0,0").0, cut);
    for (text, words) in [
        ("{\"layers\": []}", "no layer"),
        (
            "{\"layers\": [{\"path\": \"scene.ply\", \"scale\": 0}]}",
            "layer 0",
        ),
        ("{\"layers\": [{\"path\": \"gone.ply\"}]}", "gone.ply"),
        ("{\"layers\": [{\"file\": \"scene.ply\"}]}", "file"),
        (
            "{\"layers\": [{\"path\": \"scene.ply\", \"opacity\": 3}]}",
            "layer 0: the opacity of layer 'scene' is 3; give 0 to 1",
        ),
        ("[]", "expected an object whose \"layers\""),
        ("nonsense", "this is not valid JSON"),
    ] {
        fs::write(here.join("list.json"), text).unwrap();
        refused(&line(&here, "info @/list.json"), 1, words);
    }
}

/// The box from -1 to 1 as a file.
fn cube(here: &Folder) {
    let corner = |at: u32| [0, 1, 2].map(|axis| if at >> axis & 1 == 1 { 1 } else { -1 });
    let mut text = String::new();
    for [x, y, z] in (0..8).map(corner) {
        text += &format!("v {x} {y} {z}\n");
    }
    // Each side as a polygon of four corners, which turns to the left as seen from outside.
    for side in [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ] {
        text += &format!("f {side}\n");
    }
    fs::write(here.join("cube.obj"), text).unwrap();
}

#[test]
fn a_mesh_is_a_clip_like_any_other() {
    let here = folder("meshes");
    scene(&here);
    cube(&here);
    let draw = |name: &str, flags: &str| {
        let words = format!("render @/scene.ply -o @/{name} --size 48x36 {flags}");
        done(line(&here, &words));
        Picture::load(here.join(name)).expect("a picture")
    };
    let most = |a: &Picture, b: &Picture| {
        let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    let placed = "mesh:@/cube.obj;scale=0.4;turn=0.9,0.2,0.1,0.3;at=0.1,0,0.2";
    let solid = "box:0.1,0,0.2,0.4,0.4,0.4,0.9,0.2,0.1,0.3";
    let whole = draw("whole.exr", "");
    for mode in ["hard", "rara", "exact"] {
        for not in ["", "!"] {
            let of_mesh = draw("mesh.exr", &format!("--mode {mode} --clip {not}{placed}"));
            let of_box = draw("box.exr", &format!("--mode {mode} --clip {not}{solid}"));
            let off = most(&of_mesh, &of_box);
            // The weight of mode rara jumps where a ray leaves the ellipsoid.
            let most_off = if mode == "rara" { 5.0 } else { 2.0 };
            assert!(off < most_off / 255.0, "{mode} {not}: {off}");
            assert!(most(&of_mesh, &whole) > 0.05, "{mode} {not}");
        }
    }
    // In combinations, however splats are drawn, saved, moved and as a selection.
    let both = format!("all(!{placed},plane:1,0,0,0)");
    let tiles = draw(
        "tiles.exr",
        &format!("--clip-expr {both} --save-clip @/kept.json"),
    );
    let of_box = draw(
        "box.exr",
        &format!("--clip-expr all(!{solid},plane:1,0,0,0)"),
    );
    assert!(most(&tiles, &of_box) < 2.0 / 255.0);
    let quads = draw("quads.exr", &format!("--clip-expr {both} --raster quad"));
    assert!(most(&tiles, &quads) < 1.0 / 255.0);
    assert!(draw("saved.exr", "--clip-file @/kept.json") == tiles);
    let way = "sweep @/scene.ply --frames 3 --size 32x24 -o @/way_{}.exr";
    let ends = "--from mesh:@/cube.obj;scale=0.2 --to mesh:@/cube.obj;scale=0.6;at=0.4,0,0";
    done(line(&here, &format!("{way} {ends}")));
    let middle = Picture::load(here.join("way_1.exr")).expect("a picture");
    let clip = "--size 32x24 --clip mesh:@/cube.obj;scale=0.4;at=0.2,0,0";
    done(line(
        &here,
        &format!("render @/scene.ply -o @/still.exr {clip}"),
    ));
    assert!(
        most(
            &middle,
            &Picture::load(here.join("still.exr")).expect("a picture")
        ) < 1e-3
    );
    // A selection by centres: the mesh and the box pick the same splats.
    let seen = "--eye 0,0,-4 --target 0,0,0 --layer-opacity core=0";
    let picked = draw(
        "picked.exr",
        &format!("{seen} --select core=inside({placed})"),
    );
    let of_box = draw("box.exr", &format!("{seen} --select core=inside({solid})"));
    assert!(picked == of_box, "{}", most(&picked, &of_box));
    assert!(most(&picked, &draw("whole.exr", "--eye 0,0,-4 --target 0,0,0")) > 0.05);
    for (flags, says) in [
        ("--clip mesh:@/none.obj", "none.obj"),
        ("--clip mesh:@/cube.obj;at=1", "'1' has 1 numbers; give 3"),
        ("--clip mesh:@/scene.ply", "scene.ply"),
    ] {
        let words = format!("render @/scene.ply -o @/a.png {flags}");
        refused(&line(&here, &words), 2, says);
    }
}
