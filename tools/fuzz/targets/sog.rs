//! A bundled SOG of a description and pictures, which `SPLIT` parts: damage that the archive's checksums would catch in
//! `formats` gets to the readers of what is in it.
#![no_main]

use std::io::Cursor;
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use rara::scene::{Format, load_from};
use rara_fuzz::{assert_readable, assert_sound, within};

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
    let (mut bytes, mut directory, mut count) = (Vec::new(), Vec::new(), 0_u16);
    for (name, content) in files {
        let mut crc = flate2::Crc::new();
        crc.update(content);
        let size = (content.len() as u32).to_le_bytes();
        // Flags, method, time and date are zero.
        let mut about = [0; 8].to_vec();
        about.extend(crc.sum().to_le_bytes());
        about.extend([size, size].as_flattened());
        about.extend((name.len() as u16).to_le_bytes());
        about.extend([0; 2]);
        let offset = (bytes.len() as u32).to_le_bytes();
        bytes.extend(b"PK\x03\x04\x14\0");
        bytes.extend_from_slice(&about);
        bytes.extend_from_slice(name.as_bytes());
        bytes.extend_from_slice(content);
        directory.extend(b"PK\x01\x02\x14\0\x14\0");
        directory.extend(about);
        directory.extend([0; 10]);
        directory.extend(offset);
        directory.extend_from_slice(name.as_bytes());
        count += 1;
    }
    let (size, offset) = (directory.len() as u32, bytes.len() as u32);
    bytes.extend(directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([count.to_le_bytes(); 2].as_flattened());
    bytes.extend([size.to_le_bytes(), offset.to_le_bytes()].as_flattened());
    bytes.extend([0; 2]);
    bytes
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
