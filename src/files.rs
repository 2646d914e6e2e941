//! Writing files so that nobody ever sees half of one.

#![forbid(unsafe_code)]

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use crate::error::{Error, Result};

/// Writes a file through `write` beside its final place and renames it when complete; after a failure nothing is left
/// and an older file of that name is untouched. Writing is buffered.
///
/// A path that names a device or a pipe (`/dev/null`, `/dev/stdout`) is written to as it is: it must not be replaced.
///
/// # Errors
/// [`Error::Io`] with what the operating system or `write` said.
pub(crate) fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let target = match fs::metadata(path) {
        Ok(found) if found.is_dir() => {
            return Err(Error::Io {
                path: path.into(),
                source: io::Error::new(
                    io::ErrorKind::IsADirectory,
                    "this is a folder; give a file name",
                ),
            });
        }
        Ok(found) if !found.is_file() => {
            let open = OpenOptions::new().write(true).open(path);
            return open
                .and_then(|file| fill(file, write))
                .map_err(Error::io(path));
        }
        // Through a symbolic link, so that the link stays one.
        Ok(_) => fs::canonicalize(path).map_err(Error::io(path))?,
        Err(_) => path.into(),
    };
    let (file, beside) = create_beside(&target).map_err(Error::io(path))?;
    let done = fill(file, write).and_then(|()| fs::rename(&beside, &target));
    if done.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&beside);
    }
    done.map_err(Error::io(path))
}

fn fill(file: File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut buffered = BufWriter::with_capacity(1 << 20, file);
    write(&mut buffered)?;
    buffered.flush()
}

/// A new file in `target`'s folder, under a name that nobody else uses.
fn create_beside(target: &Path) -> io::Result<(File, PathBuf)> {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let name = target
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "this names no file"))?;
    loop {
        let mut temporary = OsString::from(".");
        temporary.push(name);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        temporary.push(format!(".{}-{number}.part", std::process::id()));
        let beside = target.with_file_name(temporary);
        match OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&beside)
        {
            Ok(file) => return Ok((file, beside)),
            // Left behind by a killed process of the same number.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("rara-files-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn replaces_a_file_only_when_complete() {
        let folder = folder("replace");
        let path = folder.join("a.txt");
        write_atomically(&path, |w| w.write_all(b"one")).unwrap();
        let failed = write_atomically(&path, |w| {
            w.write_all(b"two")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.unwrap_err().to_string().contains("disk full"));
        assert_eq!(fs::read(&path).unwrap(), b"one");
        write_atomically(&path, |w| w.write_all(b"three")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"three");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn errors_name_the_path() {
        let folder = folder("errors");
        for path in [
            folder.clone(),
            folder.join("missing/a.txt"),
            PathBuf::from("/"),
        ] {
            let error = write_atomically(&path, |_| Ok(())).unwrap_err().to_string();
            assert!(error.starts_with(&path.display().to_string()), "{error}");
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    #[cfg(unix)]
    fn devices_stay_devices() {
        write_atomically(Path::new("/dev/null"), |w| w.write_all(b"x")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
