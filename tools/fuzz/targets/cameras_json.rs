//! A 3DGS `cameras.json` (anything that begins with a bracket): whatever loads is a camera.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara_fuzz::assert_cameras;

fuzz_target!(|bytes: &[u8]| {
    // The bracket makes sure that this parser gets every input.
    let json = [&[91], bytes].concat();
    assert_cameras(&json);
});
