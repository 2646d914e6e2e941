//! Reading camera files: each format gives the same camera, bad files give a sentence, and nothing panics.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DMat4, DQuat, DVec3, DVec4};
use proptest::prelude::*;
use rara::Camera;
use rara::camera_files::{
    NamedCamera, PathSettings, load_camera, load_cameras, load_path_settings,
};

use super::colmap::colmap_binary;

/// A folder of its own, removed at the end.
pub(super) struct Folder(pub(super) PathBuf);

impl Folder {
    pub(super) fn new() -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let path =
            std::env::temp_dir().join(format!("rara-cameras-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(super) fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).unwrap();
    }
}

fn load_json(text: &str) -> rara::Result<Vec<NamedCamera>> {
    let folder = Folder::new();
    load_cameras(&folder.file("cameras.json", text))
}

/// All of the cameras, as they are drawn.
fn draw_json(text: &str) -> rara::Result<Vec<Camera>> {
    load_json(text)?.iter().map(NamedCamera::camera).collect()
}

/// The camera that all the files below describe.
pub(super) fn camera() -> Camera {
    let rotation = DQuat::from_xyzw(0.1, -0.3, 0.2, 0.9).normalize();
    let matrix = DMat4::from_rotation_translation(rotation, DVec3::new(0.5, -0.25, 3.0));
    Camera::from_world_to_camera(matrix, (800.0, 810.0, 500.0, 300.0), (1000, 600)).unwrap()
}

pub(super) fn assert_same(a: &Camera, b: &Camera) {
    assert_eq!((a.width, a.height), (b.width, b.height));
    for (a, b) in [(a.fx, b.fx), (a.fy, b.fy), (a.cx, b.cx), (a.cy, b.cy)] {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    assert!(a.eye.abs_diff_eq(b.eye, 1e-9), "{} {}", a.eye, b.eye);
    assert!(a.rotation.abs_diff_eq(b.rotation, 1e-9));
}

fn json<const N: usize>(row: [f64; N]) -> String {
    format!("{row:?}")
}

fn inria_entry(name: &str) -> String {
    let camera = camera();
    let to_world = camera.rotation.transpose();
    let rows: Vec<_> = (0..3).map(|i| json(to_world.row(i).to_array())).collect();
    format!(
        r#"{{"id": 4, "img_name": "{name}", "width": 1000, "height": 600, "position": {}, "rotation": [{}],
        "fx": 800.0, "fy": 810, "extra": null}}"#,
        json(camera.eye.to_array()),
        rows.join(", ")
    )
}

#[test]
fn cameras_json() {
    let cameras = load_json(&format!(
        "\u{feff} [{}, {}]",
        inria_entry("b"),
        inria_entry("a")
    ))
    .unwrap();
    assert_eq!([cameras[0].name(), cameras[1].name()], ["b", "a"]);
    assert_same(&cameras[0].camera().unwrap(), &camera());
}

fn opengl_matrix() -> String {
    let to_world = camera().world_to_camera().inverse()
        * DMat4::from_diagonal(DVec4::new(1.0, -1.0, -1.0, 1.0));
    let mut rows: Vec<_> = (0..3).map(|i| json(to_world.row(i).to_array())).collect();
    rows.push("[0.0, 0.0, 0.0, 1.0]".into());
    format!("[{}]", rows.join(", "))
}

#[test]
fn transforms_json() {
    let matrix = opengl_matrix();
    let shared = load_json(&format!(
        r#"{{"w": 1000, "h": 600.0, "fl_x": 800, "fl_y": 810, "cx": 500, "cy": 300, "k1": 0, "camera_model": "OPENCV",
        "frames": [{{"file_path": "images/1.png", "transform_matrix": {matrix}}}]}}"#
    ))
    .unwrap();
    assert_eq!(shared[0].name(), "images/1.png");
    assert_same(&shared[0].camera().unwrap(), &camera());
    let own = load_json(&format!(
        r#"{{"w": 1, "h": 1, "fl_x": 1, "frames": [{{"w": 1000, "h": 600, "fl_x": 800, "fl_y": 810,
        "transform_matrix": {matrix}}}]}}"#
    ))
    .unwrap();
    assert_eq!(own[0].name(), "0");
    assert_same(&own[0].camera().unwrap(), &camera());
    let angle = draw_json(&format!(
        r#"{{"camera_angle_x": 1.5707963267948966, "frames": [{{"transform_matrix": {matrix}}}]}}"#
    ))
    .unwrap()[0];
    assert!((angle.fx - 512.0).abs() < 1e-9 && angle.fx == angle.fy && angle.width == 1024);
}

#[test]
fn paths_of_the_viewer() {
    let path = |kind: &str, fov: f64| {
        let pose = "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4, 0, 0, 0, 1]";
        let camera = format!(r#"{{"camera_to_world": {pose}, "fov": {fov}, "aspect": 1.5}}"#);
        format!(
            r#"{{"keyframes": [], "camera_type": "{kind}", "render_height": 480, "render_width": 720, "fps": 24,
            "camera_path": [{camera}, {camera}]}}"#
        )
    };
    let cameras = draw_json(&path("perspective", 90.0)).unwrap();
    assert_eq!(cameras.len(), 2);
    let camera = &cameras[1];
    assert_eq!((camera.width, camera.height), (720, 480));
    assert!((camera.fx - 240.0).abs() < 1e-9 && (camera.fy - 240.0).abs() < 1e-9);
    // At (0, 0, 4) along -z, with y up.
    let matrix = camera.world_to_camera();
    let seen = matrix.transform_point3(glam::DVec3::new(1.0, 2.0, 1.0));
    assert!(
        seen.abs_diff_eq(glam::DVec3::new(1.0, -2.0, 3.0), 1e-12),
        "{seen}"
    );
    for (text, says) in [
        (path("equirectangular", 90.0), "only perspective"),
        (path("perspective", 180.0), "between 0 and 180"),
        (
            path("perspective", 90.0).replace("[1, 0", "[0"),
            "16 numbers",
        ),
    ] {
        let message = draw_json(&text).unwrap_err().to_string();
        assert!(message.contains(says), "{message}");
    }
}

/// Settings of SuperSplat's viewer, of either version: the world is turned by half a turn about z.
#[test]
fn settings_of_supersplat() {
    let pose = r#""position": [1, 2, -3], "target": [1, 2, 4], "fov": 90"#;
    let keys = r#""keyframes": {"times": [0, 9], "values": {"position": [1, 2, -3, 0, 5, 0], "target": [1, 2, 4, 0, 0, 0], "fov": [90]}}"#;
    let of_one = format!(
        r#"{{"camera": {{{pose}, "startAnim": "none"}}, "animTracks": [{{"name": "way", {keys}}}, {{{keys}}}]}}"#
    );
    let of_two = format!(
        r#"{{"version": 2, "startMode": "default", "cameras": [{{"initial": {{{pose}}}}}],
        "annotations": [{{"title": "roof", "camera": {{"initial": {{{pose}}}}}}}, {{}}]}}"#
    );
    let names = |text: &str| -> Vec<String> {
        let cameras = load_json(text).expect("cameras");
        cameras.iter().map(|one| one.name().to_owned()).collect()
    };
    assert_eq!(
        names(&of_one),
        ["camera", "way 0", "way 1", "track 1 0", "track 1 1"]
    );
    assert_eq!(names(&of_two), ["camera", "roof"]);
    for camera in [
        draw_json(&of_one).unwrap()[1],
        draw_json(&of_two).unwrap()[0],
    ] {
        assert!(camera.eye.abs_diff_eq(DVec3::new(-1.0, -2.0, -3.0), 1e-12));
        assert!(camera.rotation.abs_diff_eq(glam::DMat3::IDENTITY, 1e-12));
        assert!((camera.fx - 512.0).abs() < 1e-9 && camera.fx == camera.fy);
    }
    // The key that looks straight down has an up too, and the fov that the keys of a track lack is the camera's.
    let down = draw_json(&of_one).unwrap()[2];
    assert!(down.rotation.row(2).abs_diff_eq(DVec3::Y, 1e-12) && (down.fx - 512.0).abs() < 1e-9);
    let none = load_json(r#"{"camera": {"fov": 60, "position": null}, "animTracks": []}"#);
    let message = none.unwrap_err().to_string();
    assert!(message.contains("no camera stands"), "{message}");
}

#[test]
fn projects_of_pix4d() {
    // Omega, phi and kappa of the camera, from its right, up and back to the world.
    let axes =
        camera().rotation.transpose() * glam::DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    let (phi, omega, kappa) = (
        axes.z_axis.x.asin(),
        (-axes.z_axis.y).atan2(axes.z_axis.z),
        (-axes.y_axis.x).atan2(axes.x_axis.x),
    );
    let angles = json([omega, phi, kappa].map(f64::to_degrees));
    let eye = json(camera().eye.to_array());
    let sensor =
        |id: u32, internals: &str| format!(r#"{{"id": {id}, "internals": {{{internals}}}}}"#);
    let pinhole =
        r#""type": "perspective", "principal_point_px": [500, 300], "focal_length_px": 800"#;
    let sensors = [
        sensor(
            1,
            &format!(
                r#"{pinhole}, "radial_distortion": [0, 0, 0], "tangential_distortion": [0, 0]"#
            ),
        ),
        sensor(
            2,
            &format!(r#"{pinhole}, "radial_distortion": [0.1, 0, 0]"#),
        ),
        sensor(
            3,
            r#""type": "fisheye", "principal_point_px": [500, 300], "affine": [800, 0, 0, 800]"#,
        ),
        sensor(4, r#""type": "spherical""#),
    ];
    let pose = |id: u32| {
        format!(
            r#"{{"id": {}, "sensor_id": {id}, "position": {eye}, "orientation_deg": {angles}}}"#,
            10 + id
        )
    };
    let all: Vec<_> = (1..=5).map(pose).collect();
    let calibrated = format!(
        r#"{{"format": "application/opf-calibrated-cameras+json", "version": "1.0", "sensors": [{}], "cameras": [{}]}}"#,
        sensors.join(", "),
        all.join(", ")
    );
    let folder = Folder::new();
    let alone = folder.file("in/calibrated.json", &calibrated);
    let item = |file: &str, format: &str| {
        format!(r#"{{"uri": "in/{file}.json", "format": "application/opf-{format}+json"}}"#)
    };
    let project = folder.file(
        "project.opf",
        format!(
            r#"{{"format": "application/opf-project+json", "items": [{{"type": "calibration", "resources": [{}]}}, {{"resources": [{}, {}]}}]}}"#,
            item("calibrated", "calibrated-cameras"),
            item("input", "input-cameras"),
            item("list", "camera-list")
        ),
    );
    let missing = load_cameras(&project).unwrap_err().to_string();
    assert!(
        missing.contains(
            "project.opf: this project of Pix4D names in/input.json, which is not in its folder"
        ),
        "{missing}"
    );
    folder.file(
        "in/input.json",
        r#"{"sensors": [{"id": 1, "image_size_px": [1000, 600]}], "captures": []}"#,
    );
    folder.file(
        "in/list.json",
        r#"{"cameras": [{"id": 11, "uri": "images/a.jpg"}]}"#,
    );
    let of_project = load_cameras(&project).unwrap();
    assert_eq!(of_project[0].name(), "images/a.jpg");
    assert_eq!(of_project[1].name(), "12");
    let of_file = load_cameras(&alone).unwrap();
    assert!(of_project[0].repairs().is_empty() && of_file[0].repairs()[0].contains("does not say"));
    for cameras in [&of_project, &of_file] {
        let lenses: Vec<_> = cameras.iter().map(NamedCamera::distortion).collect();
        assert_eq!(
            lenses,
            [
                None,
                Some("perspective"),
                Some("fisheye"),
                Some("spherical"),
                None
            ]
        );
        for one in &cameras[..3] {
            assert_same(&one.undistorted().unwrap(), &camera().fy(800.0));
        }
        for (number, says) in [
            (3, "spherical sensor, which has no pinhole"),
            (4, "no sensor that the file lists"),
        ] {
            let message = cameras[number].undistorted().unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }
}

/// Cameras of glTF stand where the nodes of the scene put them, whatever these scale, in the coordinates of its Gaussians.
#[test]
fn cameras_of_gltf() {
    // The camera's axes and eye before Gaussians are turned by half a turn about z, as glTF's camera has them: -z is forward.
    let turn = glam::DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
    let axes = turn
        * camera().rotation.transpose()
        * glam::DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    let eye = turn * camera().eye;
    let (outer, shift) = (DQuat::from_rotation_x(0.4), DVec3::new(1.0, 2.0, -3.0));
    let q = (outer.inverse() * DQuat::from_mat3(&axes)).to_array();
    let inner = outer.inverse() * (eye - shift) / 2.0;
    let columns = DMat4::from_mat3_translation(5.0 * axes, eye).to_cols_array();
    let angle = 2.0 * (512.0_f64 / 700.0).atan();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 1, "scenes": [{{}}, {{"nodes": [0, 3]}}], "nodes": [
        {{"children": [1, 2], "translation": {}, "rotation": {}, "scale": [2, 2, 2]}},
        {{"camera": 0, "name": "shot", "translation": {}, "rotation": {}}},
        {{"camera": 1}},
        {{"camera": 1, "matrix": {}}},
        {{"camera": 0, "name": "not in the scene"}}],
        "cameras": [{{"type": "perspective", "name": "lens", "perspective": {{"yfov": {angle}, "znear": 0.1, "aspectRatio": 1.5}}}},
        {{"type": "orthographic", "name": "flat", "orthographic": {{"xmag": 4, "ymag": 2, "znear": 0, "zfar": 9}}}}]}}"#,
        json(shift.to_array()),
        json(outer.to_array()),
        json(inner.to_array()),
        json(q),
        json(columns),
    );
    let folder = Folder::new();
    let glb = |text: &str| {
        let mut bytes = b"glTF".to_vec();
        bytes.extend([2, 0, text.len() as u32].map(u32::to_le_bytes).concat());
        bytes[8..12].copy_from_slice(&(20 + text.len() as u32).to_le_bytes());
        bytes.splice(12..16, (text.len() as u32).to_le_bytes());
        bytes.extend(b"JSON");
        bytes.extend(text.as_bytes());
        bytes
    };
    let binary = glb(&text);
    for path in [folder.file("a.gltf", &text), folder.file("a.glb", &binary)] {
        let cameras = load_cameras(&path).unwrap();
        let names: Vec<_> = cameras.iter().map(NamedCamera::name).collect();
        assert_eq!(names, ["shot", "flat", "flat"]);
        let shot = cameras[0].camera().unwrap();
        assert_eq!((shot.width, shot.height), (1536, 1024));
        let expected = camera().width(1536).height(1024).cx(768.0).cy(512.0);
        assert_same(&shot, &expected.fx(700.0).fy(700.0));
        let flat = cameras[2].camera().unwrap();
        assert_eq!((flat.width, flat.fx), (2048, 256.0));
        assert_eq!(flat.projection, rara::Projection::Orthographic);
        assert!(
            flat.eye.abs_diff_eq(camera().eye, 1e-9)
                && flat.rotation.abs_diff_eq(camera().rotation, 1e-9)
        );
    }
    assert_eq!(
        rara::camera_files::cameras_from_json(&binary, Path::new("a"))
            .unwrap()
            .len(),
        3
    );
    for cut in 4..binary.len() {
        assert!(load_cameras(&folder.file("cut.glb", &binary[..cut])).is_err());
        assert!(rara::camera_files::cameras_from_json(&binary[..cut], Path::new("a")).is_err());
    }
    for (from, to, says) in [
        (
            r#""nodes": [0, 3]"#,
            r#""nodes": []"#,
            "no cameras in its scene",
        ),
        (
            r#""children": [1, 2]"#,
            r#""children": [0]"#,
            "its own child",
        ),
        (
            r#""children": [1, 2]"#,
            r#""children": [9]"#,
            "node 9 of the glTF is not there",
        ),
        (
            r#""camera": 1}}"#.trim_end_matches('}'),
            r#""camera": 7"#,
            "`1` of node 2 is not in the glTF",
        ),
        (
            r#""orthographic": "#,
            r#""other": "#,
            "neither perspective nor orthographic",
        ),
        (r#""yfov": "#, r#""yfov": -"#, "`shot`"),
    ] {
        let wrong = text.replacen(from, to, 1);
        let message = draw_json(&wrong).unwrap_err().to_string();
        assert!(message.contains(says), "{says}: {message}");
    }
}

/// What other programs write is named, with what to do.
#[test]
fn cameras_of_others_are_named() {
    for (text, says) in [
        (
            r#"[{"cameras": {}, "shots": {}}]"#,
            "a reconstruction of OpenSfM",
        ),
        (
            r#"{"shots": {}, "cameras": {}}"#,
            "a reconstruction of OpenSfM",
        ),
        (
            r#"{"sfm_data_version": "0.3", "views": [], "intrinsics": []}"#,
            "a scene of OpenMVG",
        ),
        (
            r#"{"version": ["1"], "views": [], "intrinsics": [], "poses": []}"#,
            "Meshroom",
        ),
        (r#"{"fx": 1, "t_00": 1, "t_23": 0}"#, "a camera of Polycam"),
        (r#"{"K": [], "poses": [], "w": 1, "h": 1}"#, "Record3D"),
        (r#"{"cameraPoseARFrame": [], "intrinsics": []}"#, "ARKit"),
        (
            r#"{"format": "application/opf-input-cameras+json", "version": "1.0"}"#,
            "give the .opf",
        ),
        (
            r#"{"format": "application/opf-project+json", "items": []}"#,
            "without calibrated cameras",
        ),
        (
            r#"{"type": "FeatureCollection", "features": []}"#,
            "GeoJSON",
        ),
        (
            r#"{"asset": {}, "geometricError": 1, "root": {}}"#,
            "a tileset of 3D Tiles",
        ),
        ("# Bundle file v0.3\n1 0\n", "Bundler"),
        ("NVM_V3 \n\n1\n", "VisualSFM"),
        ("<?xml version=\"1.0\"?>", "Metashape"),
        (
            "BLENDER-v300",
            "a file of Blender, which is not read as cameras; export its cameras as glTF",
        ),
        ("#usda 1.0\n", "a file of USD"),
        ("PK\u{3}\u{4}", "a ZIP archive"),
        (
            "# timestamp tx ty tz qx qy qz qw\n1.5 0 0 0 0 0 0 1\n",
            "a trajectory as those of TUM",
        ),
        (
            "1 0 0 0 0 1 0 0 0 0 1 0\n",
            "a trajectory as those of KITTI",
        ),
        ("0, 1, 2, 3\n", "a list of poses or numbers"),
        ("", "does not read cameras from a file of this kind"),
        ("words", "does not read cameras from a file of this kind"),
        ("{}", "does not read cameras from a file of this kind"),
        (
            r#"{"width": 8}"#,
            "does not read cameras from a file of this kind",
        ),
        (
            r#"[{"a": 1}]"#,
            "does not read cameras from a file of this kind",
        ),
        ("[1, 2]", "does not read cameras from a file of this kind"),
        ("{", "line 1 column 1"),
        (
            r#"{"width": 8, "height": 8, "fx": 8, "fy": 8}"#,
            "missing field `world_to_camera`",
        ),
    ] {
        let message = load_json(text).expect_err(text).to_string();
        assert!(message.contains(says), "{text}: {message}");
    }
}

/// What a path says of its film.
#[test]
fn a_path_says_its_crop_its_background_and_its_rate() {
    let folder = Folder::new();
    let settings = |more: &str| {
        let text = format!(
            r#"{{"camera_path": [{{"camera_to_world": [], "fov": 1}}, {{"camera_to_world": [], "fov": 1}}], "render_width": 1, "render_height": 1{more}}}"#
        );
        load_path_settings(&folder.file("camera_path.json", text))
    };
    let none = settings(r#", "crop": null"#).expect("a path");
    assert_eq!(none, PathSettings::default());
    assert_eq!(
        settings(r#", "seconds": 4"#).expect("a path").fps,
        Some(0.5)
    );
    assert_eq!(settings(r#", "seconds": 0"#).expect("a path").fps, None);
    let turned = settings(
        r#", "fps": 24, "seconds": 9, "crop": {"crop_center": [1, 2, 3], "crop_scale": [2, 4, 6],
        "crop_rot": [0.3, -0.2, 0.5], "crop_bg_color": {"r": 51, "g": 0, "b": 300}}"#,
    )
    .expect("a path");
    assert_eq!(
        (turned.fps, turned.background),
        (Some(24.0), Some([0.2, 0.0, 1.0]))
    );
    let crop = turned.crop.expect("a box").clip();
    // Roll, pitch and yaw: turns about x, then y, then z.
    let turn =
        DQuat::from_rotation_z(0.5) * DQuat::from_rotation_y(-0.2) * DQuat::from_rotation_x(0.3);
    for (corner, keeps) in [(0.99, true), (1.01, false)] {
        for signs in [DVec3::ONE, DVec3::new(-1.0, 1.0, -1.0), DVec3::NEG_ONE] {
            let inside = turn * (corner * signs * DVec3::new(1.0, 2.0, 3.0));
            assert_eq!(crop.keeps(DVec3::new(1.0, 2.0, 3.0) + inside), keeps);
        }
    }
    let older =
        settings(r#", "crop": {"crop_min": [1, 1, 1], "crop_max": [3, 3, 3]}"#).expect("a path");
    let older = older.crop.expect("a box").clip();
    let kept = [0.9, 1.1, 2.9, 3.1].map(|all| older.keeps(DVec3::splat(all)));
    assert_eq!(kept, [false, true, true, false]);
    for (crop, says) in [
        ("{}", "no crop_center"),
        (
            r#"{"crop_center": [0, 0, 0], "crop_scale": [1, 0, 1]}"#,
            "its crop is not a box",
        ),
    ] {
        let message = settings(&format!(r#", "crop": {crop}"#))
            .unwrap_err()
            .to_string();
        assert!(message.contains(says), "{message}");
    }
    let other = load_path_settings(&folder.file("cameras.json", single()));
    assert_eq!(other.expect("no path"), PathSettings::default());
}

fn single() -> String {
    let matrix = camera().world_to_camera().transpose().to_cols_array();
    format!(
        r#"{{"width": 1000, "height": 600, "fx": 800, "fy": 810, "cx": 500, "cy": 300, "world_to_camera": {}}}"#,
        json(matrix)
    )
}

#[test]
fn one_camera() {
    let folder = Folder::new();
    let path = folder.file("camera.json", single());
    assert_same(&load_camera(&path).unwrap(), &camera());
    let list = load_cameras(&path).unwrap();
    assert_same(&list[0].camera().unwrap(), &camera());
}

#[test]
fn lists_of_our_own_cameras() {
    let named = single().replacen(
        '{',
        r#"{"name": "first", "near_cut": 0.5, "clip_far": 7, "#,
        1,
    );
    let cameras = load_json(&format!("[{named}, {}]", single())).unwrap();
    assert_eq!([cameras[0].name(), cameras[1].name()], ["first", "1"]);
    let given = camera().near_cut(Some(0.5)).clip_far(Some(7.0));
    for (read, given) in cameras.iter().zip([given, camera()]) {
        let read = read.camera().unwrap();
        assert_same(&read, &given);
        let depths = |camera: &Camera| (camera.clip_near, camera.clip_far, camera.near_cut);
        assert_eq!(depths(&read), depths(&given));
    }
    for (more, says) in [
        (
            r#""near_cut": 0"#,
            "camera 1 (`1`): a near cut at a depth of 0",
        ),
        (r#""clip_near": 2, "clip_far": 1"#, "cut away everything"),
        (
            r#""eye": [0, 0, 0]"#,
            "the eye of camera 1 (`1`) is [0, 0, 0], and its world_to_camera puts it at",
        ),
        (r#""width": 0.5"#, "camera 1 (`1`) has the width 0.5"),
    ] {
        let field = more.split(':').next().unwrap();
        let rest = match field {
            r#""width""# => single().replacen(r#""width": 1000, "#, "", 1),
            _ => single(),
        };
        let wrong = rest.replacen('{', &format!("{{{more}, "), 1);
        let error = draw_json(&format!("[{named}, {wrong}]"))
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// Axes that a file has rounded are made square to each other, and those that have all their digits stay as they are.
#[test]
fn an_eye_that_is_said_keeps_all_digits() {
    let camera = camera();
    let whole = json(camera.world_to_camera().transpose().to_cols_array());
    let with_eye = |matrix: &str, eye: DVec3| {
        let eye = json(eye.to_array());
        let text = single().replacen('{', &format!("{{\"eye\": {eye}, "), 1);
        draw_json(&format!("[{}]", text.replace(&whole, matrix))).unwrap()[0]
    };
    let again = with_eye(&whole, camera.eye);
    assert_eq!((again.eye, again.rotation), (camera.eye, camera.rotation));
    let rounded = camera.world_to_camera().transpose().to_cols_array();
    let rounded = rounded.map(|v| (v * 1e6).round() / 1e6);
    let near = with_eye(&json(rounded), camera.eye);
    assert_eq!(near.eye, camera.eye);
    let square = near.rotation * near.rotation.transpose();
    assert!(square.abs_diff_eq(glam::DMat3::IDENTITY, 1e-15), "{square}");
    assert!(near.rotation.abs_diff_eq(camera.rotation, 2e-6));
}

/// Only the cameras that are asked for have to be usable.
#[test]
fn lenses_that_bend_lines_are_named_where_they_are_drawn() {
    let matrix = opengl_matrix();
    let frame = |more: &str| format!(r#"{{{more}"transform_matrix": {matrix}}}"#);
    let fisheye = r#""file_path": "b", "is_fisheye": true, "#;
    let listed = r#""distortion_params": [0, 0, 0, 0, 0.01, 0], "#;
    let frames = [
        frame(""),
        frame(r#""k1": 0.1, "#),
        frame(r#""k6": 1e-9, "#),
        frame(listed),
        frame(fisheye),
        frame(r#""camera_model": "FISHEYE624", "#),
        frame(r#""w": 0, "#),
    ];
    let text = format!(
        r#"{{"w": 1000, "h": 600, "fl_x": 800, "fl_y": 810, "cx": 500, "cy": 300, "frames": [{}]}}"#,
        frames.join(", ")
    );
    let cameras = load_json(&text).unwrap();
    assert_same(&cameras[0].camera().unwrap(), &camera());
    assert_eq!(cameras[0].distortion(), None);
    for (named, lens) in
        cameras[1..6]
            .iter()
            .zip(["OPENCV", "OPENCV", "OPENCV", "OPENCV_FISHEYE", "FISHEYE624"])
    {
        assert_eq!(named.distortion(), Some(lens));
        let message = named.camera().unwrap_err().to_string();
        for says in [named.name(), lens, "cameras.json", "--undistort"] {
            assert!(message.contains(says), "{message}");
        }
        assert_same(&named.undistorted().unwrap(), &camera());
    }
    let message = cameras[6].undistorted().unwrap_err().to_string();
    assert!(message.contains("width 0"), "{message}");
}

/// Numbers that are none of a camera's, and what is made of them.
#[test]
fn rounded_scaled_and_fractional_cameras_are_repaired_and_said() {
    let rotation = camera().rotation;
    let to_world = |scale: f64, digits: i32| {
        let round = |v: f64| (v * 10_f64.powi(digits)).round() / 10_f64.powi(digits);
        rotation
            .transpose()
            .to_cols_array_2d()
            .map(|column| column.map(|v| scale * round(v)))
    };
    let inria = |[x, y, z]: [[f64; 3]; 3]| {
        let rows: Vec<_> = (0..3).map(|i| json([x[i], y[i], z[i]])).collect();
        format!(
            r#"[{{"width": 1000, "height": 600, "position": {}, "rotation": [{}], "fx": 800, "fy": 810}}]"#,
            json(camera().eye.to_array()),
            rows.join(", ")
        )
    };
    let nerfstudio = |[x, y, z]: [[f64; 3]; 3], w: f64, last: &str| {
        let e = camera().eye;
        let row = |i: usize| json([x[i], -y[i], -z[i], e[i]]);
        format!(
            r#"{{"w": {w}, "h": 600, "fl_x": 800, "fl_y": 810, "cx": 500, "cy": 300,
            "frames": [{{"transform_matrix": [{}, {}, {}{last}]}}]}}"#,
            row(0),
            row(1),
            row(2)
        )
    };
    let single = |scale: f64| {
        let matrix = DMat4::from_scale(DVec3::splat(scale)) * camera().world_to_camera();
        format!(
            r#"{{"width": 1000, "height": 600.2, "fx": 800, "fy": 810, "cx": 500, "cy": 300, "world_to_camera": {}}}"#,
            json(matrix.transpose().to_cols_array())
        )
    };
    let exact = to_world(1.0, 15);
    for (text, within, says) in [
        (inria(exact), 1e-9, None),
        (inria(to_world(1.0, 6)), 1e-5, None),
        (inria(to_world(1.0, 4)), 2e-4, Some("made square")),
        (inria(to_world(1.0, 2)), 2e-2, Some("made square")),
        (inria(to_world(7.5, 15)), 1e-9, Some("scales by 7.5")),
        (inria(to_world(0.01, 15)), 1e-9, Some("scales by 0.01")),
        (
            nerfstudio(to_world(3.0, 2), 1000.0, ""),
            2e-2,
            Some("scales by 3.0"),
        ),
        (
            nerfstudio(exact, 1000.0, ", [0, 0, 0, 1.0000001]"),
            1e-6,
            None,
        ),
        (
            nerfstudio(exact, 1000.25, ""),
            1e-9,
            Some("its width of 1000.25 pixels is taken for 1000"),
        ),
        (single(1.0), 1e-9, Some("its height of 600.2")),
        (single(4.0), 1e-9, Some("scales by 4.0")),
    ] {
        let named = &load_json(&text).unwrap()[0];
        let found = named.camera().unwrap();
        assert!(found.eye.abs_diff_eq(camera().eye, within * 4.0), "{text}");
        assert!(
            found.rotation.abs_diff_eq(camera().rotation, within),
            "{text}"
        );
        let square = found.rotation * found.rotation.transpose();
        assert!(square.abs_diff_eq(glam::DMat3::IDENTITY, 1e-14), "{square}");
        assert_eq!((found.width, found.height, found.cx), (1000, 600, 500.0));
        let said = named.repairs().join(", ");
        match says {
            None => assert_eq!(said, ""),
            Some(says) => assert!(said.contains(says), "{said}"),
        }
    }
    let [x, y, z] = exact;
    let mirrored = [x, y, z.map(|v| -v)];
    for skew in [
        mirrored,
        [x, y.map(|v| 2.0 * v), z],
        [x, x, z],
        [[0.0; 3]; 3],
    ] {
        let message = draw_json(&inria(skew)).unwrap_err().to_string();
        assert!(message.contains("not a rotation"), "{message}");
    }
}

/// Without perspective a matrix that scales says how large the picture is.
#[test]
fn a_scaled_orthographic_camera_keeps_its_picture() {
    let matrix = "[2, 0, 0, 2, 0, 2, 0, 4, 0, 0, 2, 6, 0, 0, 0, 1]";
    let text = format!(
        r#"{{"width": 9, "height": 7, "fx": 8, "fy": 8, "projection": "orthographic", "world_to_camera": {matrix}}}"#
    );
    let camera = draw_json(&text).unwrap()[0];
    assert_eq!((camera.fx, camera.fy), (16.0, 16.0));
    assert_eq!(camera.eye, DVec3::new(-1.0, -2.0, -3.0));
}

#[test]
fn unusable_files_are_refused_with_a_sentence() {
    let matrix = opengl_matrix();
    let frame = format!(r#""frames": [{{"transform_matrix": {matrix}}}]"#);
    let inria = inria_entry("a");
    for (text, words) in [
        ("".into(), "does not read cameras"),
        ("[]".into(), "no camera"),
        ("{}".into(), "does not read cameras"),
        ("[1, 2".into(), "line 1"),
        (format!("[{}]", inria.replace("1000", "0")), "width 0"),
        (format!("[{}]", inria.replace("1000", "0.5")), "width 0.5"),
        (format!("[{}]", inria.replace("1000", "16384.5")), "16384.5"),
        (format!("[{}]", inria.replace("800.0", "-1")), "focal"),
        (
            format!(
                "[{}]",
                inria.replace("\"rotation\": [[", "\"rotation\": [[5")
            ),
            "rotation",
        ),
        (format!(r#"{{"fl_x": 5, {frame}}}"#), "no `w`"),
        (format!(r#"{{"w": 5, "h": 5, {frame}}}"#), "camera_angle_x"),
        (
            format!(r#"{{"w": 5, "h": 5, "fl_x": 5, "k1": 0.1, {frame}}}"#),
            "frame 0 (`0`) has the lens OPENCV, which bends straight lines",
        ),
        (
            format!(r#"{{"w": 5, "h": 5, "fl_x": 5, "camera_model": "OPENCV_FISHEYE", {frame}}}"#),
            "the lens OPENCV_FISHEYE",
        ),
        (
            format!(r#"{{"w": 5, "h": 5, "fl_x": 5, "camera_model": "VR180_L", {frame}}}"#),
            "VR180_L, which has no pinhole",
        ),
        (
            r#"{"w": 5, "h": 5, "fl_x": 5, "frames": [{"transform_matrix": [[1, 0, 0, 0]]}]}"#
                .into(),
            "4x4",
        ),
    ] {
        let message = draw_json(&text).unwrap_err().to_string();
        assert!(
            message.contains(words) && message.contains("cameras.json"),
            "{message:?} lacks {words:?}"
        );
    }
    let folder = Folder::new();
    let transposed = folder.file(
        "c.json",
        single().replace("0.0, 0.0, 0.0, 1.0]", "1.0, 0.0, 0.0, 1.0]"),
    );
    assert!(
        load_camera(&transposed)
            .unwrap_err()
            .to_string()
            .contains("last row")
    );
    assert!(
        load_cameras(&folder.0)
            .unwrap_err()
            .to_string()
            .contains("COLMAP")
    );
    assert!(load_cameras(Path::new("no/such.json")).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_colmap_models_never_panic(
        which in any::<bool>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (mut cameras, mut images) = colmap_binary();
        for (at, byte) in edits {
            let bytes = if which { &mut cameras } else { &mut images };
            let at = at.index(bytes.len().min(300));
            bytes[at] = byte;
        }
        let folder = Folder::new();
        folder.file("cameras.bin", cameras);
        folder.file("images.bin", images);
        let _ = load_cameras(&folder.0);
    }

    #[test]
    fn mutated_json_never_panics(
        which in 0..3_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0x20..0x7f_u8), 1..5),
    ) {
        let frame = opengl_matrix();
        let mut text = match which {
            0 => format!("[{}]", inria_entry("a")),
            1 => format!(r#"{{"w": 9, "h": 9, "fl_x": 9, "frames": [{{"transform_matrix": {frame}}}]}}"#),
            _ => single(),
        }
        .into_bytes();
        for (at, byte) in edits {
            let at = at.index(text.len());
            text[at] = byte;
        }
        let _ = load_json(std::str::from_utf8(&text).unwrap());
    }
}

#[test]
fn collected_orbits() {
    let root = std::env::var_os("RARA_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let mut found = 0;
    for folder in ["general", "hair", "medical"] {
        let Ok(entries) = std::fs::read_dir(root.join("data").join(folder)) else {
            eprintln!(
                "SKIPPED: {} has no data/{folder} (set RARA_SHARED)",
                root.display()
            );
            return;
        };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.to_string_lossy().ends_with(".cameras.json") {
                assert_eq!(load_cameras(&path).unwrap().len(), 12);
                found += 1;
            }
        }
    }
    assert!(found > 0);
}
