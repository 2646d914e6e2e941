//! A scene of any format: whatever loads is sound, whatever does not gets a readable reason.
#![no_main]

use std::io::Cursor;
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::scene::{Format, load_from};
use rara_fuzz::{assert_readable, assert_sound, within};

fuzz_target!(|bytes: &[u8]| {
    // Deflate makes up to 1040 bytes of one, zstd and WebP more: their pictures and streams are small by what the rest of the
    // file says, at least 65536 pixels. A Gaussian of 19 bytes is kept as 56.
    let loaded = within(160 << 20, 5000, bytes, || {
        load_from(Cursor::new(bytes), Path::new("fuzz"), &mut |done, total| {
            assert!(done <= total && total == bytes.len() as u64);
        })
    });
    match loaded {
        Ok(loaded) => {
            assert_sound(&loaded.gaussians);
            assert!(!loaded.format.to_string().is_empty());
            let is_counted = loaded.format != Format::Splat;
            assert!(is_counted || loaded.gaussians.len() + loaded.report.dropped as usize == bytes.len() / 32);
        }
        Err(error) => assert_readable(&error),
    }
});
