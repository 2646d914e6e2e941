//! What training leaves opens as it is.

use std::fs;
use std::path::Path;

use serde_json::json;

use super::{document, done, folder, line, rara_with, refused, scene, stderr};

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
    // They say what is up where none of them is drawn, and then too it is said how they were placed.
    fs::copy(here.join("transforms.json"), out.join("transforms.json")).expect("copies");
    let words = "render @/out/splat.ply --size 8x8 -o @/d.png --repeat 1";
    let printed = stderr(&done(line(&here, words)));
    assert!(
        printed.contains("note: the cameras are placed by"),
        "{printed}"
    );
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
        "line 1 column 16, field `transform`",
    );
}

#[test]
fn what_was_trained_antialiased_is_drawn_so() {
    let here = folder("antialiased");
    scene(&here);
    // Both are rounded alike.
    for (name, kind) in [("plain", "off"), ("smooth", "on")] {
        let words = format!("convert @/scene.ply -o @/{name}.ply --antialiasing {kind}");
        done(line(&here, &words));
    }
    let drawn = |scene: &str| {
        let words = format!("render {scene} --size 64x48 -o @/a.exr --repeat 1");
        done(line(&here, &words));
        fs::read(here.join("a.exr")).expect("a picture")
    };
    let (plain, smooth) = (drawn("@/plain.ply"), drawn("@/smooth.ply"));
    assert!(plain != smooth);
    assert!(drawn("@/plain.ply --antialiasing on") == smooth);
    assert!(drawn("@/plain.ply --antialiasing off --antialiasing plain=on") == smooth);
    assert!(drawn("@/smooth.ply --antialiasing off") == plain);
    let list = json!({"layers": [{"path": "smooth.ply", "antialiased": false}]});
    fs::write(here.join("list.json"), list.to_string()).expect("writes");
    assert!(drawn("@/list.json") == plain);
    assert!(drawn("@/list.json --antialiasing smooth=on") == smooth);
    for (words, says) in [
        ("--antialiasing maybe", "expected on, off or auto"),
        ("--antialiasing hair=on", "no layer is called 'hair'"),
        ("--low-pass much", "expected a number of square pixels"),
        ("--low-pass 0", "it must be from 0.01 to 10"),
        ("--low-pass hair=1", "no layer is called 'hair'"),
    ] {
        refused(&line(&here, &format!("info @/plain.ply {words}")), 2, says);
    }

    // A file is of one kind.
    let both = "@/smooth.ply @/plain.ply";
    let words = format!("convert {both} -o @/both.ply");
    refused(
        &line(&here, &words),
        2,
        "'smooth' was trained with antialiasing and 'plain' without",
    );
    done(line(&here, &format!("{words} --antialiasing on")));
    refused(
        &line(
            &here,
            &format!("{words} --antialiasing on --low-pass plain=0.1"),
        ),
        2,
        "'smooth' was trained with a low-pass of 0.3 px^2 and 'plain' with a low-pass of 0.1",
    );
    let words = format!("bake {both} -o @/baked.ply --clip plane:1,0,0,0 --views 0");
    refused(
        &line(&here, &words),
        2,
        "'smooth' was trained with antialiasing",
    );
    done(line(
        &here,
        "bake @/smooth.ply -o @/baked.ply --clip plane:1,0,0,0 --views 0",
    ));
    for (file, antialiased) in [("both", true), ("baked", true), ("plain", false)] {
        let info = document(line(&here, &format!("info @/{file}.ply --json")));
        assert_eq!(info["layers"][0]["antialiased"], antialiased, "{file}");
    }
    let lost = done(line(&here, "convert @/smooth.ply -o @/smooth.glb"));
    assert!(
        stderr(&lost).contains("glTF has no property"),
        "{}",
        stderr(&lost)
    );

    // The settings of the training count where the file says nothing.
    done(line(&here, "generate general -n 100 -o @/few.ply"));
    trained(&here);
    let settings = "Namespace(sh_degree=3, antialiasing=True)";
    fs::write(here.join("trained/cfg_args"), settings).expect("writes");
    let said = done(line(&here, "info @/trained"));
    assert!(stderr(&said).contains("cfg_args says"), "{}", stderr(&said));
    for (flags, antialiased) in [("", true), (" --antialiasing off", false)] {
        let said = done(line(&here, &format!("info @/trained --json{flags}")));
        // A note that is not so is not made.
        assert_eq!(stderr(&said).contains("cfg_args says"), antialiased);
        let info = document(said);
        assert_eq!(info["layers"][0]["antialiased"], antialiased);
        let notes = info["notes"].as_array().expect("notes");
        assert_eq!(notes.len(), usize::from(antialiased), "{notes:?}");
    }
    // The file's own word counts before that of the settings.
    let at = here.join("trained/point_cloud/iteration_30000/point_cloud.ply");
    let file = fs::read(&at).expect("the scene");
    let line_end = file
        .iter()
        .position(|&byte| byte == b'\n')
        .expect("a header");
    let (magic, rest) = file.split_at(line_end + 1);
    fs::write(&at, [magic, b"comment antialiased 0\n", rest].concat()).expect("writes");
    let said = done(line(&here, "info @/trained --json"));
    assert!(
        !stderr(&said).contains("cfg_args says"),
        "{}",
        stderr(&said)
    );
    assert_eq!(document(said)["layers"][0]["antialiased"], false);
}

#[test]
fn up_is_as_in_the_cameras_beside_the_scene() {
    let here = folder("upright");
    scene(&here);
    done(line(&here, "generate general -n 100 -o @/few.ply"));
    trained(&here);
    let words = "render @/trained --size 8x8 -o @/a.png --repeat 1";
    let printed = stderr(&done(line(&here, words)));
    assert!(!printed.contains("up is"), "{printed}");
    let cameras = json!([{"id": 0, "img_name": "a", "width": 48, "height": 32, "position": [0.0, 0.0, -3.0],
        "rotation": [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]], "fx": 40.0, "fy": 40.0}]);
    fs::write(here.join("trained/cameras.json"), cameras.to_string()).expect("writes");
    let printed = stderr(&done(line(&here, words)));
    assert!(
        printed.contains("up is y, the mean of the cameras in"),
        "{printed}"
    );
    let picture = || fs::read(here.join("a.png")).expect("a picture");
    let by_cameras = picture();
    for (up, is_same) in [("y", true), ("-y", false)] {
        let printed = stderr(&done(line(&here, &format!("{words} --up {up}"))));
        assert!(!printed.contains("up is"), "{printed}");
        assert_eq!(picture() == by_cameras, is_same, "{up}");
    }
    // Without cameras -y is up, and a note says so of formats that do not say it themselves.
    let words = words.replace("@/trained", "@/few.ply");
    let printed = stderr(&done(line(&here, &words)));
    assert!(
        printed.contains("up is -y; if the picture is upside down, give --up y"),
        "{printed}"
    );
    let ply = picture();
    done(line(&here, &format!("{words} --up -y")));
    assert!(picture() == ply);
    done(line(&here, "convert @/few.ply -o @/few.glb"));
    let printed = stderr(&done(line(&here, &words.replace("few.ply", "few.glb"))));
    assert!(!printed.contains("up is"), "{printed}");
}

/// Of another aspect than the camera a picture shows all that the camera sees, in its middle and as it is.
#[test]
fn a_size_of_another_aspect_shows_more() {
    let here = folder("aspect");
    scene(&here);
    let camera = json!({"width": 64, "height": 48, "fx": 50.0, "fy": 50.0, "cx": 32.0, "cy": 24.0,
        "world_to_camera": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4, 0, 0, 0, 1]});
    fs::write(here.join("camera.json"), camera.to_string()).expect("writes");
    let drawn = |size: &str| {
        let words = "render @/scene.ply --camera @/camera.json -o @/a.exr --repeat 1 --raster quad";
        let printed = done(line(&here, &format!("{words} --size {size}")));
        let picture = rara::Picture::load(here.join("a.exr")).expect("a picture");
        (picture, stderr(&printed))
    };
    let (own, printed) = drawn("64x48");
    assert!(!printed.contains("another aspect"), "{printed}");
    for (size, says, [left, above]) in [
        ("80x48", "more at its sides", [8, 0]),
        ("64x60", "more above and below", [0, 6]),
    ] {
        let (wider, printed) = drawn(size);
        assert!(printed.contains(says), "{printed}");
        let pixel = |picture: &rara::Picture, x: usize, y: usize| {
            picture.pixels[y * picture.width as usize + x]
        };
        for y in 0..48 {
            for x in 0..64 {
                let (a, b) = (pixel(&own, x, y), pixel(&wider, x + left, y + above));
                let apart = (0..4).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
                assert!(apart < 2e-3, "{size}: {x}, {y}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn layers_stand_where_they_are_placed() {
    let here = folder("placed");
    scene(&here);
    let drawn = |words: &str| {
        let words = format!(
            "render {words} --size 48x32 -o @/a.exr --repeat 1 --eye 0,0,-6 --target 0,0,0"
        );
        done(line(&here, &words));
        fs::read(here.join("a.exr")).expect("a picture")
    };
    let list = json!({"layers": [{"path": "scene.ply", "position": [0.5, 0.0, 0.0],
        "rotation": [0.0, 0.0, 0.0, 1.0], "scale": 0.5}]});
    fs::write(here.join("list.json"), list.to_string()).expect("writes");
    let listed = drawn("@/list.json");
    let place = |prefix: &str| {
        let flag = format!("--place={prefix}move:0.5,0,0 turn:0,0,1,180 scale:0.5");
        let at = |name: &str| here.join(name).display().to_string();
        let words = ["render", &at("scene.ply"), "-o", &at("a.exr"), &flag];
        let rest = "--size 48x32 --repeat 1 --eye 0,0,-6 --target 0,0,0".split(' ');
        done(rara_with(words.into_iter().chain(rest), None));
        fs::read(here.join("a.exr")).expect("a picture")
    };
    assert!(place("") == listed && place("scene=") == listed);
    // In place of what the list says.
    assert!(drawn("@/list.json --place scene=scale:1") == drawn("@/scene.ply"));
    // Scales of the axes, of which negative ones mirror.
    assert!(drawn("@/scene.ply --place scale:-1") == drawn("@/scene.ply --place scale:-1,-1,-1"));
    let list = json!({"layers": [{"path": "scene.ply", "scale": [-2.0, 1.0, 0.5]}]});
    fs::write(here.join("mirrored.json"), list.to_string()).expect("writes");
    let mirrored = drawn("@/scene.ply --place scale:-2,1,0.5");
    assert!(drawn("@/mirrored.json") == mirrored && mirrored != drawn("@/scene.ply"));
    assert!(
        drawn("@/scene.ply --place scale:7,1,1 --place scene=scale:-2,1,0.5") == mirrored
            && drawn("@/mirrored.json --place scale:-2,1,0.5") == mirrored
    );
    done(line(
        &here,
        "convert @/scene.ply -o @/mirrored.ply --place scale:-2,1,0.5",
    ));
    let at = |name: &str| {
        rara::scene::load(&here.join(name), &mut |_, _| ())
            .expect("reads")
            .gaussians
    };
    let [plain, mirrored] = [at("scene.ply"), at("mirrored.ply")];
    for (from, to) in plain.positions().iter().zip(mirrored.positions()) {
        assert!(to.distance(*from * rara::glam::Vec3::new(-2.0, 1.0, 0.5)) < 1e-5);
    }
    let centre = |words: &str| {
        let info = document(line(&here, &format!("info {words} --json")));
        let axis = |end: &str| info["centres"][end][0].as_f64().expect("a number");
        (axis("min") + axis("max")) / 2.0
    };
    let moved = centre("@/scene.ply --place move:7,0,0") - centre("@/scene.ply");
    assert!((moved - 7.0).abs() < 1e-5, "{moved}");
    done(line(
        &here,
        "convert @/scene.ply -o @/moved.ply --place move:7,0,0",
    ));
    assert!((centre("@/moved.ply") - centre("@/scene.ply") - 7.0).abs() < 1e-5);
    for (words, says) in [
        ("--place hair=scale:2", "no layer is called 'hair'"),
        ("--place scene=size:2", "'size:2' is none of move:X,Y,Z"),
        ("--place scale:0", "none of them 0"),
        ("--place scale:1,0,1", "none of them 0"),
        ("--place scale:1e30,1,1e39", "beyond single precision"),
    ] {
        refused(&line(&here, &format!("info @/scene.ply {words}")), 2, says);
    }
}

/// Cameras of COLMAP stand in the world from which gsplat has made its own.
#[test]
fn cameras_of_colmap_are_placed_in_the_world_that_gsplat_trained_in() {
    let here = folder("trained_gsplat");
    // Splats in pairs opposite each other, so that their median is the origin in any axes, and whose principal axes are x, y and
    // z; they look alike from no two sides. The world of COLMAP is four times as large, turned, and moved to where its cameras
    // look.
    let turn = glam::DQuat::from_xyzw(0.1, -0.3, 0.2, 0.9).normalize();
    let shift = glam::DVec3::new(0.4, -0.3, 0.2);
    let half = [
        [0.1, -0.1, -0.075],
        [0.2, 0.05, -0.1],
        [0.3, 0.2, 0.025],
        [0.4, -0.15, 0.05],
    ];
    let (mut ours, mut theirs, mut points) = (Vec::new(), Vec::new(), String::new());
    for p in half.map(glam::DVec3::from) {
        for p in [p, -p] {
            let q = 4.0 * (turn * p) + shift;
            ours.push((p, 0.02));
            theirs.push((q, 0.08));
            points += &format!("{} {} {} {} 0 0 0 0\n", ours.len(), q.x, q.y, q.z);
        }
    }
    // Two points without splats, whose mean is elsewhere.
    for (number, far) in [(9, 20.0), (10, -10.0)] {
        let q = 4.0 * (turn * glam::DVec3::X * far) + shift;
        points += &format!("{number} {} {} {} 0 0 0 0\n", q.x, q.y, q.z);
    }
    let scene = |name: &str, splats: &[(glam::DVec3, f64)]| {
        let fields = [
            "x", "y", "z", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3",
            "opacity", "f_dc_0", "f_dc_1", "f_dc_2",
        ];
        let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", splats.len());
        fields
            .iter()
            .for_each(|field| text += &format!("property float {field}\n"));
        text += "end_header\n";
        for (number, (p, size)) in splats.iter().enumerate() {
            let (size, red) = (size.ln(), number as f64 / 4.0 - 1.0);
            text += &format!(
                "{} {} {} {size} {size} {size} 1 0 0 0 2 {red} 0 {}\n",
                p.x, p.y, p.z, -red
            );
        }
        let file = here.join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("folders");
        fs::write(file, text).expect("writes");
    };
    scene("colmap.ply", &theirs);
    scene("run/ply/point_cloud_6999.ply", &ours);
    scene("run/ply/point_cloud_999.ply", &ours[..1]);
    // Four cameras look at the origin, from a distance of 4 in the median.
    let mut images = String::new();
    for (number, (away, eye)) in [
        (3.5, (1.0, -0.5, 3.0)),
        (4.0, (-2.0, -1.0, 2.0)),
        (6.0, (3.0, -2.0, 0.5)),
        (4.0, (0.3, -1.5, -3.0)),
    ]
    .into_iter()
    .enumerate()
    {
        let eye = away * glam::DVec3::from(eye).normalize();
        let camera =
            rara::Camera::look_at(eye, glam::DVec3::ZERO, glam::DVec3::NEG_Y, 50.0, (9, 9))
                .expect("a camera");
        let (_, q, t) = camera.world_to_camera().to_scale_rotation_translation();
        images += &format!(
            "{number} {} {} {} {} {} {} {} 1 {number}\n\n",
            q.w, q.x, q.y, q.z, t.x, t.y, t.z
        );
    }
    let model = here.join("sparse/0");
    fs::create_dir_all(&model).expect("folders");
    let put = |name: &str, text: &str| fs::write(model.join(name), text).expect("writes");
    put("cameras.txt", "1 PINHOLE 96 96 100 100 48 48\n");
    put("images.txt", &images);
    put("points3D.txt", &points);
    let says = |text: &str| fs::write(here.join("run/cfg.yml"), text).expect("writes");
    let draw = |scene: &str, name: &str| {
        line(
            &here,
            &format!(
                "render @/{scene} -o @/{name}_{{}}.png --cameras @/sparse/0 --view all --background black"
            ),
        )
    };
    done(draw("colmap.ply", "a"));
    let apart = |name: &str| -> Vec<f64> {
        let compared = (0..4).map(|n| {
            document(line(
                &here,
                &format!("compare @/a_{n}.png @/{name}_{n}.png --json"),
            ))
        });
        compared
            .map(|one| one["max"].as_f64().unwrap_or_else(|| panic!("{one}")))
            .collect()
    };
    for settings in [
        "data_factor: 1\nnormalize_world_space: true\n",
        "data_factor: 1\n",
    ] {
        says(settings);
        for (scene, name) in [("run", "b"), ("run/ply/point_cloud_6999.ply", "c")] {
            let said = stderr(&done(draw(scene, name)));
            assert!(
                said.contains("the cameras are placed in the world that gsplat made of"),
                "{said}"
            );
            assert!(!said.contains("a guess"), "{said}");
            assert!(
                apart(name).iter().all(|&apart| apart <= 1.0),
                "{:?}",
                apart(name)
            );
        }
    }
    says("data_factor: 1\nnormalize_world_space: false\n");
    let said = stderr(&done(draw("run", "d")));
    assert!(
        !said.contains("gsplat made") && apart("d").iter().all(|&apart| apart > 50.0),
        "{said}"
    );
    says("normalize_world_space: true\n");
    for (file, text, why) in [
        (
            "points3D.txt",
            "# none\n",
            "it has no points, and gsplat turns its world by",
        ),
        (
            "points3D.txt",
            "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 3 0 0\n",
            "no three principal axes",
        ),
        (
            "images.txt",
            "1 1 0 0 0 0 0 0 1 a\n",
            "its cameras all stand where they look",
        ),
        (
            "images.txt",
            "1 0 1 0 0 0 0 4 1 a\n2 0 0 0 1 1 0 4 1 b\n",
            "up is y in it, where gsplat mirrors the world",
        ),
    ] {
        put(file, text);
        refused(&draw("run", "e"), 1, why);
        put("points3D.txt", &points);
    }
    fs::remove_file(model.join("points3D.txt")).expect("ours");
    refused(&draw("run", "e"), 1, "points3D.txt");
    fs::remove_dir_all(here.join("run/ply")).expect("ours");
    fs::create_dir_all(here.join("run/ckpts")).expect("a folder");
    let info = line(&here, "info @/run");
    refused(&info, 1, "a checkpoint that only gsplat reads");
}
