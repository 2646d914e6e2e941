//! Reading COLMAP's models: both encodings give the same cameras, and bad ones a sentence.

use std::path::Path;

use glam::DVec3;
use rara::Camera;
use rara::camera_files::{NamedCamera, load_cameras, load_colmap_points};

use super::cameras::{Folder, assert_same, camera};

/// One picture of `images.bin`.
fn image_record(name: &str, camera_id: u32, points: u64) -> Vec<u8> {
    let matrix = camera().world_to_camera();
    let (_, q, t) = matrix.to_scale_rotation_translation();
    let mut bytes = 7_u32.to_le_bytes().to_vec();
    for number in [q.w, q.x, q.y, q.z, t.x, t.y, t.z] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(camera_id.to_le_bytes());
    bytes.extend(name.as_bytes());
    bytes.push(0);
    bytes.extend(points.to_le_bytes());
    bytes.extend(vec![9; 24 * points as usize]);
    bytes
}

pub(super) fn colmap_binary() -> (Vec<u8>, Vec<u8>) {
    let mut cameras = 2_u64.to_le_bytes().to_vec();
    let lenses: [(u32, i32, &[f64]); 2] = [
        (3, 1, &[800.0, 810.0, 500.0, 300.0]),
        (5, 2, &[800.0, 500.0, 300.0, 0.0]),
    ];
    for (id, model, parameters) in lenses {
        cameras.extend(id.to_le_bytes());
        cameras.extend(model.to_le_bytes());
        cameras.extend(1000_u64.to_le_bytes());
        cameras.extend(600_u64.to_le_bytes());
        parameters
            .iter()
            .for_each(|p| cameras.extend(p.to_le_bytes()));
    }
    let images = [
        2_u64.to_le_bytes().to_vec(),
        image_record("b.png", 5, 1000),
        image_record("a.png", 3, 0),
    ]
    .concat();
    (cameras, images)
}

#[test]
fn colmap_folders_binary_and_text() {
    let folder = Folder::new();
    let (cameras, images) = colmap_binary();
    folder.file("sparse/0/cameras.bin", cameras);
    let file = folder.file("sparse/0/images.bin", images);
    let text = Folder::new();
    text.file(
        "cameras.txt",
        "# comment\n3 PINHOLE 1000 600 800 810 500 300\n5 SIMPLE_RADIAL 1000 600 800 500 300 0\n",
    );
    let (_, q, t) = camera().world_to_camera().to_scale_rotation_translation();
    let pose = format!("{} {} {} {} {} {} {}", q.w, q.x, q.y, q.z, t.x, t.y, t.z);
    text.file(
        "images.txt",
        format!("# comment\n1 {pose} 5 b.png\n1 2 -1 3 4 7\n2 {pose} 3 a.png\n\n"),
    );
    for path in [&folder.0, &folder.0.join("sparse"), &file, &text.0] {
        let cameras = load_cameras(path).unwrap();
        assert_eq!([cameras[0].name(), cameras[1].name()], ["a.png", "b.png"]);
        assert_same(&cameras[0].camera().unwrap(), &camera());
        assert_eq!(cameras[1].camera().unwrap().fy, 800.0);
    }
}

/// A picture's line of points may be empty or missing, and what is no line of either is refused.
#[test]
fn text_with_and_without_lines_of_points_has_all_pictures() {
    let folder = Folder::new();
    folder.file("cameras.txt", "1 PINHOLE 9 7 8 8 4 3\n");
    let pose = "1 0 0 0 0 0 1 1";
    let names = |text: &str| -> rara::Result<Vec<String>> {
        folder.file("images.txt", text);
        let cameras = load_cameras(&folder.0)?;
        Ok(cameras.iter().map(|one| one.name().to_owned()).collect())
    };
    for between in [
        "",
        "\n",
        "\n# c\n",
        "\r\n",
        "1 2 -1\n",
        "1 2 -1 3.5 4e0 7\n\n",
    ] {
        // Names may be numbers, or several words.
        let text: Vec<_> = ["a.jpg", "b 2 3.jpg", "4", "d"]
            .iter()
            .enumerate()
            .map(|(id, name)| format!("{id} {pose} {name}\n{between}"))
            .collect();
        let found = names(&text.concat()).expect("pictures");
        assert_eq!(found, ["4", "a.jpg", "b 2 3.jpg", "d"], "{between:?}");
    }
    for (points, line) in [
        ("1 2\n", 2),
        ("1 2 -1\n3 4 -1\n", 3),
        ("1 2 x\n", 2),
        ("x\n", 2),
    ] {
        let error = names(&format!("1 {pose} a\n{points}2 {pose} b\n"))
            .expect_err(points)
            .to_string();
        assert!(
            error.contains(&format!("line {line}: this is neither")),
            "{error}"
        );
    }
}

#[test]
fn points_of_either_encoding() {
    let points = [DVec3::new(1.5, -2.0, 3.0), DVec3::new(-0.25, 0.0, 1e3)];
    let (text, binary) = (Folder::new(), Folder::new());
    let mut lines = String::from("# c\n");
    let mut bytes = 2_u64.to_le_bytes().to_vec();
    for (id, p) in points.iter().enumerate() {
        lines += &format!("{id} {} {} {} 1 2 3 0.5 1 0 2 7\n", p.x, p.y, p.z);
        bytes.extend((id as u64).to_le_bytes());
        p.to_array()
            .iter()
            .for_each(|v| bytes.extend(v.to_le_bytes()));
        bytes.extend([9; 11]);
        bytes.extend(2_u64.to_le_bytes());
        bytes.extend([7; 16]);
    }
    text.file("cameras.txt", "");
    text.file("points3D.txt", lines);
    binary.file("sparse/0/cameras.bin", "");
    let at = binary.file("sparse/0/points3D.bin", &bytes);
    for folder in [&text.0, &binary.0, &at] {
        let read = load_colmap_points(folder).expect("points");
        assert_eq!(read.as_deref(), Some(&points[..]));
    }
    assert_eq!(
        load_colmap_points(&text.file("cameras.json", "")).expect("others"),
        None
    );
    for end in 0..bytes.len() {
        std::fs::write(&at, &bytes[..end]).unwrap();
        let error = load_colmap_points(&at).unwrap_err().to_string();
        assert!(error.contains("cut off"), "{error}");
    }
    text.file("points3D.txt", "1 2 3\n");
    let error = load_colmap_points(&text.0).unwrap_err().to_string();
    assert!(error.contains("line 1: this is not `POINT3D_ID"), "{error}");
}

/// All of the cameras, as they are drawn.
fn draw(folder: &Path) -> rara::Result<Vec<Camera>> {
    load_cameras(folder)?
        .iter()
        .map(NamedCamera::camera)
        .collect()
}

/// The parameters of a camera of each model, after the focal lengths and the principal point.
const LENSES: [(&str, &str); 17] = [
    ("SIMPLE_PINHOLE", ""),
    ("PINHOLE", ""),
    ("SIMPLE_RADIAL", "0.1"),
    ("RADIAL", "0.1 0"),
    ("OPENCV", "0 0 0.001 0"),
    ("OPENCV_FISHEYE", "0 0 0 0"),
    ("FULL_OPENCV", "0 0 0 0 0 0 0 0.1"),
    ("FOV", "0.9"),
    ("SIMPLE_RADIAL_FISHEYE", "0"),
    ("RADIAL_FISHEYE", "0 0"),
    ("THIN_PRISM_FISHEYE", "0 0 0 0 0 0 0 0"),
    ("RAD_TAN_THIN_PRISM_FISHEYE", "0 0 0 0 0 0 0 0 0 0 0 0"),
    ("SIMPLE_DIVISION", "-0.3"),
    ("DIVISION", "-0.3"),
    ("SIMPLE_FISHEYE", ""),
    ("FISHEYE", ""),
    ("EUCM", "0.6 1.1"),
];

#[test]
fn lenses_of_every_model_of_colmap() {
    let folder = Folder::new();
    let mut cameras = String::from("# comment\n");
    let mut images = String::new();
    let mut binary = (LENSES.len() as u64).to_le_bytes().to_vec();
    for (number, (name, rest)) in LENSES.iter().enumerate() {
        let focal = match name.contains("SIMPLE") || name.starts_with("RADIAL") {
            true => "8",
            false => "8 8",
        };
        cameras += &format!("{number} {name} 9.0 7 {focal} 4 3 {rest}\n");
        images += &format!("1 1 0 0 0 0 0 0 {number} {number:02}\n\n");
        binary.extend((number as u32).to_le_bytes());
        binary.extend((number as i32).to_le_bytes());
        binary.extend([9_u64, 7].map(u64::to_le_bytes).concat());
        let parameters = format!("{focal} 4 3 {rest}");
        let parameters = parameters
            .split_whitespace()
            .map(|p| p.parse::<f64>().unwrap());
        parameters.for_each(|p| binary.extend(p.to_le_bytes()));
    }
    folder.file("cameras.txt", &cameras);
    folder.file("images.txt", &images);
    let named = load_cameras(&folder.0).unwrap();
    for (number, (one, (name, _))) in named.iter().zip(LENSES).enumerate() {
        let is_pinhole = number < 2;
        assert_eq!(one.distortion(), (!is_pinhole).then_some(name));
        assert_eq!(one.undistorted().unwrap(), named[1].camera().unwrap());
        let Err(error) = one.camera() else {
            assert!(is_pinhole, "{name}");
            continue;
        };
        let camera = format!("the picture `{number:02}` (camera {number} of cameras.txt)");
        for says in [&camera, name, "images.txt", "--undistort"] {
            assert!(error.to_string().contains(says), "{error}");
        }
    }
    folder.file("cameras.bin", &binary);
    let of_binary = load_cameras(&folder.0).unwrap();
    for (a, b) in named.iter().zip(&of_binary) {
        assert_eq!(a.undistorted().unwrap(), b.undistorted().unwrap());
        assert_eq!(a.distortion(), b.distortion());
    }
    let text = |lens: &str| {
        folder.file("cameras.txt", lens);
        std::fs::remove_file(folder.0.join("cameras.bin")).unwrap_or_default();
        folder.file("images.txt", "1 2 0 0 0 0 0 0 1 a\n\n");
        load_cameras(&folder.0).unwrap().remove(0)
    };
    // No distortion is none, whatever the model could say.
    for lens in [
        "OPENCV 9 7 8 8 4 3 0 0 -0 0",
        "FOV 9 7 8 8 4 3 0",
        "DIVISION 9 7 8 8 4 3 0",
    ] {
        assert_eq!(text(&format!("1 {lens}")).distortion(), None, "{lens}");
    }
    let rounded = text("1 PINHOLE 9.5 7 8 8 4 3");
    assert_eq!(rounded.camera().unwrap().width, 10);
    let said = rounded.repairs().join("; ");
    assert!(
        said.contains("9.5 pixels") && said.contains("quaternion is 2"),
        "{said}"
    );
}

/// Models that nobody knows do not keep others of the file from being drawn.
#[test]
fn cameras_beside_one_of_an_unknown_model() {
    let folder = Folder::new();
    folder.file(
        "cameras.txt",
        "1 PINHOLE 9 7 8 8 4 3\n2 SPHERICAL 9 7 9 7\n3 PINHOLE 9 7 8 8 4 3\n",
    );
    let images = "1 1 0 0 0 0 0 0 1 a\n\n2 1 0 0 0 0 0 0 2 b\n\n3 1 0 0 0 0 0 0 3 c\n\n";
    folder.file("images.txt", images);
    let named = load_cameras(&folder.0).unwrap();
    assert!(named[0].camera().is_ok() && named[2].camera().is_ok());
    for outcome in [named[1].camera(), named[1].undistorted()] {
        let message = outcome.unwrap_err().to_string();
        assert!(
            message
                .contains("`b` was taken with camera 2 of the model SPHERICAL, which is not known")
        );
    }
    // In binary no one knows where the next one begins.
    let (mut cameras, pinhole) = (3_u64.to_le_bytes().to_vec(), [8.0_f64, 8.0, 4.0, 3.0]);
    for (id, model, parameters) in [
        (1_u32, 1_i32, &pinhole[..]),
        (2, 99, &[9.0, 7.0]),
        (3, 1, &pinhole),
    ] {
        cameras.extend(id.to_le_bytes());
        cameras.extend(model.to_le_bytes());
        cameras.extend([9_u64, 7].map(u64::to_le_bytes).concat());
        parameters
            .iter()
            .for_each(|p| cameras.extend(p.to_le_bytes()));
    }
    folder.file("cameras.bin", cameras);
    let named = load_cameras(&folder.0).unwrap();
    assert!(named[0].camera().is_ok());
    for (one, says) in [
        (&named[1], "camera 2 of the model 99, which is not known"),
        (&named[2], "stands behind camera 2 of the unknown model 99"),
    ] {
        let message = one.undistorted().unwrap_err().to_string();
        assert!(message.contains(says), "{message}");
    }
}

#[test]
fn unusable_colmap_models_are_refused() {
    let refused = |cameras: &[u8], images: &[u8]| {
        let folder = Folder::new();
        folder.file("cameras.bin", cameras);
        folder.file("images.bin", images);
        draw(&folder.0).unwrap_err().to_string()
    };
    let (cameras, images) = colmap_binary();
    let with = |at: usize, bytes: &[u8]| {
        let mut cameras = cameras.clone();
        cameras[at..at + bytes.len()].copy_from_slice(bytes);
        cameras
    };
    assert!(refused(&with(0, &u64::MAX.to_le_bytes()), &images).contains("promises"));
    assert!(
        refused(&with(12, &99_i32.to_le_bytes()), &images)
            .contains("the model 99, which is not known")
    );
    let last = cameras.len() - 8;
    assert!(refused(&with(last, &0.1_f64.to_le_bytes()), &images).contains("SIMPLE_RADIAL"));
    assert!(refused(&with(8, &77_u32.to_le_bytes()), &images).contains("camera 3"));
    assert!(
        refused(
            &cameras,
            &[&u64::MAX.to_le_bytes()[..], &images[8..]].concat()
        )
        .contains("promises")
    );
    let endless = [1_u64.to_le_bytes().to_vec(), image_record("a", 3, 0)].concat();
    let endless = [&endless[..endless.len() - 8], &u64::MAX.to_le_bytes()].concat();
    assert!(refused(&cameras, &endless).contains("cut off"));
    for cut in 1..images.len().min(200) {
        refused(&cameras, &images[..images.len() - cut]);
    }
}
