//! A nerfstudio `transforms.json` (anything that begins with a brace): whatever loads is a camera.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara_fuzz::assert_cameras;

fuzz_target!(|bytes: &[u8]| {
    // The brace makes sure that this parser gets every input.
    let json = [&[123], bytes].concat();
    assert_cameras(&json);
});
