//! Files that were collected from other projects, where this machine has them.

use std::path::{Path, PathBuf};

use rara::scene::load;

use super::made::assert_sound;
use crate::files::shared::{files, shared};

/// All PLY files in a folder and in those in it.
fn ply_files(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let is_ply = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "ply");
    files(folder).into_iter().filter(is_ply)
}

#[test]
fn collected_malformed_files() {
    let Some(folder) = shared("malformed") else {
        return;
    };
    let files: Vec<_> = ply_files(&folder).collect();
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
        } else if name == "degree-4-sh" {
            let left = "left out the spherical harmonics of degree 4, which are not drawn";
            assert_eq!(result.unwrap().report.lines(), [left]);
        } else {
            assert!(result.unwrap().report.is_clean(), "{name}");
        }
    }
}

#[test]
fn collected_formats_and_scenes() {
    for folder in ["formats", "general", "medical"] {
        let Some(folder) = shared(folder) else { return };
        for path in ply_files(&folder) {
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
