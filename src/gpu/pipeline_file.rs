//! Keeps compiled pipelines in a file of the user's cache folder, from one run to the next. A file that cannot be used
//! counts as none, and one that cannot be written is no error.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::device::{Ahead, Device};
use super::pipeline_cache::PipelineCacheId;
use rara_base::error::{Error, Result};
use rara_base::files::write_atomically;
use rara_base::fnv;

/// The place in which `Headless` keeps compiled pipelines from one run to the next.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum PipelineCache {
    /// Pipelines are kept in the user's cache folder: `RARA_CACHE`, else `rara` in `XDG_CACHE_HOME`, else `~/.cache/rara` (on
    /// Windows `rara` in `LOCALAPPDATA`, on macOS `~/Library/Caches/rara`). They are not kept if there is no home folder, or if
    /// `RARA_CACHE` is set but empty.
    #[default]
    User,
    /// Pipelines are kept in this folder, which is created when the first one is stored.
    Folder(PathBuf),
    /// Pipelines are not kept: every run compiles everything.
    Off,
}

impl PipelineCache {
    fn folder(&self) -> Option<PathBuf> {
        match self {
            Self::User => user_folder(|name| std::env::var_os(name)),
            Self::Folder(folder) => Some(folder.clone()),
            Self::Off => None,
        }
    }
}

fn user_folder(variable: impl Fn(&str) -> Option<std::ffi::OsString>) -> Option<PathBuf> {
    if let Some(own) = variable("RARA_CACHE") {
        return (!own.is_empty()).then(|| own.into());
    }
    // The standard says that a relative path means nothing here.
    let absolute = |name| {
        variable(name)
            .map(PathBuf::from)
            .filter(|path| path.is_absolute())
    };
    let home = |folder| Some(absolute("HOME")?.join(folder));
    let caches = if cfg!(windows) {
        absolute("LOCALAPPDATA")
    } else if cfg!(target_vendor = "apple") {
        home("Library/Caches")
    } else {
        absolute("XDG_CACHE_HOME").or_else(|| home(".cache"))
    };
    Some(caches?.join("rara"))
}

/// The file of one device and driver.
#[derive(Debug)]
pub struct PipelineFile {
    path: PathBuf,
    /// The seal of the data that it is known to hold.
    held: Option<Seal>,
}

/// The file begins with this; then follow the [`Seal`] and the data.
const MAGIC: [u8; 8] = *b"rarapipe";
/// The most bytes of a file, more than drivers are known to keep for a few dozen pipelines: a larger one is none of ours.
const MOST: u64 = 256 << 20;

/// Length and hash of the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Seal {
    length: u64,
    hash: u64,
}

impl Seal {
    const BYTES: usize = 16;

    fn from_data(data: &[u8]) -> Self {
        // FNV-1a is enough against a full disk or a broken one.
        Self {
            length: data.len() as u64,
            hash: fnv::with(fnv::NOTHING, data.iter().copied()),
        }
    }

    fn bytes(self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        bytes[..8].copy_from_slice(&self.length.to_le_bytes());
        bytes[8..].copy_from_slice(&self.hash.to_le_bytes());
        bytes
    }
}

fn is_missing(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
    )
}

impl PipelineFile {
    /// Gives the device the pipelines that an earlier run kept for it. `None` if nothing is to be kept.
    #[doc(hidden)]
    pub fn open(cache: &PipelineCache, device: &Device) -> Option<Self> {
        let id = device.pipeline_cache_id();
        let path = cache.folder()?.join(name(&id));
        if let Some(ahead) = Ahead::open(device, path.with_extension("compiled")) {
            let _ = device.inner.ahead.set(ahead);
        }
        let mut this = Self { path, held: None };
        match read(&this.path, &id) {
            Ok(data) => {
                // SAFETY: only data that `keep` has written passes the checks of `read`: it is whole, unchanged and this
                // driver's.
                let added = unsafe { device.add_pipeline_cache_data(&data) };
                match added {
                    Ok(()) => this.held = Some(Seal::from_data(&data)),
                    Err(error) => log::warn!("{}: {error}", this.path.display()),
                }
            }
            // A file among the folders is told of when something is to be kept.
            Err(error) if is_missing(&error) => {}
            Err(error) => log::warn!("{}: {error}; compiling anew", this.path.display()),
        }
        Some(this)
    }

    /// Bytes of compiled pipelines that the file is known to hold.
    #[doc(hidden)]
    pub fn held_bytes(&self) -> u64 {
        self.held.map_or(0, |seal| seal.length)
    }

    /// Keeps the pipelines that the device has compiled, unless the file holds them already.
    #[doc(hidden)]
    pub fn keep(&mut self, device: &Device) {
        let kept = device
            .pipeline_cache_data()
            .and_then(|data| self.write(&data));
        if let Err(error) = kept {
            log::warn!("compiled pipelines are not kept: {error}");
        }
    }

    fn write(&mut self, data: &[u8]) -> Result<()> {
        let seal = Seal::from_data(data);
        if data.is_empty() || seal.length > MOST || self.held == Some(seal) {
            return Ok(());
        }
        let folder = self.path.parent().expect("a file in a folder");
        fs::create_dir_all(folder).map_err(Error::io(folder))?;
        write_atomically(&self.path, |out| {
            out.write_all(&MAGIC)?;
            out.write_all(&seal.bytes())?;
            out.write_all(data)
        })?;
        self.held = Some(seal);
        Ok(())
    }
}

/// A name for each device and driver: one machine may have several, and one home several machines.
fn name(id: &PipelineCacheId) -> String {
    let uuid: String = id.uuid.iter().map(|byte| format!("{byte:02x}")).collect();
    let PipelineCacheId {
        vendor,
        device,
        driver,
        ..
    } = id;
    format!("pipelines-{vendor:x}-{device:x}-{driver:x}-{uuid}.bin")
}

/// The data of a file, if it is whole and this driver's.
fn read(path: &Path, id: &PipelineCacheId) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let mut bytes = Vec::new();
    file.take(MOST + 1).read_to_end(&mut bytes)?;
    let refuse = |why: &str| Err(io::Error::new(io::ErrorKind::InvalidData, why.to_owned()));
    let sealed = bytes
        .strip_prefix(&MAGIC)
        .and_then(|rest| rest.split_at_checked(Seal::BYTES));
    let Some((seal, data)) = sealed else {
        return refuse("not a file of compiled pipelines");
    };
    if Seal::from_data(data).bytes() != seal {
        return refuse("damaged");
    }
    if !id.matches(data) {
        return refuse("made by another driver or device");
    }
    Ok(data.to_vec())
}

#[cfg(test)]
mod tests;
