//! What people are told before they are surprised.

use std::fs;
use std::path::Path;

use super::{document, done, folder, line, line_with, rara, refused, scene, stderr, stdout};

/// A list of cameras with these names, 48x32 pixels each.
fn cameras(here: &Path, names: &[&str]) {
    let camera = |name: &&str| {
        serde_json::json!({"id": 0, "img_name": name, "width": 48, "height": 32, "position": [0.0, 0.0, -4.0],
            "rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "fx": 40.0, "fy": 40.0})
    };
    let cameras: Vec<_> = names.iter().map(camera).collect();
    fs::write(
        here.join("cameras.json"),
        serde_json::to_string(&cameras).expect("JSON"),
    )
    .expect("writes");
}

#[test]
fn what_is_likely_a_mistake_is_warned_of_unless_nobody_wants_to_know() {
    let here = folder("warnings");
    scene(&here);
    cameras(&here, &["a"]);
    for (flags, what) in [
        (
            "--mode none --clip plane:1,0,0,0",
            "--mode none clips nothing",
        ),
        (
            "--mode hard --decay depth --trace-all",
            "note: --trace-all changes nothing without --mode exact or rara",
        ),
        (
            "--mode exact --sigma 2",
            "note: --sigma changes nothing without --mode rara",
        ),
        (
            "--mode hard --phi logistic",
            "note: --phi changes nothing without --mode exact",
        ),
        (
            "--raster quad --transmittance-min 0",
            "note: --transmittance-min changes nothing without --raster tiles or auto",
        ),
        (
            "--clip plane:1,0,0,0 --clip-op or",
            "note: --clip-op changes nothing without a second shape",
        ),
        ("--clip plane:1,0,0,-1e6", "the picture is empty: the clip"),
        (
            "--eye 0,0,-9 --target 0,0,-99",
            "the picture is empty: none",
        ),
        (
            "--clip plane:0,0,1,-1.1 --size 64x64",
            "warning: the clip leaves hardly anything of what is in view",
        ),
        (
            "--clip plane:0,0,1,-1.1 --size 64x64 --background white",
            "warning: the clip leaves hardly anything of what is in view",
        ),
        ("--hide scene", "warning: all that has Gaussians is hidden"),
        (
            "--select all=opacity>0 --hide all",
            "warning: all that has Gaussians is hidden",
        ),
        (
            "--section z=0.5 --slice --section-thickness 1",
            "note: --section-thickness changes nothing together with --slice",
        ),
        (
            "--clip plane:1,0,0,0 --layer-clip scene=whole",
            "note: scene has a clip of its own, which takes the place of the frame's",
        ),
        ("@/scene.ply", "note: 2 layers are called 'scene'"),
        (
            "--cameras @/cameras.json --size 32x32",
            "another aspect than the camera's 48x32",
        ),
    ] {
        let words = format!("render @/scene.ply -o @/a.png --repeat 1 {flags}");
        let printed = done(line(&here, &words));
        assert!(
            stderr(&printed).contains(what),
            "{flags}: {}",
            stderr(&printed)
        );
        let quiet = done(line(&here, &format!("{words} --quiet")));
        assert_eq!(stderr(&quiet), "", "{flags}");
    }
    for flags in [
        "",
        "--clip plane:1,0,0,0 --mode hard --size 32x32",
        "--clip sphere:0,0,0,.5 --size 32x32",
        "--layer-clip scene=plane:1,0,0,0 --size 32x32",
        "other=@/scene.ply --place other=scale:-1 --size 32x32",
        "--section z=0.5 --section-thickness 1 --size 32x32",
        "--cameras @/cameras.json --size 24x16",
    ] {
        let printed = done(line(
            &here,
            &format!("render @/scene.ply -o @/a.png {flags}"),
        ));
        let printed = stderr(&printed);
        assert!(
            !printed.contains("warning:") && !printed.contains("note:"),
            "{printed}"
        );
    }
    refused(
        &line(&here, "--quiet render @/none.ply --json"),
        1,
        "none.ply",
    );
}

#[test]
fn pictures_have_the_names_that_were_asked_for() {
    let here = folder("names");
    scene(&here);
    cameras(&here, &["left/0001.jpg", "right/0001.jpg", "x"]);
    let all = |pattern: &str| {
        let words = "render @/scene.ply --cameras @/cameras.json --view all -o";
        line(&here, &format!("{words} @/{pattern}"))
    };
    done(all("new/folders/{name}.png"));
    done(all("v_{:03}.png"));
    for file in [
        "new/folders/left_0001.png",
        "new/folders/x.png",
        "v_002.png",
    ] {
        assert!(here.join(file).is_file(), "{file}");
    }
    // As long a name as file systems take.
    let long = format!("{}.png", "n".repeat(251));
    done(line(
        &here,
        &format!("render @/scene.ply --size 8x8 -o @/{long}"),
    ));
    assert!(here.join(&long).is_file());
    cameras(&here, &["same", "same"]);
    refused(&all("{name}.png"), 2, "would be one file");
    refused(&all("scene.ply/a_{}.png"), 1, "not a folder");
}

#[cfg(unix)]
#[test]
fn a_name_need_not_be_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let here = folder("no_text");
    let scene = scene(&here);
    let file = here.join(OsStr::from_bytes(b"\xff\xfe.png"));
    let words = [
        OsStr::new("render"),
        scene.as_os_str(),
        OsStr::new("--size"),
        OsStr::new("8x8"),
    ];
    done(rara(
        words
            .into_iter()
            .chain([OsStr::new("-o"), file.as_os_str()]),
    ));
    assert!(file.is_file());
}

#[test]
fn names_that_are_nearly_right_get_a_suggestion() {
    let here = folder("suggestions");
    scene(&here);
    cameras(&here, &["front", "back"]);
    let view = "render @/scene.ply --cameras @/cameras.json --json --view frnot";
    refused(&line(&here, view), 2, "did you mean 'front'?");
    for (flags, what) in [
        ("--preset balancd", "'balanced'"),
        ("--mode exat", "'exact'"),
        ("--background withe", "white"),
    ] {
        refused(
            &line(&here, &format!("render x.ply --json {flags}")),
            2,
            what,
        );
    }
    refused(
        &line(&here, "render @/scene.ply --json --hide scen"),
        2,
        "did you mean 'scene'?",
    );
    refused(&line(&here, "info @/scnee.ply"), 1, "check the name");
}

#[test]
fn json_of_another_kind_is_named_for_what_it_is() {
    let here = folder("json_kinds");
    scene(&here);
    done(line(
        &here,
        "render @/scene.ply -o @/a.png --size 8x8 --save-camera @/camera.json",
    ));
    fs::write(
        here.join("clips.json"),
        r#"[{"normal": [1, 0, 0], "d": 0}]"#,
    )
    .unwrap();
    fs::write(
        here.join("layers.json"),
        r#"{"layers": [{"path": "scene.ply"}]}"#,
    )
    .unwrap();
    let list = r#"[{"id": 1, "img_name": "a", "width": 8, "height": 8, "position": [0, 0, 0]}]"#;
    fs::write(here.join("cameras.json"), list).unwrap();
    for (words, says) in [
        ("@/scene.ply --clip-file @/camera.json", "a file of cameras"),
        (
            "@/scene.ply --clip-file @/cameras.json",
            "a file of cameras",
        ),
        ("@/scene.ply --clip-file @/layers.json", "a list of layers"),
        ("@/scene.ply --camera @/clips.json", "a file of clips"),
        ("@/scene.ply --cameras @/clips.json", "a file of clips"),
        ("@/scene.ply --cameras @/layers.json", "a list of layers"),
        ("@/clips.json", "a file of clips"),
        ("@/camera.json", "a file of cameras"),
    ] {
        refused(&line(&here, &format!("render {words} --json")), 1, says);
    }
}

#[test]
fn what_the_library_warns_of_is_a_note() {
    let here = folder("warnings_in_json");
    scene(&here);
    fs::write(here.join("file"), "no folder").unwrap();
    let unwritable = here.join("file/cache");
    let words = "render @/scene.ply -o @/a.png --size 8x8";
    let variable = Some(("RARA_CACHE", unwritable.to_str().unwrap()));
    let told = stderr(&done(line_with(&here, words, variable)));
    assert!(told.contains("note: ") && told.contains("file"), "{told}");
    let quiet = stderr(&done(line_with(
        &here,
        &format!("{words} --quiet"),
        variable,
    )));
    assert_eq!(quiet, "");
}

#[test]
fn several_scenes_are_told_apart() {
    let here = folder("info_layers");
    scene(&here);
    done(line(
        &here,
        "generate strands -n 300 --seed 2 -o @/more.ply",
    ));
    let told = stdout(&done(line(&here, "info @/scene.ply @/more.ply")));
    let more = told.split_once("layer more").expect("a part for it").1;
    assert!(
        more.contains("robust bounds") && told.contains("layer scene"),
        "{told}"
    );
    let all = document(line(&here, "info @/scene.ply @/more.ply --json"));
    let alone = document(line(&here, "info @/more.ply --json"));
    assert_eq!(all["layers"][1]["statistics"]["scale"], alone["scale"]);
    assert!(alone["layers"][0]["statistics"].is_null());
}

#[test]
fn help_has_commands_and_topics() {
    let help = |of: &[&str]| stdout(&done(rara([&["help"], of].concat())));
    assert!(help(&[]).contains("render") && help(&["render"]).contains("--aov <LIST>"));
    let whole = stdout(&done(rara(["render", "--help"])));
    assert!(whole.contains("ellipsoid:cx") && whole.contains("Next to a.png, the files are"));
    // Each shape has a line of its own.
    for shape in ["plane:nx", "box:cx", "cone:ax", "polygon:AXIS"] {
        let begins = |line: &str| line.trim_start().starts_with(shape);
        assert!(whole.lines().any(begins), "{shape}");
    }
    let clip = help(&["clip"]);
    assert!(
        clip.contains("ellipsoid:cx") && clip.contains("--clip-op"),
        "{clip}"
    );
    assert!(help(&["view"]).contains("Page Up"));
    let said = rara(["help", "clips"]);
    refused(&said, 2, "did you mean 'clip'?");
}

#[test]
fn json_that_will_not_do_is_told_by_its_field() {
    let here = folder("json_fields");
    scene(&here);
    for (file, json, flag, field) in [
        (
            "camera.json",
            r#"{"width": 8, "height": 8, "fx": "wide", "fy": 8, "world_to_camera": []}"#,
            "--camera",
            "field `fx`",
        ),
        (
            "cameras.json",
            r#"[{"id": 1, "width": [], "height": 8}]"#,
            "--cameras",
            "field `[0].width`",
        ),
        (
            "planes.json",
            r#"[{"normal": [1, 0, 0], "d": true}]"#,
            "--clip-file",
            "planes.json",
        ),
    ] {
        fs::write(here.join(file), json).expect("writes");
        refused(
            &line(&here, &format!("render @/scene.ply --json {flag} @/{file}")),
            1,
            field,
        );
    }
    let layers = r#"{"layers": [{"path": "scene.ply", "opacity": "half"}]}"#;
    fs::write(here.join("layers.json"), layers).expect("writes");
    refused(
        &line(&here, "info @/layers.json"),
        1,
        "field `layers[0].opacity`",
    );
}

/// Alpha is for those who composite; what is looked at has none.
#[test]
fn pictures_to_look_at_are_opaque_and_filled() {
    let here = folder("opaque");
    scene(&here);
    done(line(
        &here,
        "demo @/scene.ply -o @/out --size 300x200 --no-reference",
    ));
    for name in ["none", "hard", "rara", "exact", "sheet"] {
        let picture = rara::Picture::load(here.join(format!("out/{name}.png"))).expect("a picture");
        assert!(picture.pixels.iter().all(|pixel| pixel[3] == 1.0), "{name}");
    }
    // Without a camera the scene reaches from edge to edge in one direction, and is in the middle of the other.
    done(line(&here, "render @/scene.ply -o @/a.png --size 200x200"));
    let picture = rara::Picture::load(here.join("a.png")).expect("a picture");
    let is_seen = |x: u32, y: u32| picture.at(x, y)[3] > 0.5;
    let columns: Vec<u32> = (0..200)
        .filter(|&x| (0..200).any(|y| is_seen(x, y)))
        .collect();
    let rows: Vec<u32> = (0..200)
        .filter(|&y| (0..200).any(|x| is_seen(x, y)))
        .collect();
    let extent = |of: &[u32]| of.last().expect("seen") - of[0];
    assert!(
        extent(&columns).max(extent(&rows)) > 150,
        "{columns:?} {rows:?}"
    );
}

#[test]
fn shells_and_man_know_the_program() {
    let here = folder("shell");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = stdout(&done(rara(["completions", shell])));
        assert!(
            script.contains("min-psnr") && script.contains("sweep"),
            "{shell}"
        );
    }
    let page = stdout(&done(rara(["man"])));
    assert!(
        page.contains(".TH rara 1") && page.contains("rara\\-render"),
        "{page}"
    );
    done(line(&here, "man -o @/man1"));
    let page = fs::read_to_string(here.join("man1/rara-render.1")).expect("a page");
    assert!(page.contains("\\-\\-clip"), "{page}");
    assert!(here.join("man1/rara.1").is_file());
}
