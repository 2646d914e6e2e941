//! The files in a zip archive, stored or deflated: what `.sog` files are.

use std::borrow::Cow;
use std::io::Cursor;

use zip::ZipArchive;

use super::super::inflate;
use super::Failure;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// An archive's directory.
pub(in super::super) struct Archive<'a>(ZipArchive<Cursor<&'a [u8]>>);

impl<'a> Archive<'a> {
    pub(in super::super) fn open(bytes: &'a [u8]) -> Result<Self, Failure> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| {
            format!("this zip archive has no directory that can be read ({error}); it is cut off, get it again")
        })?;
        Ok(Self(archive))
    }

    /// The names of all files, without their folders.
    pub(in super::super) fn names(&self) -> impl Iterator<Item = String> {
        let own = |path: Cow<'_, str>| path.rsplit(['/', '\\']).next().map(str::to_owned);
        self.0.file_names().filter_map(move |path| own(path.ok()?))
    }

    /// The file of a name, in whatever folder of the archive.
    pub(in super::super) fn get(&self, name: &str) -> Result<Vec<u8>, Failure> {
        let quoted = shortened(name);
        let mut names = self.0.file_names();
        let own = |path: &str| path.rsplit(['/', '\\']).next() == Some(name);
        let found = names.position(|path| path.is_ok_and(|path| own(&path)));
        let found = found.ok_or_else(|| {
            format!("the archive has no file \"{quoted}\", which SOG needs; get the scene again")
        })?;
        let damaged = |error: zip::result::ZipError| {
            let what = shortened(&error.to_string());
            format!("the archive's file \"{quoted}\" cannot be read ({what}); get the scene again")
        };
        let mut archive = self.0.clone(); // It shares the directory.
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
