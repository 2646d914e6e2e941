//! What is done of a batch: a file of lines for each worker, which all of them read, and a lock for each picture that is
//! being drawn.
//!
//! A picture gets its name when it is whole, and its line after that. A worker that ends in between has lost the line and no
//! picture: the next one draws it again, to the same bytes.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rara::{Error, Result};
use rara_base::files::mark;
use rara_base::fnv;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::super::output;

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct StateRecord {
    /// Its file, or the pattern of its file and its number where names are left open.
    pub(super) picture: String,
    pub(super) file: PathBuf,
    pub(super) bytes: u64,
    /// What stands for the text of its job.
    pub(super) job: String,
    pub(super) version: String,
    pub(super) driver: String,
    pub(super) worker: String,
    /// The time at which it was done, seconds since 1970.
    pub(super) at: f64,
    /// The time between the picture before and this one.
    pub(super) seconds: f64,
    /// What shares are balanced by.
    pub(super) work: f64,
    /// What `--json` says of its frame.
    pub(super) frame: Value,
}

/// What workers have done.
#[derive(Debug, Default)]
pub(super) struct State {
    pub(super) entries: BTreeMap<String, StateRecord>,
    /// Lines that are none of these.
    pub(super) unread: usize,
}

impl State {
    /// Reads what all workers have written into a folder; nothing is done where there is none.
    pub(super) fn read(folder: &Path) -> Result<Self> {
        let mut state = Self::default();
        let files = match fs::read_dir(folder) {
            Ok(files) => files,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(state),
            Err(error) => return Err(Error::io(folder)(error)),
        };
        for file in files {
            let path = file.map_err(Error::io(folder))?.path();
            if path.extension().is_none_or(|ending| ending != "jsonl") {
                continue;
            }
            let text = fs::read(&path).map_err(Error::io(&path))?;
            let text = String::from_utf8_lossy(&text);
            // A line without an end is one that its worker has not finished, or never will.
            let whole = text.rfind('\n').map_or("", |end| &text[..end]);
            for line in whole.lines() {
                match serde_json::from_str::<StateRecord>(line) {
                    Ok(entry) => state.add(entry),
                    Err(_) => state.unread += 1,
                }
            }
        }
        Ok(state)
    }

    /// Of two entries of one picture the later one counts.
    fn add(&mut self, entry: StateRecord) {
        match self.entries.get(&entry.picture) {
            Some(there) if there.at > entry.at => {}
            _ => {
                self.entries.insert(entry.picture.clone(), entry);
            }
        }
    }
}

impl StateRecord {
    /// True where its file is as it was written.
    pub(super) fn is_there(&self) -> bool {
        fs::metadata(&self.file).is_ok_and(|about| about.is_file() && about.len() == self.bytes)
    }
}

/// What this process adds to a batch.
pub(super) struct Worker {
    folder: PathBuf,
    /// Its lines; none before the first.
    lines: Mutex<Option<File>>,
}

/// A picture that this process draws, and no other.
#[derive(Debug)]
pub(super) struct Claim {
    /// The lock, where the file system has locks.
    lock: Option<(PathBuf, File)>,
}

impl Worker {
    pub(super) fn new(folder: &Path) -> Result<Self> {
        output::make_folder(&folder.join(CLAIMS))?;
        Ok(Self {
            folder: folder.to_owned(),
            lines: Mutex::default(),
        })
    }

    /// Claims a picture that was last done at a time, 0 if never; none where another process has it, or has done it since.
    /// What a process that was killed has left beside it is removed.
    pub(super) fn claim(
        &self,
        (picture, at): (&str, f64),
        file: Option<&Path>,
    ) -> Result<Option<Claim>> {
        let path = self
            .folder
            .join(CLAIMS)
            .join(format!("{}.lock", stamp(picture)));
        let wrong = Error::io(&path);
        let mut options = File::options();
        options.create(true).truncate(false).read(true).write(true);
        let mut lock = options.open(&path).map_err(Error::io(&path))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) => {
                output::warn_once(format!(
                    "note: {} has no locks ({error}): do not draw the same share twice at a time",
                    self.folder.display()
                ));
                return Ok(Some(Claim { lock: None }));
            }
        }
        let mut before = String::new();
        lock.read_to_string(&mut before).map_err(wrong)?;
        match before.strip_prefix(DONE).map(str::parse::<f64>) {
            Some(Ok(done)) if done > at => return Ok(None),
            Some(_) => {}
            None if before.is_empty() => {}
            None => {
                file.and_then(Path::parent)
                    .into_iter()
                    .for_each(|folder| remove_parts(folder, &before));
            }
        }
        write_over(&mut lock, mark()).map_err(Error::io(&path))?;
        Ok(Some(Claim {
            lock: Some((path, lock)),
        }))
    }

    pub(super) fn note(&self, entry: &StateRecord) -> Result<()> {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let path = self.folder.join(format!("{}.jsonl", mark()));
        if lines.is_none() {
            let file = File::options().create(true).append(true).open(&path);
            *lines = Some(file.map_err(Error::io(&path))?);
        }
        let line = serde_json::to_string(entry).expect("an entry has string keys only") + "\n";
        let file = lines.as_mut().expect("it is open");
        file.write_all(line.as_bytes()).map_err(Error::io(&path))
    }
}

impl Claim {
    /// Gives a picture free that was done at a time.
    pub(super) fn release(self, at: f64) -> Result<()> {
        match self.lock {
            Some((path, mut lock)) => {
                write_over(&mut lock, &format!("{DONE}{at}")).map_err(Error::io(&path))
            }
            None => Ok(()),
        }
    }
}

/// The folder of locks in that of a batch.
const CLAIMS: &str = "claims";

/// What a lock says whose picture is done, before the time.
const DONE: &str = "done ";

fn write_over(file: &mut File, text: &str) -> std::io::Result<()> {
    file.set_len(0)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(text.as_bytes())
}

/// Removes the unfinished files of a process from a folder.
fn remove_parts(folder: &Path, mark: &str) {
    let begin = format!(".rara-{mark}-");
    // What cannot be removed is in nobody's way.
    for file in fs::read_dir(folder).into_iter().flatten().flatten() {
        if file.file_name().to_string_lossy().starts_with(&begin) {
            let _ = fs::remove_file(file.path());
        }
    }
}

/// A short text that stands for a long one.
pub(super) fn stamp(text: &str) -> String {
    format!("{:016x}", fnv::with(fnv::NOTHING, text.bytes()))
}

#[cfg(test)]
mod tests;
