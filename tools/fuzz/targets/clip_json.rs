//! A file of clips.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::clip::clips_from_json;
use rara_fuzz::{assert_plane, assert_readable, within};

fuzz_target!(|bytes: &[u8]| {
    // A plane of some thirty bytes takes about a hundred and fifty as a clip, three times that while its list grows.
    match within(4 << 10, 24, bytes, || {
        clips_from_json(bytes, Path::new("fuzz.json"))
    }) {
        Ok(clips) => {
            assert!(!clips.is_empty());
            let planes = clips.iter().filter_map(|named| named.clip.as_plane());
            planes.for_each(|plane| assert_plane(&plane));
        }
        Err(error) => assert_readable(&error),
    }
});
