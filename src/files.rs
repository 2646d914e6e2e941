//! Writing files so that nobody ever sees half of one.

#![forbid(unsafe_code)]
#![cfg_attr(not(feature = "lab"), allow(unreachable_pub))]

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

use crate::{Error, Result};

/// Writes a file beside `path` and renames it into place; if anything fails, `path` is as it was before. A link stays a
/// link, and the file that it leads to is replaced; a pipe or a terminal is written into.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<()> {
    let whole = match fs::metadata(path) {
        Ok(there) if !there.is_file() => return write_into(path, write),
        Ok(_) => fs::canonicalize(path).map_err(Error::io(path))?,
        Err(_) => path.to_owned(),
    };
    write_beside(&whole, write)
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
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.part", std::process::id()));
    let beside = path.with_file_name(name);
    let written = File::create(&beside).and_then(|file| {
        let mut writer = BufWriter::new(file);
        write(&mut writer)?;
        // The content is on the disk before the file gets its name, so that after a crash the name stands for the old
        // file or the new one, never for half of one.
        writer.into_inner()?.sync_all()?;
        fs::rename(&beside, path)
    });
    if written.is_err() {
        let _ = fs::remove_file(&beside); // the caller should see the first failure
    }
    written.map_err(Error::io(path))
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
        // A write that fails leaves the old file.
        let failed = write_atomically(&link, |out| {
            out.write_all(b"half")?;
            Err(std::io::Error::other("full"))
        });
        assert!(failed.is_err() && fs::read(&file).expect("there") == b"new");
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 2);
        fs::remove_dir_all(&folder).expect("ours");
    }
}
