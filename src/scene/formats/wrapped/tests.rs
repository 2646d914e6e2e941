use std::io::{Cursor, Write};
use std::path::Path;

use flate2::{Compression, write::GzEncoder};
use zip::write::SimpleFileOptions;

use crate::formats::files::Archive;
use crate::{Format, Gaussians, SceneFile, load_from, save};

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut stream = GzEncoder::new(Vec::new(), Compression::fast());
    stream.write_all(bytes).unwrap();
    stream.finish().unwrap()
}

pub(in super::super) fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut made = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        made.start_file(*name, SimpleFileOptions::default())
            .unwrap();
        made.write_all(bytes).unwrap();
    }
    made.finish().unwrap().into_inner()
}

pub(in super::super) fn load(bytes: Vec<u8>) -> rara_base::error::Result<SceneFile> {
    load_from(Cursor::new(bytes), Path::new("a"), &mut |_, _| ())
}

/// The file of a format of so many Gaussians, at this depth.
pub(in super::super) fn file(ending: &str, count: usize, depth: f32) -> (Gaussians, Vec<u8>) {
    let mut scene = Gaussians::default();
    for number in 0..count {
        let centre = glam::Vec3::new(number as f32, 1.0, depth);
        scene.push(
            centre,
            glam::Vec3::ONE,
            glam::Quat::IDENTITY,
            0.5,
            &[0.0; 3],
        );
    }
    let (process, thread) = (std::process::id(), std::thread::current().id());
    let name = format!("rara-wrapped-{process}-{thread:?}{ending}");
    let path = std::env::temp_dir().join(name);
    save(&path, &scene).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    (scene, bytes)
}

/// The files of an archive in a folder.
fn unpacked(bytes: &[u8], folder: &str) -> Vec<(String, Vec<u8>)> {
    let Ok(archive) = Archive::open(bytes) else {
        panic!("no archive")
    };
    let file = |path: &Path| match archive.get(path) {
        Ok(bytes) => (format!("{folder}/{}", path.display()), bytes),
        Err(_) => panic!("{}", path.display()),
    };
    archive.paths().map(file).collect()
}

#[test]
fn an_archive_of_a_streamed_scene_is_what_its_folder_is() {
    let (row, sky) = (file(".sog", 4, 5.0).1, file(".sog", 1, 9.0).1);
    let streamed = |environment: &str| {
        format!(
            r#"{{"filenames": ["row/meta.json"], "tree": {{"lods": {{"0": {{"file": 0, "offset": 0, "count": 4}}}}}},
                "environment": "{environment}"}}"#
        )
    };
    for (top, environment) in [
        ("", "sky/meta.json"),
        ("scene/", "sky/meta.json"),
        ("", "sky.sog"),
    ] {
        let mut files = unpacked(&row, "row");
        files.extend(unpacked(&sky, "sky"));
        files.push(("sky.sog".into(), sky.clone()));
        files.push(("lod-meta.json".into(), streamed(environment).into()));
        let folder = std::env::temp_dir().join(format!("rara-streamed-{}", std::process::id()));
        for (name, bytes) in &files {
            let path = folder.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        }
        let unpacked = crate::load(&folder, &mut |_, _| ()).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        for (name, _) in &mut files {
            name.insert_str(0, top);
        }
        let files: Vec<_> = files
            .iter()
            .map(|(name, bytes)| (&name[..], &bytes[..]))
            .collect();
        let packed = load(archive(&files)).unwrap();
        assert_eq!(packed, unpacked);
        assert_eq!(
            (packed.format, packed.gaussians.len()),
            (Format::StreamedSog, 5)
        );
    }
}

#[test]
fn a_gltf_in_an_archive_finds_its_buffers() {
    let (scene, glb) = file(".glb", 3, 2.0);
    let size = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let (json, binary) = (&glb[20..20 + size], &glb[20 + size + 8..]);
    let mut document: serde_json::Value = serde_json::from_slice(json).unwrap();
    document["buffers"][0]["uri"] = "a b.bin".into();
    let text = document.to_string();
    let loaded = load(archive(&[
        ("in/a b.bin", binary),
        ("in/a.gltf", text.as_bytes()),
    ]));
    assert_eq!(loaded.unwrap().gaussians.positions(), scene.positions());
}

#[test]
fn one_scene_in_a_wrapper_is_read() {
    let (scene, ply) = file(".ply", 2, 1.0);
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
        (archive(&[("a/scene.usda", note)]), "USDZ"),
        (archive(&[("archive/data.pkl", note)]), "PyTorch"),
        (archive(&[("means.npy", note)]), "NumPy"),
        (gzip(&vec![0; 8 << 20]), "which no scene compresses to"),
        (gzip(note), "not a scene in a format that rara reads"),
    ] {
        let error = load(wrong).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}
