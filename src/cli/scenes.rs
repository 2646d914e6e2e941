//! Scene files to the layers of a scene.

use std::path::{Path, PathBuf};

use clap::Args;
use rara::{Gaussians, Layer};

use super::failure::Failure;
use super::output::{Progress, say};
use rara::scene;

/// The flags that name the scene.
#[derive(Debug, Args)]
pub(super) struct SceneArgs {
    /// Scene files (3DGS .ply); several are the layers of one scene
    #[arg(value_name = "SCENE", required = true)]
    files: Vec<PathBuf>,
}

impl SceneArgs {
    /// The files' names.
    pub(super) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Reads the files.
    pub(super) fn load(&self) -> Result<Loaded, Failure> {
        load(&self.files)
    }
}

/// One or more scene files.
pub(super) struct Loaded {
    /// The Gaussians of each file, and the file's name without its ending.
    pub(super) files: Vec<(String, Gaussians)>,
    /// Gaussians that had a field put right.
    pub(super) repaired: u64,
    /// Gaussians that could not be used.
    pub(super) dropped: u64,
    /// The loader's reports, a line each.
    pub(super) notes: Vec<String>,
}

impl Loaded {
    /// Gaussians that come from no file.
    pub(super) fn made_up(name: &str, gaussians: Gaussians) -> Self {
        Self {
            files: vec![(name.to_owned(), gaussians)],
            repaired: 0,
            dropped: 0,
            notes: Vec::new(),
        }
    }

    /// A scene with a layer for each file.
    pub(super) fn scene(&self) -> rara::Scene<'_> {
        let files = self.files.iter();
        files
            .map(|(name, gaussians)| Layer::new(name, gaussians))
            .collect()
    }

    /// All files' Gaussians as one set.
    pub(super) fn merged(self) -> Gaussians {
        let mut files = self.files.into_iter().map(|(_, gaussians)| gaussians);
        let mut merged = files.next().unwrap_or_default();
        files.for_each(|more| merged.append(&more));
        merged
    }
}

/// Reads the files in order, and prints what had to be repaired.
pub(super) fn load(paths: &[PathBuf]) -> Result<Loaded, Failure> {
    let mut all = Loaded {
        files: Vec::new(),
        repaired: 0,
        dropped: 0,
        notes: Vec::new(),
    };
    for path in paths {
        let loaded = load_one(path)?;
        all.repaired += loaded.report.repaired;
        all.dropped += loaded.report.dropped;
        let lines = loaded.report.lines();
        all.notes.extend(
            lines
                .into_iter()
                .map(|line| format!("{}: {line}", path.display())),
        );
        let name = path.file_stem().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        all.files.push((name, loaded.gaussians));
    }
    for note in &all.notes {
        say(format_args!("note: {note}"));
    }
    Ok(all)
}

fn load_one(path: &Path) -> rara::Result<scene::Loaded> {
    let mut progress = Progress::new(format!("reading {}", path.display()));
    scene::load(path, &mut |done, total| progress.update(done, total))
}
