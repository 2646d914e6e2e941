//! Mistakes that a host can make without a device: impossible arguments, and structs of other versions.

pub(crate) mod nulls;
mod versions;

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use crate::boundary::*;
use crate::camera::*;
use crate::camera_files::*;
use crate::gaussians::*;
use crate::load::*;
use crate::placement::*;
use crate::settings::*;
use crate::upload::*;
use rara::{Precision, Settings};

pub(crate) fn message() -> String {
    // SAFETY: a string of this thread, which is copied before its next call.
    let text = unsafe { CStr::from_ptr(rara_last_error_message()) };
    text.to_str().expect("UTF-8").to_owned()
}

#[track_caller]
pub(crate) fn assert_fails(result: RaraResult, code: RaraResult, part: &str) {
    let message = message();
    assert!(!message.contains("::"), "a name of Rust's: {message}");
    assert!(
        result == code && message.contains(part),
        "{result}: {message}"
    );
}

#[test]
fn messages_are_a_threads_own() {
    assert_eq!(message(), "");
    std::thread::spawn(|| {
        let failed = guard(|| invalid("another thread's\0, with a NUL"));
        assert_fails(failed, RARA_ERROR_INVALID, "another thread's\u{fffd}, with");
    })
    .join()
    .expect("no panic");
    assert_eq!(message(), "");
    assert_eq!(rara_abi_version(), RARA_ABI_VERSION);
}

#[test]
fn errors_have_codes_of_their_own() {
    let lost = || rara::Error::DeviceLost {
        call: "vkQueueSubmit2",
    };
    assert_fails(guard(|| Err(lost())), RARA_ERROR_DEVICE_LOST, "was lost");
    let refused = guard(|| Err(rara::Error::Device("too old".into())));
    assert_fails(refused, RARA_ERROR_DEVICE, "too old");
    let full = guard(|| Err(rara::Error::Memory("full".into())));
    assert_fails(full, RARA_ERROR_MEMORY, "full");
}

#[test]
fn structs_of_other_versions() {
    let preset = RARA_PRESET_FAST;
    // SAFETY: the struct has the room that the call is given; it may hold any bytes.
    unsafe {
        let mut settings: RaraSettings = std::mem::zeroed();
        // An older host, whose struct ended after `miss`.
        let older = std::mem::offset_of!(RaraSettings, trace_all);
        settings.trace_all = 77;
        assert_eq!(rara_settings_default(&mut settings, older, preset), RARA_OK);
        assert_eq!(
            (settings.struct_size, settings.trace_all),
            (older, 77),
            "left alone"
        );
        settings.mode = RARA_MODE_HARD;
        let read = crate::settings::settings(&settings).expect("is filled up");
        assert_eq!(read.mode, rara::Mode::Hard);
        assert!(!read.trace_all, "the default");
        // A newer one.
        settings.struct_size = size_of::<RaraSettings>() + 8;
        let error = crate::settings::settings(&settings).expect_err("is not understood");
        assert!(
            error.to_string().contains("settings->struct_size is "),
            "{error}"
        );
        settings.struct_size = 0;
        assert!(
            crate::settings::settings(&settings).is_err(),
            "never filled"
        );
        let nothing = rara_settings_default(&mut settings, 3, preset);
        assert_fails(nothing, RARA_ERROR_INVALID, "sizeof(RaraSettings)");
        let size = size_of::<RaraSettings>();
        assert_fails(
            rara_settings_default(&mut settings, size, 9),
            RARA_ERROR_INVALID,
            "preset 9",
        );
        assert_eq!(
            rara_settings_default(&mut settings, size, RARA_PRESET_BALANCED),
            RARA_OK
        );
        let read = crate::settings::settings(&settings).expect("the defaults");
        assert_eq!(read, rara::Settings::default());
        settings.raster = 12;
        let error = crate::settings::settings(&settings).expect_err("no raster");
        assert_eq!(error.to_string(), "settings->raster 12 is no RaraRaster");
    }
}

#[test]
fn structs_of_no_version() {
    #[repr(C)]
    struct Room {
        settings: RaraSettings,
        behind: [u8; 16],
    }
    let ours = size_of::<RaraSettings>();
    let first = size_of::<usize>();
    // SAFETY: the struct has room for all of these sizes; it may hold any bytes.
    unsafe {
        let mut room: Room = std::mem::zeroed();
        for size in [0, 1, first - 1, first + 1, ours - 1, ours + 1, ours + 7] {
            room.settings = RaraSettings::new(rara::Preset::Balanced);
            room.settings.struct_size = size;
            let error = crate::settings::settings(&room.settings).expect_err("no version");
            let text = error.to_string();
            assert!(text.contains(&format!("struct_size is {size},")), "{text}");
            room.settings.struct_size = 77;
            let written = rara_settings_default(&mut room.settings, size, RARA_PRESET_FAST);
            assert_fails(written, RARA_ERROR_INVALID, &format!("of {size} bytes"));
            assert_eq!(room.settings.struct_size, 77, "left alone");
        }
        // A newer host's larger struct is filled as far as this library knows it, and cannot be read.
        room.behind = [7; 16];
        let written = rara_settings_default(&mut room.settings, ours + 8, RARA_PRESET_FAST);
        assert_eq!(written, RARA_OK);
        assert_eq!((room.settings.struct_size, room.behind), (ours, [7; 16]));
        room.settings.struct_size = ours + 8;
        assert!(crate::settings::settings(&room.settings).is_err());
        room.settings.struct_size = ours;
        assert!(crate::settings::settings(&room.settings).is_ok());
    }
}

#[test]
fn cameras() {
    let (eye, target, up) = ([1.0, -2.0, -5.0], [0.0; 3], [0.0, -1.0, 0.0]);
    // SAFETY: three numbers each; the struct may hold any bytes.
    unsafe {
        let mut camera: RaraCamera = std::mem::zeroed();
        let look = |eye: &[f64; 3], width, camera: &mut RaraCamera| {
            rara_camera_look_at(
                eye.as_ptr(),
                target.as_ptr(),
                up.as_ptr(),
                50.0,
                width,
                60,
                camera,
                size_of::<RaraCamera>(),
            )
        };
        assert_fails(
            look(&target, 90, &mut camera),
            RARA_ERROR_INVALID,
            "the same point",
        );
        assert_fails(look(&eye, 0, &mut camera), RARA_ERROR_INVALID, "0x60");
        assert_eq!(look(&eye, 90, &mut camera), RARA_OK);
        let (from, to) = (eye.into(), target.into());
        let made = rara::Camera::look_at(from, to, up.into(), 50.0, (90, 60)).expect("a view");
        assert_eq!(camera.camera().expect("a camera"), made, "to the last bit");
        let matrix = made.world_to_camera().transpose().to_cols_array();
        let mut again: RaraCamera = std::mem::zeroed();
        let result = rara_camera_from_world_to_camera(
            matrix.as_ptr(),
            made.fx,
            made.fy,
            made.cx,
            made.cy,
            90,
            60,
            &mut again,
            size_of::<RaraCamera>(),
        );
        assert_eq!(result, RARA_OK);
        assert!(again.camera().expect("a camera").eye.distance(made.eye) < 1e-12);
        camera.rotation[4] = 7.0;
        assert!(camera.camera().is_err(), "no rotation");
        let nan = RaraCamera {
            eye: [f64::NAN; 3],
            ..again
        };
        assert!(nan.camera().is_err(), "nowhere");
        let flat = RaraCamera {
            projection: RARA_PROJECTION_ORTHOGRAPHIC,
            clip_near: 1.5,
            clip_far: 9.0,
            near_cut: -1.0,
            ..again
        };
        let made = flat.camera().expect("a camera");
        assert_eq!(made.projection, rara::Projection::Orthographic);
        let planes = (made.clip_near, made.clip_far, made.near_cut);
        assert_eq!(planes, (Some(1.5), Some(9.0), Some(-1.0)));
        assert_eq!(RaraCamera::from(made), flat);
        for (wrong, says) in [
            (
                RaraCamera {
                    projection: 2,
                    ..flat
                },
                "projection 2 is no RaraProjection",
            ),
            (
                RaraCamera {
                    clip_far: f64::NAN,
                    ..flat
                },
                "camera->clip_far is NaN",
            ),
            (
                RaraCamera {
                    clip_near: f64::INFINITY,
                    ..flat
                },
                "camera->clip_near is inf",
            ),
        ] {
            let error = wrong.camera().expect_err(says).to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}

#[test]
fn scenes() {
    let mut scene = null_mut();
    // SAFETY: strings that end in NUL, bytes that are there, a pointer that is overwritten, handles that are alive.
    unsafe {
        let result = rara_gaussians_load(c"no/such.ply".as_ptr(), null(), 0, &mut scene);
        assert_fails(result, RARA_ERROR_IO, "no/such.ply");
        assert!(scene.is_null());
        let load = |bytes: &[u8], scene: *mut *mut RaraGaussians| {
            rara_gaussians_load_from(
                bytes.as_ptr(),
                bytes.len(),
                c"entry".as_ptr(),
                null(),
                0,
                scene,
            )
        };
        assert_fails(load(b"nonsense", &mut scene), RARA_ERROR_FORMAT, "entry: ");
        assert_fails(load(b"", &mut scene), RARA_ERROR_FORMAT, "entry: ");
        let nothing = rara_gaussians_load_from(null(), 9, c"entry".as_ptr(), null(), 0, &mut scene);
        assert_fails(nothing, RARA_ERROR_INVALID, "data is null");

        let made = rara::scene::generate(rara::scene::Kind::General, 50, 1);
        let path = std::env::temp_dir().join(format!("rara-c-{}.ply", std::process::id()));
        rara::scene::save_ply(&path, &made).expect("a temporary file");
        let name = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
        let mut other = null_mut();
        assert_eq!(
            rara_gaussians_load(name.as_ptr(), null(), 0, &mut scene),
            RARA_OK
        );
        assert_eq!(
            load(&std::fs::read(&path).expect("reads"), &mut other),
            RARA_OK
        );
        std::fs::remove_file(&path).expect("is there");
        assert_eq!(rara_gaussians_append(scene, other), RARA_OK);
        assert_fails(
            rara_gaussians_append(scene, scene),
            RARA_ERROR_INVALID,
            "the same",
        );
        let mut info: RaraGaussiansInfo = std::mem::zeroed();
        let size = size_of_val(&info);
        assert_eq!(rara_gaussians_info(scene, &mut info, size), RARA_OK);
        assert_eq!(
            (info.struct_size, info.count, info.sh_degree),
            (size, 100, made.sh_degree())
        );
        assert!(info.bounds_min[0] < info.bounds_max[0]);
        // The file says nothing of it.
        assert_eq!(info.antialiased, 0);
        assert_eq!(rara_gaussians_set_antialiased(scene, 1), RARA_OK);
        assert_eq!(rara_gaussians_info(scene, &mut info, size), RARA_OK);
        assert_eq!((info.antialiased, info.low_pass), (1, 0.3));
        assert_eq!(rara_gaussians_set_low_pass(scene, 0.1), RARA_OK);
        assert_eq!(rara_gaussians_set_low_pass(scene, 0.0), RARA_ERROR_INVALID);
        let mut camera: RaraCamera = std::mem::zeroed();
        let framed = rara_camera_frame(
            scene,
            [0.0, -1.0, 0.0].as_ptr(),
            50.0,
            90,
            60,
            &mut camera,
            size_of::<RaraCamera>(),
        );
        assert_eq!(framed, RARA_OK);
        assert!(camera.camera().is_ok());
        let upload = rara_scene_buffers_upload(null(), null(), 1, 0, &mut null_mut());
        assert_fails(upload, RARA_ERROR_INVALID, "device is null");
        rara_gaussians_destroy(scene);
        rara_gaussians_destroy(other);
    }
}

#[test]
fn placements() {
    let given = RaraPlacement {
        position: [4.0, -1.0, 2.5],
        rotation: [0.3, -0.5, 0.2, 0.9],
        scale: 0.35,
    };
    let turn = rara::glam::DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9);
    let made = rara::Placement::new(given.position.into(), turn, 0.35).expect("finite numbers");
    assert_eq!(given.placement().expect("the same"), made);
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(RaraPlacement { scale, ..given }.placement().is_err());
    }
    let (position, rotation) = ([f64::NAN; 3], [0.0; 4]);
    assert!(RaraPlacement { position, ..given }.placement().is_err());
    let error = RaraPlacement { rotation, ..given }.placement();
    let text = error.expect_err("no rotation").to_string();
    assert!(text.contains("its rotation cannot be zero"), "{text}");
}

#[test]
fn lenses_that_bend_lines() {
    let folder = std::env::temp_dir().join(format!("rara-c-lens-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let put = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    put(
        "cameras.txt",
        "1 PINHOLE 9 7 8 8 4 3\n2 OPENCV_FISHEYE 9 7 8 8 4 3 .1 0 0 0\n",
    );
    put(
        "images.txt",
        "1 1 0 0 0 0 0 0 1 a\n\n2 1 0 0 0 0 0 0 2 b\n\n",
    );
    let path = CString::new(folder.to_str().expect("UTF-8")).expect("no NUL");
    // SAFETY: strings that end in NUL, and as much room as the count says.
    unsafe {
        let size = size_of::<RaraCamera>();
        let (mut cameras, mut one): ([RaraCamera; 2], RaraCamera) = std::mem::zeroed();
        let (mut count, room) = (2, cameras.as_mut_ptr());
        let result = rara_cameras_load(path.as_ptr(), room, size, null_mut(), &mut count);
        assert_eq!((result, count), (RARA_OK, 2));
        assert_eq!([cameras[0].width, cameras[1].width], [9, 0]);
        assert!(cameras[1].camera().is_err());
        let mut load =
            |number, undistort| rara_camera_load(path.as_ptr(), number, undistort, &mut one, size);
        assert_fails(load(1, 0), RARA_ERROR_FORMAT, "OPENCV_FISHEYE");
        assert_fails(load(2, 0), RARA_ERROR_INVALID, "its last is 1");
        assert_eq!(load(1, 1), RARA_OK);
        assert_eq!(one, cameras[0], "they differ in the lens only");
    }
    std::fs::remove_dir_all(&folder).expect("ours");
}

#[test]
fn cameras_of_files() {
    let camera = |name: &str, x: f64| {
        format!(
            r#"{{"id": 0, "img_name": "{name}", "width": 90, "height": 60, "fx": 80.0, "fy": 81.0,
            "position": [{x}, 0.0, -5.0], "rotation": [[1,0,0],[0,1,0],[0,0,1]]}}"#
        )
    };
    let long = "ä".repeat(RARA_MAX_CAMERA_NAME);
    let text = format!("[{}, {}]", camera("left", -1.0), camera(&long, 1.0));
    let path = std::env::temp_dir().join(format!("rara-c-{}.json", std::process::id()));
    std::fs::write(&path, text).expect("a temporary file");
    let truth = rara::camera_files::load_cameras(&path).expect("loads");
    let name = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
    let (mut count, missing) = (9, c"no/such.json".as_ptr());
    // SAFETY: strings that end in NUL, and as much room as the count says.
    unsafe {
        let size = size_of::<RaraCamera>();
        let load = |path, cameras, names, count: &mut usize| {
            rara_cameras_load(path, cameras, size, names, count)
        };
        let result = load(missing, null_mut(), null_mut(), &mut count);
        assert_fails(result, RARA_ERROR_IO, "no/such.json");
        let result = load(name.as_ptr(), null_mut(), null_mut(), &mut count);
        assert_eq!((result, count), (RARA_OK, 2));
        let mut cameras: [RaraCamera; 2] = std::mem::zeroed();
        let mut names: [RaraCameraName; 2] = std::mem::zeroed();
        let room = (cameras.as_mut_ptr(), names.as_mut_ptr());
        count = 1; // room for one
        let result = load(name.as_ptr(), room.0, room.1, &mut count);
        assert_eq!((result, count), (RARA_OK, 2));
        assert_eq!(cameras[1].width, 0, "left alone");
        let result = load(name.as_ptr(), room.0, room.1, &mut count);
        assert_eq!((result, count), (RARA_OK, 2));
        let result = rara_cameras_load(name.as_ptr(), room.0, 3, room.1, &mut count);
        assert_fails(result, RARA_ERROR_INVALID, "sizeof(RaraCamera)");
        for ((ours, called), truth) in cameras.iter().zip(&names).zip(&truth) {
            let camera = truth.camera().expect("a pinhole");
            assert_eq!(ours.camera().expect("a camera"), camera);
            let name = CStr::from_ptr(called.text.as_ptr()).to_str();
            let name = name.expect("whole characters");
            assert!(truth.name().starts_with(name) && name.len() >= truth.name().len().min(254));
        }
    }
    std::fs::remove_file(&path).expect("is there");
}

#[test]
fn codes_are_the_constants_of_the_header() {
    let header = include_str!(concat!(env!("OUT_DIR"), "/rara.h"));
    for (of, value, code) in codes() {
        // "RaraPhiForm" and "Cubic" are RARA_PHI_FORM_CUBIC.
        let words = of.chars().enumerate().flat_map(|(at, letter)| {
            let between = (letter.is_uppercase() && at > 0).then_some('_');
            between.into_iter().chain([letter.to_ascii_uppercase()])
        });
        let prefix: String = words.collect();
        // These may be left out, which has the first code.
        let code = code + u32::from(["RaraDecay", "RaraSortBy"].contains(&of));
        let line = format!("#define {prefix}_{} {code}", value.to_uppercase());
        assert!(header.lines().any(|own| own == line), "{line}");
    }
}

#[test]
fn every_setting_of_the_library_has_a_field() {
    // A host has a background of its own; the formats of the target and of the harmonics belong to the target and the scene.
    let all = [Settings::ALL.len() - 1, Precision::ALL.len() - 2];
    assert_eq!(FIELDS, all);
}
