//! The files that a scene may name: those in its folder, or in the zip archive that it is in.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Component, Path, PathBuf};

use serde_json::Value;
use zip::ZipArchive;

use super::{Failure, inflate, json};
use rara_base::counted::counted;
use rara_base::error::{Error, shortened};

/// Where the files are that a scene may name; nowhere, by default, for a scene in memory.
#[derive(Clone, Copy, Default)]
pub(in super::super) struct Files<'a> {
    archive: Option<&'a Archive<'a>>,
    /// The folder, of the archive where there is one.
    folder: Option<&'a Path>,
}

impl<'a> Files<'a> {
    /// Those of a folder.
    pub(in super::super) fn of_folder(folder: Option<&'a Path>) -> Self {
        Self {
            archive: None,
            folder,
        }
    }

    /// Those beside a file of an archive.
    pub(super) fn beside(archive: &'a Archive<'a>, path: &'a Path) -> Self {
        Self {
            archive: Some(archive),
            folder: path.parent(),
        }
    }

    /// The archive that they are in, if they are in one.
    pub(super) fn archive(&self) -> Option<&'a Archive<'a>> {
        self.archive
    }

    /// The path of a file of a name, within the own folder.
    pub(super) fn path(&self, name: &str) -> Result<PathBuf, Failure> {
        let quoted = shortened(name);
        let folder = self.folder.ok_or_else(|| {
            format!(
                "it needs the file \"{quoted}\" in its folder; load it by its path, not from memory"
            )
        })?;
        let mut parts = Path::new(name).components();
        if name.is_empty()
            || name.contains(['\\', ':'])
            || !parts.all(|part| matches!(part, Component::Normal(_)))
        {
            return Err(Failure::Format(format!(
                "it names \"{quoted}\", which is not the name of a file in its own folder; export the scene again"
            )));
        }
        Ok(folder.join(name))
    }

    /// The file of a name.
    pub(super) fn get(&self, name: &str) -> Result<Vec<u8>, Failure> {
        let path = self.path(name)?;
        match self.archive {
            Some(archive) => archive.get(&path),
            None => Ok(std::fs::read(&path).map_err(Error::io(&path))?),
        }
    }

    /// Those beside a file of this [path](Self::path).
    pub(super) fn at(self, path: &'a Path) -> Self {
        Self {
            folder: path.parent(),
            ..self
        }
    }
}

/// The files in a zip archive, stored or deflated.
pub(in super::super) struct Archive<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// Their numbers, by their paths.
    numbers: BTreeMap<PathBuf, usize>,
}

impl<'a> Archive<'a> {
    /// True for the first bytes of one.
    pub(super) fn is(start: &[u8]) -> bool {
        matches!(start, [b'P', b'K', 3 | 5, 4 | 6, ..])
    }

    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Failure> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| {
            format!("this zip archive has no directory that can be read ({error}); it is cut off, get it again")
        })?;
        let named = archive
            .file_names()
            .enumerate()
            .filter_map(|(number, path)| {
                let path = path.ok()?.replace('\\', "/");
                Some((path.trim_start_matches("./").into(), number))
            });
        let numbers = named.collect();
        Ok(Self { archive, numbers })
    }

    /// The paths of all files but of those whose name says that they are hidden.
    pub(super) fn paths(&self) -> impl Iterator<Item = &Path> {
        let is_hidden = |path: &Path| own_name(path).starts_with('.');
        let all = self.numbers.keys().map(PathBuf::as_path);
        all.filter(move |path| !is_hidden(path))
    }

    /// The path of the file of a name, of several the one in the fewest folders.
    pub(super) fn find(&self, name: &str) -> Option<&Path> {
        let found = self.paths().filter(|path| own_name(path) == name);
        found.min_by_key(|path| path.components().count())
    }

    /// The document of a name, and the files beside it.
    pub(super) fn document(&self, name: &str) -> Result<(Value, Files<'_>), Failure> {
        let path = self.find(name).ok_or_else(|| {
            format!("the archive has no file \"{name}\", which SOG needs; get the scene again")
        })?;
        Ok((json(&self.get(path)?)?, Files::beside(self, path)))
    }

    /// The file of a path.
    pub(super) fn get(&self, path: &Path) -> Result<Vec<u8>, Failure> {
        let quoted = shortened(&path.to_string_lossy());
        let found = self.numbers.get(path).copied().ok_or_else(|| {
            format!(
                "the archive has no file \"{quoted}\", which the scene needs; get the scene again"
            )
        })?;
        let damaged = |error: zip::result::ZipError| {
            let what = shortened(&error.to_string());
            format!("the archive's file \"{quoted}\" cannot be read ({what}); get the scene again")
        };
        let mut archive = self.archive.clone(); // It shares the directory.
        let file = archive.by_index(found).map_err(damaged)?;
        let (stored, size) = (file.compressed_size(), file.size());
        if !inflate::may_become(stored as usize, size) {
            return Err(Failure::Format(format!(
                "the archive's file \"{quoted}\" cannot have {}, as its directory says; get the scene again",
                counted(size, "byte")
            )));
        }
        inflate::exactly(
            file,
            size,
            "zip",
            &format!("the archive's file \"{quoted}\""),
        )
    }
}

/// The name of a file without its folders.
pub(super) fn own_name(path: &Path) -> Cow<'_, str> {
    path.file_name().unwrap_or_default().to_string_lossy()
}
