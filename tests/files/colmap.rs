//! Reading COLMAP's models: both encodings give the same cameras, and bad ones a sentence.

use rara::camera_files::load_cameras;

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
        assert_eq!([&cameras[0].name, &cameras[1].name], ["a.png", "b.png"]);
        assert_same(&cameras[0].camera, &camera());
        assert_eq!(cameras[1].camera.fy, 800.0);
    }
}

#[test]
fn unusable_colmap_models_are_refused() {
    let refused = |cameras: &[u8], images: &[u8]| {
        let folder = Folder::new();
        folder.file("cameras.bin", cameras);
        folder.file("images.bin", images);
        load_cameras(&folder.0).unwrap_err().to_string()
    };
    let (cameras, images) = colmap_binary();
    let with = |at: usize, bytes: &[u8]| {
        let mut cameras = cameras.clone();
        cameras[at..at + bytes.len()].copy_from_slice(bytes);
        cameras
    };
    assert!(refused(&with(0, &u64::MAX.to_le_bytes()), &images).contains("promises"));
    assert!(refused(&with(12, &99_i32.to_le_bytes()), &images).contains("unknown model 99"));
    let last = cameras.len() - 8;
    assert!(refused(&with(last, &0.1_f64.to_le_bytes()), &images).contains("distortion"));
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
