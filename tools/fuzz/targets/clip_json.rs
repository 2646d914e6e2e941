//! A file of clip planes.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::clip::planes_from_json;
use rara_fuzz::{assert_plane, assert_readable, within};

fuzz_target!(|bytes: &[u8]| {
    // A plane of some thirty bytes takes about a hundred and fifty as a clip, three times that while its list grows.
    match within(4 << 10, 24, bytes, || {
        planes_from_json(bytes, Path::new("fuzz.json"))
    }) {
        Ok(planes) => {
            assert!(!planes.is_empty());
            planes.iter().for_each(|named| assert_plane(&named.plane));
        }
        Err(error) => assert_readable(&error),
    }
});
