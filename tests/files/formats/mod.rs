//! Formats beside 3DGS `.ply`: what other programs wrote, and what is written here, is the scene that it was.

mod collected;
mod damaged;
mod detected;
mod distance;
mod truth;
mod variants;
mod written;

use std::io::Cursor;
use std::path::{Path, PathBuf};

use rara::scene::{Loaded, load_from};

/// A folder of scenes that this machine may have.
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

/// All files in a folder and in those in it.
fn files(folder: &Path) -> Vec<PathBuf> {
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

fn load_bytes(bytes: &[u8]) -> rara::Result<Loaded> {
    load_from(Cursor::new(bytes), Path::new("entry"), &mut |_, _| ())
}
