//! A bundled SOG of a description and pictures, which `SPLIT` parts: damage that the archive's checksums would catch in
//! `formats` gets to the readers of what is in it.
#![no_main]

use std::io::{Cursor, Write};
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::scene::{Format, load_from};
use rara_fuzz::{assert_readable, assert_sound, within};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const SPLIT: &[u8] = b"SPLIT";

/// The files, in the order of their parts.
const NAMES: [&str; 8] = [
    "meta.json",
    "means_l.webp",
    "means_u.webp",
    "scales.webp",
    "quats.webp",
    "sh0.webp",
    "shN_centroids.webp",
    "shN_labels.webp",
];

/// A ZIP of files as they are, whose checksums are right.
fn archive<'a>(files: impl Iterator<Item = (&'a str, &'a [u8])>) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, content) in files {
        archive.start_file(name, stored).expect("its name is no other's");
        archive.write_all(content).expect("there is memory");
    }
    archive.finish().expect("there is memory").into_inner()
}

/// The parts of the input.
fn parts(mut bytes: &[u8]) -> Vec<&[u8]> {
    let mut parts = Vec::new();
    while let Some(at) = bytes.windows(SPLIT.len()).position(|part| part == SPLIT) {
        parts.push(&bytes[..at]);
        bytes = &bytes[at + SPLIT.len()..];
    }
    parts.push(bytes);
    parts
}

fuzz_target!(|bytes: &[u8]| {
    let bytes = archive(NAMES.into_iter().zip(parts(bytes)));
    // As in `formats`: pictures are small by what the rest of the file says, at least 65536 pixels.
    let loaded = within(160 << 20, 5000, &bytes, || {
        load_from(Cursor::new(&bytes), Path::new("fuzz.sog"), &mut |_, _| ())
    });
    match loaded {
        Ok(loaded) => {
            assert_eq!(loaded.format, Format::Sog);
            assert_sound(&loaded.gaussians);
        }
        Err(error) => assert_readable(&error),
    }
});
