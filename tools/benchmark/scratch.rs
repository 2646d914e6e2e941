//! A folder for files that only this run needs; it is removed at the end.

use std::fs::{create_dir_all, remove_dir_all};
use std::path::{Path, PathBuf};

use rara::scene::save_ply;
use rara::{Error, Result};

use crate::world::Source;

#[derive(Debug)]
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new() -> Result<Self> {
        let path = std::env::temp_dir().join(format!("rara-bench-{}", std::process::id()));
        create_dir_all(&path).map_err(Error::io(path.clone()))?;
        Ok(Self(path))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// The file of a scene; a generated scene is written to one.
    pub(crate) fn file(&self, source: &Source) -> Result<PathBuf> {
        if let Source::File(path, _) = source {
            return Ok(path.clone());
        }
        let path = self
            .0
            .join(format!("{}-{}.ply", source.name(), source.expected()));
        save_ply(&path, &source.world()?.scene)?;
        Ok(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = remove_dir_all(&self.0);
    }
}
