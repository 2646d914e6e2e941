//! A 3DGS `cameras.json` (anything that begins with a bracket): whatever loads is a camera.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::camera_files::cameras_from_json;
use rara_fuzz::{assert_camera, assert_readable, within};

fuzz_target!(|bytes: &[u8]| {
    // The bracket makes sure that this parser gets every input.
    let json = [&[91], bytes].concat();
    // Unknown fields are kept until the object ends: "0," is a value of 32 bytes, and its list grows by doubling.
    match within(64 << 10, 64, &json, || {
        cameras_from_json(&json, Path::new("fuzz.json"))
    }) {
        Ok(cameras) => {
            assert!(!cameras.is_empty());
            cameras
                .iter()
                .for_each(|named| assert_camera(&named.camera));
        }
        Err(error) => assert_readable(&error),
    }
});
