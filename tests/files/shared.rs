//! Scenes of other projects, where this machine has them.

use std::path::{Path, PathBuf};

/// A folder of scenes that this machine may have.
pub(crate) fn shared(folder: &str) -> Option<PathBuf> {
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

/// All files in a folder and in those in it.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}
