//! Polygons: those of a GeoJSON file, and the text of one.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara::clip::Expression;
use rara_fuzz::{assert_readable, assert_surface, kept_in, within};

fuzz_target!(|bytes: &[u8]| {
    let path = kept_in("polygon.geojson", bytes);
    let text = match bytes.strip_prefix(b"z") {
        Some(_) => format!("polygon:{}", String::from_utf8_lossy(bytes)),
        None => format!("polygon:{}", path.display()),
    };
    // A corner of four bytes is kept as two numbers, and as a value of JSON before that.
    match within(1 << 20, 400, bytes, || text.parse::<Expression>()) {
        Ok(read) => read.clip().surfaces.iter().for_each(assert_surface),
        Err(error) => assert_readable(&error),
    }
});
