//! Our own file of a single camera.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::camera_files::camera_from_json;
use rara_fuzz::{assert_camera, assert_readable, within};

fuzz_target!(|bytes: &[u8]| {
    match within(64 << 10, 4, bytes, || {
        camera_from_json(bytes, Path::new("fuzz.json"))
    }) {
        Ok(camera) => assert_camera(&camera),
        Err(error) => assert_readable(&error),
    }
});
