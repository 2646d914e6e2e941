//! Files that were collected from other projects, where this machine has them.

use std::path::{Path, PathBuf};

use rara::scene::load;

use super::made::assert_sound;

fn shared(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("RARA_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let folder = root.join("data").join(folder);
    if !folder.is_dir() {
        eprintln!(
            "SKIPPED: {} is not there (set RARA_SHARED)",
            folder.display()
        );
        return None;
    }
    Some(folder)
}

fn ply_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            ply_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "ply") {
            found.push(path);
        }
    }
}

#[test]
fn collected_malformed_files() {
    let Some(folder) = shared("malformed") else {
        return;
    };
    let mut files = Vec::new();
    ply_files(&folder, &mut files);
    assert!(!files.is_empty());
    for path in files {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let result = load(&path, &mut |_, _| ());
        match &result {
            Ok(loaded) => eprintln!(
                "{name}: {} Gaussians, {}",
                loaded.gaussians.len(),
                loaded.report
            ),
            Err(error) => eprintln!("{error}"),
        }
        if let Ok(loaded) = &result {
            assert_sound(&loaded.gaussians);
        }
        let bad_header = [
            "degree-4-sh",
            "duplicate-sh-index",
            "invalid-sh-name",
            "list-property",
            "mesh-not-gaussian",
            "missing-opacity",
            "non-contiguous-sh",
            "sh-count-not-rgb",
            "sh-invalid-degree",
            "truncated-binary-le",
        ];
        let bad_element = [
            "nan-opacity-binary-le",
            "out-of-range-double",
            "overflow-scale",
        ];
        let foreign = path.iter().any(|part| part == "ply-rs");
        if bad_header.contains(&name.as_str()) || foreign {
            assert!(matches!(result, Err(rara::Error::Format { .. })), "{name}");
        } else if bad_element.contains(&name.as_str()) {
            assert!(result.unwrap().report.dropped > 0, "{name}");
        } else {
            assert!(result.unwrap().report.is_clean(), "{name}");
        }
    }
}

#[test]
fn collected_formats_and_scenes() {
    for folder in ["formats", "general", "medical"] {
        let Some(folder) = shared(folder) else { return };
        let mut files = Vec::new();
        ply_files(&folder, &mut files);
        for path in files {
            let loaded = load(&path, &mut |_, _| ()).unwrap();
            eprintln!(
                "{}: {} Gaussians, {}",
                path.display(),
                loaded.gaussians.len(),
                loaded.report
            );
            assert!(!loaded.gaussians.is_empty());
            assert_sound(&loaded.gaussians);
        }
    }
}
