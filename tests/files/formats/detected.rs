//! Formats are found by what is in a file, and what is of none is named.

use rara::scene::{Format, Kind, generate, load, save};

use super::load_bytes;
use crate::common::folder::Folder;

#[test]
fn names_mean_nothing() {
    let folder = Folder::new("formats-names");
    let scene = generate(Kind::General, 100, 1);
    for (name, format) in [
        ("a.ply", Format::Ply),
        ("a.compressed.ply", Format::CompressedPly),
        ("a.spz", Format::Spz),
        ("a.sog", Format::Sog),
        ("a.glb", Format::Gltf),
    ] {
        let (path, other) = (folder.join(name), folder.join("picture.png"));
        save(&path, &scene).unwrap();
        std::fs::rename(&path, &other).unwrap();
        let loaded = load(&other, &mut |_, _| ()).unwrap();
        assert_eq!((loaded.format, loaded.gaussians.len()), (format, 100));
        assert!(loaded.report.is_clean());
    }
}

#[test]
fn what_is_not_read_is_named_with_the_remedy() {
    for (bytes, says) in [
        (&b""[..], "empty"),
        (b"PXR-USDC\0\0\0\0", "USD"),
        (b"LASF\0\0\0\0", "LAS"),
        (b"RIFF\0\0\0\0WEBP", "meta.json"),
        (b"\x89HDF\r\n", "HDF5"),
        (b"[{}]", "cameras"),
        (b"{\"layers\": []}", "list of layers"),
        (b"{\"version\": 2}", "neither"),
        (
            br#"{"asset": {"version": "1.1"}, "geometricError": 500, "root": {"content": {"uri": "0.glb"}}}"#,
            "3D Tiles: give the files that it names, such as 0.glb",
        ),
        (b"{\"totalSplats\": 3}", "LCC"),
        (b"{\"frames\": []}", "cameras"),
        (b"\x80\x04\x95pickle", "let the trainer export a .ply"),
        (b"\x93NUMPY", "NumPy"),
        (b"ASTM-E57", "E57"),
        (b"Kaydara FBX Binary", "FBX"),
        (b"7z\xbc\xaf\x27\x1c", "unpack it"),
        (b"Rar!", "unpack it"),
        (b"<!DOCTYPE html>", "web page"),
        (b"version https://git-lfs.github.com/spec/v1", "git lfs pull"),
        (b"\x89PNG", "picture"),
        (b"v 0 0 0\n", "mesh"),
        (b"# any program\no a\nv 0 0 0\n", "mesh"),
        (b"\n <!doctype html>", "web page"),
        (b"hello, world", "convert it"),
        (b"PK\x03\x04 no archive at all, though", "cut off"),
        (b"\x1f\x8b no gzip at all, though", "damaged"),
        (b"glTF\x01\0\0\0\x0c\0\0\0", "version 1"),
    ] {
        let error = load_bytes(bytes).unwrap_err().to_string();
        assert!(
            error.starts_with("entry: ") && error.contains(says),
            "{error}, not {says}"
        );
    }
}

#[test]
fn names_that_are_not_written_are_refused() {
    let scene = generate(Kind::General, 1, 1);
    for name in ["a.splat", "a.ksplat", "a.usd", "a"] {
        let error = save(name.as_ref(), &scene).unwrap_err().to_string();
        assert!(
            error.contains(".compressed.ply, .ply, .spz, .sog, .glb"),
            "{error}"
        );
        assert!(!std::path::Path::new(name).exists());
    }
}

#[test]
fn properties_are_of_plain_ply_files_alone() {
    let folder = Folder::new("formats-properties");
    for name in ["a.spz", "a.compressed.ply"] {
        let path = folder.join(name);
        save(&path, &generate(Kind::General, 3, 1)).unwrap();
        let error = rara::scene::load_with(&path, &["label"], &mut |_, _| ()).unwrap_err();
        assert!(error.to_string().contains("no property `label`"), "{error}");
    }
}
