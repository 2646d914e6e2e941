//! A COLMAP model's two files, binary or text: the first byte chooses, `SPLIT` parts them.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::camera_files::{ColmapFormat, NamedCamera, cameras_from_colmap};
use rara_fuzz::{assert_named, assert_readable, within};

const SPLIT: &[u8] = b"SPLIT";

fuzz_target!(|bytes: &[u8]| {
    let Some((kind, rest)) = bytes.split_first() else {
        return;
    };
    let format = if *kind == b'b' {
        ColmapFormat::Binary
    } else {
        ColmapFormat::Text
    };
    let at = rest.windows(SPLIT.len()).position(|window| window == SPLIT);
    let (cameras, images) = match at {
        Some(at) => (&rest[..at], &rest[at + SPLIT.len()..]),
        None => rest.split_at(rest.len() / 2),
    };
    // Bytes that are no UTF-8 take three each as text; a picture of a few bytes takes some 150.
    let load = || cameras_from_colmap(format, cameras, images, Path::new("fuzz"));
    match within(64 << 10, 40, bytes, load) {
        Ok(cameras) => {
            assert!(!cameras.is_empty() && cameras.is_sorted_by_key(NamedCamera::name));
            cameras.iter().for_each(assert_named);
        }
        Err(error) => assert_readable(&error),
    }
});
