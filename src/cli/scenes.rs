//! Scene files to one set of Gaussians.

use std::path::{Path, PathBuf};

use rara::Gaussians;

use super::failure::Failure;
use super::output::{Progress, say};
use rara::scene;

/// One or more scene files, merged.
pub(super) struct Scene {
    pub(super) gaussians: Gaussians,
    /// Gaussians that had a field put right.
    pub(super) repaired: u64,
    /// Gaussians that could not be used.
    pub(super) dropped: u64,
    /// What the loader had to say, a line each.
    pub(super) notes: Vec<String>,
}

/// Reads the files in order and merges them; tells people what had to be repaired.
pub(super) fn load(paths: &[PathBuf]) -> Result<Scene, Failure> {
    let mut merged = Scene {
        gaussians: Gaussians::default(),
        repaired: 0,
        dropped: 0,
        notes: Vec::new(),
    };
    for path in paths {
        let loaded = load_one(path)?;
        merged.repaired += loaded.report.repaired;
        merged.dropped += loaded.report.dropped;
        let lines = loaded.report.lines();
        merged.notes.extend(
            lines
                .into_iter()
                .map(|line| format!("{}: {line}", path.display())),
        );
        if merged.gaussians.is_empty() {
            merged.gaussians = loaded.gaussians;
        } else {
            merged.gaussians.append(&loaded.gaussians);
        }
    }
    for note in &merged.notes {
        say(format_args!("note: {note}"));
    }
    Ok(merged)
}

fn load_one(path: &Path) -> rara::Result<scene::Loaded> {
    let mut progress = Progress::new(format!("reading {}", path.display()));
    scene::load(path, &mut |done, total| progress.update(done, total))
}
