//! A scene in a file that only compresses it: a gzip stream, or a zip archive that holds nothing else that could be meant.

use super::inflate::Gzip;
use super::sog::Archive;
use super::{Failure, Format};
use rara_base::counted::counted;

/// A stream may become so many times as large: scenes are numbers without much order, of which gzip saves half.
const MOST: u64 = 64;
/// A scene of a few Gaussians may have so many bytes more.
const LEAST: u64 = 1 << 20;

/// The scene that a file wraps, if it is one that wraps. A gzip stream may be a `.spz` too, and an archive a `.sog`.
pub(super) fn scene(bytes: &[u8]) -> Result<Option<Vec<u8>>, Failure> {
    match bytes {
        [0x1f, 0x8b, ..] => gzip(bytes),
        [b'P', b'K', 3 | 5, 4 | 6, ..] => archive(bytes),
        _ => Ok(None),
    }
}

fn gzip(bytes: &[u8]) -> Result<Option<Vec<u8>>, Failure> {
    // What is damaged from the start is said by the reader of .spz.
    match Gzip::new(bytes).next(4) {
        Ok(start) if start != b"NGSP" => {}
        _ => return Ok(None),
    }
    let most = MOST * bytes.len() as u64 + LEAST;
    let mut stream = Gzip::new(bytes);
    let scene = stream.next(most)?;
    let behind = stream.rest()?;
    match behind {
        0 => Ok(Some(scene)),
        _ => Err(Failure::Format(format!(
            "its gzip stream has {} and more, which no scene compresses to that; decompress it, if it is one",
            counted(scene.len(), "byte")
        ))),
    }
}

fn archive(bytes: &[u8]) -> Result<Option<Vec<u8>>, Failure> {
    let archive = Archive::open(bytes)?;
    let is_scene = |name: &String| !name.starts_with('.') && Format::is_name(name);
    let scenes: Vec<String> = archive.names().filter(is_scene).collect();
    match scenes.as_slice() {
        [] => Ok(None), // the reader of .sog says what it misses
        [one] => archive.get(one).map(Some),
        several => Err(Failure::Format(format!(
            "the archive holds {}; unpack it, and give the one that is meant",
            counted(several.len(), "scene")
        ))),
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};
    use std::path::Path;

    use flate2::{Compression, write::GzEncoder};
    use zip::write::SimpleFileOptions;

    use crate::{Format, Gaussians, load_from, save_ply};

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut stream = GzEncoder::new(Vec::new(), Compression::fast());
        stream.write_all(bytes).unwrap();
        stream.finish().unwrap()
    }

    fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut made = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            made.start_file(*name, SimpleFileOptions::default())
                .unwrap();
            made.write_all(bytes).unwrap();
        }
        made.finish().unwrap().into_inner()
    }

    #[test]
    fn one_scene_in_a_wrapper_is_read() {
        let mut scene = Gaussians::default();
        scene.push(
            glam::Vec3::ONE,
            glam::Vec3::ONE,
            glam::Quat::IDENTITY,
            0.5,
            &[0.0; 3],
        );
        let path = std::env::temp_dir().join(format!("rara-wrapped-{}.ply", std::process::id()));
        save_ply(&path, &scene).unwrap();
        let ply = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let load = |bytes: Vec<u8>| load_from(Cursor::new(bytes), Path::new("a"), &mut |_, _| ());
        let note: &[u8] = b"hello";
        for whole in [
            gzip(&ply),
            archive(&[
                ("scans/a.PLY", &ply),
                ("readme.txt", note),
                ("__MACOSX/._a.ply", note),
            ]),
            archive(&[("a.ply", &ply)]),
        ] {
            let loaded = load(whole).unwrap();
            assert_eq!(
                (loaded.format, loaded.gaussians),
                (Format::Ply, scene.clone())
            );
        }
        for (wrong, says) in [
            (gzip(&gzip(&ply)), "compressed twice"),
            (archive(&[("a.ply", &gzip(&ply))]), "compressed twice"),
            (
                archive(&[("a.ply", &ply), ("b.splat", note)]),
                "holds 2 scenes",
            ),
            (archive(&[("readme.txt", note)]), "meta.json"),
            (gzip(&vec![0; 8 << 20]), "which no scene compresses to"),
            (gzip(note), "no scene of a format that is read"),
        ] {
            let error = load(wrong).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
