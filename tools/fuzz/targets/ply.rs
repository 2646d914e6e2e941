//! A scene file: whatever loads is sound, whatever does not gets a readable reason.
#![no_main]

use std::io::Cursor;
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::scene::load_from;
use rara_fuzz::{assert_readable, assert_sound, within};

fuzz_target!(|bytes: &[u8]| {
    // A Gaussian of bytes is kept as floats: four times the file. A header's lines, kept as strings until it is parsed,
    // cost 24 bytes each and as much again while their list grows. The readers' buffers are 1 MiB.
    let loaded = within(4 << 20, 100, bytes, || {
        let mut before = 0;
        load_from(
            Cursor::new(bytes),
            Path::new("fuzz.ply"),
            &mut |done, total| {
                assert!(before <= done && done <= total && total == bytes.len() as u64);
                before = done;
            },
        )
    });
    match loaded {
        Ok(loaded) => {
            assert_sound(&loaded.gaussians);
            assert!(loaded.report.repaired <= loaded.gaussians.len() as u64);
            assert!(loaded.report.trailing_bytes <= bytes.len() as u64);
        }
        Err(error) => assert_readable(&error),
    }
});
