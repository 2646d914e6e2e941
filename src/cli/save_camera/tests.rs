use super::*;
use glam::{DMat3, DQuat, DVec3};
use rara::{Camera, Projection, camera_files};
use std::path::Path;

fn read(text: &str) -> Camera {
    camera_files::camera_from_json(text.as_bytes(), Path::new("f")).expect("a camera")
}

/// Cameras whose numbers have no short decimals, and whose axes are square to each other but for rounding.
fn cameras() -> Vec<Camera> {
    let camera = |n: u32| {
        let n = f64::from(n);
        let eye = DVec3::new(n / 7.0, -1e3 / (n + 3.0), 1e-7 * n - 4.0);
        let turn = DQuat::from_scaled_axis(DVec3::new(n.sin(), n / 3.0, (n * n).cos()));
        let camera = Camera::look_at(eye, DVec3::ONE / 3.0, DVec3::NEG_Y, 47.0, (97, 64));
        let camera = camera.expect("a view");
        let rotation = DMat3::from_quat(turn) * camera.rotation;
        camera.rotation(rotation).cx(48.5 + n / 9.0)
    };
    (0..200).map(camera).collect()
}

#[test]
fn a_camera_comes_back_to_the_last_bit() {
    for camera in cameras() {
        let flat = camera.projection(Projection::Orthographic).fx(1.0 / 3.0);
        let cut = camera
            .clip_near(Some(-0.1))
            .clip_far(Some(1.0 / 3.0))
            .near_cut(Some(1e-3));
        for camera in [camera, flat, cut] {
            assert_eq!(read(&text(&SavedCamera::from(&camera))), camera);
        }
    }
}

#[test]
fn several_are_a_list_with_names() {
    let folder = std::env::temp_dir().join(format!("rara-cameras-{}", std::process::id()));
    let file = folder.join("made/cameras.json");
    let views: Vec<NamedView> = cameras()
        .into_iter()
        .take(3)
        .enumerate()
        .map(|(number, camera)| NamedView {
            number,
            name: format!("picture {number}"),
            camera,
        })
        .collect();
    let save = |save_camera| SaveCameraArgs { save_camera };
    save(None).save(views.iter()).expect("nothing is written");
    assert!(!folder.exists());
    save(Some(file.clone())).save(views.iter()).expect("writes");
    let again = camera_files::load_cameras(&file).expect("cameras");
    assert_eq!(again.len(), 3);
    for (again, view) in again.iter().zip(&views) {
        let camera = again.camera().expect("a pinhole");
        assert_eq!((again.name(), camera), (&*view.name, view.camera));
    }
    save(Some(file.clone()))
        .save(views[..1].iter())
        .expect("writes");
    let one = camera_files::load_camera(&file).expect("a camera");
    assert_eq!(one, views[0].camera);
    std::fs::remove_dir_all(&folder).expect("ours");
}
