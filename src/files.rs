//! Writing files so that nobody ever sees half of one.

#![forbid(unsafe_code)]
#![cfg_attr(not(feature = "lab"), allow(unreachable_pub))]

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::{Error, Result};

/// The unfinished files of this process, and how many it has begun so far.
static UNFINISHED: Mutex<(Vec<PathBuf>, u64)> = Mutex::new((Vec::new(), 0));

fn unfinished() -> MutexGuard<'static, (Vec<PathBuf>, u64)> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what [`write_atomically`] has not finished, and lets nobody begin anything more: for a process that is told to end.
/// Returns the number of files that are gone.
#[cfg(feature = "lab")]
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
    let whole = match fs::metadata(path) {
        Ok(there) if !there.is_file() => return write_into(path, write),
        Ok(_) => fs::canonicalize(path).map_err(Error::io(path))?,
        Err(error) => end_of_links(path).ok_or(error).map_err(Error::io(path))?,
    };
    write_beside(&whole, write)
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

fn write_into(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<()> {
    let written = File::options().write(true).open(path).and_then(|file| {
        let mut writer = BufWriter::new(file);
        write(&mut writer)?;
        writer.flush()
    });
    written.map_err(Error::io(path))
}

fn write_beside(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<()> {
    let (beside, created) = begin(path);
    let written = created.and_then(|file| {
        let mut writer = BufWriter::new(file);
        write(&mut writer)?;
        // The content is on the disk before the file gets its name, so that after a crash the name stands for the old
        // file or the new one, never for half of one.
        writer.into_inner()?.sync_all()
    });
    // Renamed and forgotten at once: a file that is whole is never taken for one that is not.
    let mut files = unfinished();
    let written = written.and_then(|()| fs::rename(&beside, path));
    if written.is_err() && files.0.contains(&beside) {
        let _ = fs::remove_file(&beside); // the caller should see the first failure
    }
    files.0.retain(|file| *file != beside);
    written.map_err(Error::io(path))
}

/// Creates the file that becomes `path`. Its name is short, since a name that a file system just takes leaves no room for
/// an ending.
fn begin(path: &Path) -> (PathBuf, std::io::Result<File>) {
    let mut files = unfinished();
    loop {
        let name = format!(".rara-{}-{}.part", std::process::id(), files.1);
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
mod tests {
    use super::*;

    #[test]
    fn links_and_what_is_no_file_stay_what_they_are() {
        let folder = std::env::temp_dir().join(format!("rara-files-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let (file, link) = (folder.join("file"), folder.join("link"));
        fs::write(&file, "old").expect("a file");
        std::os::unix::fs::symlink(&file, &link).expect("a link");
        write_atomically(&link, |out| out.write_all(b"new")).expect("writes");
        let is_link = fs::symlink_metadata(&link).expect("there").is_symlink();
        assert!(is_link && fs::read(&file).expect("there") == b"new");
        let null = Path::new("/dev/null");
        write_atomically(null, |out| out.write_all(b"new")).expect("writes");
        assert!(!fs::metadata(null).expect("there").is_file());
        // A link to what is not there yet, by way of another, makes it.
        let (inner, outer) = (folder.join("inner"), folder.join("outer"));
        std::os::unix::fs::symlink("made", &inner).expect("a link");
        std::os::unix::fs::symlink(&inner, &outer).expect("a link");
        write_atomically(&outer, |out| out.write_all(b"first")).expect("writes");
        let made = folder.join("made");
        assert!(fs::symlink_metadata(&made).expect("there").is_file());
        assert!(fs::read(&outer).expect("there") == b"first");
        fs::remove_file(&made).expect("there");
        // Links in a circle lead nowhere.
        fs::remove_file(&inner).expect("there");
        std::os::unix::fs::symlink("outer", &inner).expect("a link");
        assert!(write_atomically(&outer, |out| out.write_all(b"first")).is_err());
        for link in [&inner, &outer] {
            assert!(fs::symlink_metadata(link).expect("there").is_symlink());
            fs::remove_file(link).expect("there");
        }
        // A write that fails leaves the old file.
        let failed = write_atomically(&link, |out| {
            out.write_all(b"half")?;
            Err(std::io::Error::other("full"))
        });
        assert!(failed.is_err() && fs::read(&file).expect("there") == b"new");
        // A file of another process that has the same number stays that process's.
        let next = unfinished().1;
        let other = folder.join(format!(".rara-{}-{next}.part", std::process::id()));
        fs::write(&other, "theirs").expect("a file");
        write_atomically(&link, |out| out.write_all(b"new")).expect("writes");
        assert!(fs::read(&other).expect("there") == b"theirs");
        fs::remove_file(&other).expect("there");
        // As long a name as file systems take.
        let long = folder.join("n".repeat(255));
        write_atomically(&long, |out| out.write_all(b"new")).expect("writes");
        fs::remove_file(&long).expect("there");
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 2);
        fs::remove_dir_all(&folder).expect("ours");
    }
}
