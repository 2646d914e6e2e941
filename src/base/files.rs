//! Writing files so that nobody ever sees half of one.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use crate::error::{Error, Result};

/// The unfinished files of this process, and how many it has begun so far.
static UNFINISHED: Mutex<(Vec<PathBuf>, u64)> = Mutex::new((Vec::new(), 0));

fn unfinished() -> MutexGuard<'static, (Vec<PathBuf>, u64)> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What distinguishes the unfinished files of this process from those of any other, also on another machine: its number and
/// when it began its first one, nanoseconds since 1970 in hexadecimal digits.
pub fn mark() -> &'static str {
    static MARK: LazyLock<String> = LazyLock::new(|| {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        let nanoseconds = since.map_or(0, |since| since.as_nanos());
        format!("{}-{nanoseconds:x}", std::process::id())
    });
    &MARK
}

/// Removes what is not finished, and lets nobody begin anything more: for a process that is told to end.
/// Returns the number of files that are gone.
pub fn abandon() -> usize {
    let mut files = unfinished();
    let gone = files
        .0
        .drain(..)
        .filter(|file| fs::remove_file(file).is_ok());
    let gone = gone.count();
    std::mem::forget(files); // who writes, waits for the end
    gone
}

/// Writes a file beside `path` and renames it into place; if anything fails, `path` is as it was before. A link stays a
/// link, and the file that it leads to is replaced, or made where it leads to none; a pipe or a terminal is written into.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<()> {
    let mut file = PartialFile::begin(path)?;
    write(&mut file).map_err(Error::io(path))?;
    file.finish()
}

/// The file that does not exist to which links lead from `path`, or `path` itself; none where they lead in a circle.
fn end_of_links(path: &Path) -> Option<PathBuf> {
    /// Systems follow no more.
    const MOST: usize = 40;
    let mut at = path.to_owned();
    for _ in 0..MOST {
        let Ok(to) = fs::read_link(&at) else {
            return Some(at);
        };
        // What is not absolute is so from the folder that the link is in.
        at = at.parent().unwrap_or(Path::new("")).join(to);
    }
    None
}

/// A file that is written piece by piece. It stands beside the place where it goes, as [`write_atomically`] says, and is
/// removed when it is dropped before it is finished.
#[derive(Debug)]
pub struct PartialFile {
    /// What it becomes.
    path: PathBuf,
    /// What it is called until then; none for a pipe or a terminal.
    beside: Option<PathBuf>,
    file: BufWriter<File>,
}

impl PartialFile {
    /// Begins the file.
    ///
    /// # Errors
    /// [`Error::Io`] where no file can be created there.
    pub fn begin(path: &Path) -> Result<Self> {
        let whole = match fs::metadata(path) {
            Ok(there) if !there.is_file() => {
                let file = File::options().write(true).open(path);
                return Ok(Self {
                    path: path.to_owned(),
                    beside: None,
                    file: BufWriter::new(file.map_err(Error::io(path))?),
                });
            }
            Ok(_) => fs::canonicalize(path).map_err(Error::io(path))?,
            Err(error) => end_of_links(path).ok_or(error).map_err(Error::io(path))?,
        };
        let (beside, created) = begin(&whole);
        Ok(Self {
            file: BufWriter::new(created.map_err(Error::io(&whole))?),
            path: whole,
            beside: Some(beside),
        })
    }

    /// Where it is being written, for another process that writes it.
    pub fn place(&self) -> &Path {
        self.beside.as_deref().unwrap_or(&self.path)
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`Error::Io`] where not all of it can be written; the place is then as it was before.
    pub fn finish(mut self) -> Result<()> {
        let mut written = self.file.flush();
        if let Some(beside) = self.beside.take() {
            // The content is on the disk before the file gets its name, so that after a crash the name stands for the old
            // file or the new one, never for half of one.
            written = written.and_then(|()| self.file.get_ref().sync_all());
            // Renamed and forgotten at once: a file that is whole is never taken for one that is not.
            let mut files = unfinished();
            written = written.and_then(|()| fs::rename(&beside, &self.path));
            forget(&mut files, &beside, written.is_err());
        }
        written.map_err(Error::io(&self.path))
    }
}

impl Write for PartialFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if let Some(beside) = self.beside.take() {
            forget(&mut unfinished(), &beside, true);
        }
    }
}

/// Takes a file from the list of those that are unfinished, and removes it where it is to `go`.
fn forget(files: &mut (Vec<PathBuf>, u64), beside: &PathBuf, go: bool) {
    if go && files.0.contains(beside) {
        let _ = fs::remove_file(beside); // the caller should see the first failure
    }
    files.0.retain(|file| file != beside);
}

/// Creates the file that becomes `path`. Its name is short, since a name that a file system just takes leaves no room for
/// an ending.
fn begin(path: &Path) -> (PathBuf, std::io::Result<File>) {
    let mut files = unfinished();
    loop {
        let name = format!(".rara-{}-{}.part", mark(), files.1);
        let beside = path.with_file_name(name);
        files.1 += 1;
        // A process of the same number, in another container or on another machine, may have such a file here.
        let created = File::options().write(true).create_new(true).open(&beside);
        match created {
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return (beside, Err(error)),
            Ok(file) => {
                files.0.push(beside.clone());
                return (beside, Ok(file));
            }
        }
    }
}

#[cfg(all(test, unix))]
mod tests;
