use super::*;
use crate::camera::CameraArgs;
use crate::views::Views;
use clap::{Args as _, FromArgMatches as _};
use glam::DVec3;

fn meant(flags: &str) -> Camera {
    let command = clap::Command::new("rara").no_binary_name(true);
    let command = CameraArgs::augment_args(command);
    let matches = command.try_get_matches_from(flags.split(' ')).unwrap();
    let args = CameraArgs::from_arg_matches(&matches).unwrap();
    match args.meant(&[]).unwrap() {
        Views::Given(views) => views[0].camera,
        Views::Framed { .. } | Views::Round(..) => panic!("{flags}: no camera"),
    }
}

#[test]
fn flags_place_the_same_camera() {
    for eye in [
        DVec3::new(1.0, -2.0, -3.5),
        DVec3::ZERO,
        DVec3::new(1e6, -2e5, 3e6) / 7.0,
    ] {
        let target = eye + DVec3::new(-0.3, 0.7, 2.0);
        let camera = Camera::look_at(eye, target, DVec3::NEG_Y, 40.0, (80, 60)).unwrap();
        let flat = camera.projection(Projection::Orthographic);
        for camera in [camera, flat.fx(17.0).fy(17.0)] {
            let again = meant(&flags(&camera).expect("it has flags"));
            let rotation = (again.rotation - camera.rotation).to_cols_array();
            assert!(rotation.iter().all(|v| v.abs() < 1e-14), "{rotation:?}");
            assert!((again.fy / camera.fy - 1.0).abs() < 1e-14);
            assert_eq!(
                (again.eye, again.projection),
                (camera.eye, camera.projection)
            );
            assert_eq!((again.width, again.height), (80, 60));
        }
    }
}

#[test]
fn what_only_a_file_can_say_has_no_flags_but_those_of_its_planes() {
    let camera = Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::NEG_Y, 40.0, (80, 60)).unwrap();
    assert!(planes(&camera).is_empty());
    let between = camera.clip_near(Some(-0.1)).clip_far(Some(1.0 / 3.0));
    for odd in [between.cx(41.0), between.fx(30.0)] {
        assert_eq!(flags(&odd), None);
        let said = [
            "--clip-near -0.1".to_owned(),
            format!("--clip-far {}", 1.0 / 3.0),
        ];
        assert_eq!(planes(&odd), said);
    }
}
