//! Reading 3DGS `.ply` scenes: header through `ply-rs`, payload by our own chunked readers straight into the arrays.

mod ascii;
mod assemble;
mod binary;
mod header;
mod layout;
mod number;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use ply_rs::ply::Encoding;

use self::assemble::Assembler;
use self::binary::Failure;
use self::header::Header;
use self::layout::Layout;
use super::{Gaussians, LoadReport};
use crate::error::{Error, Result};

/// A scene as loaded, and what the loader did to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub gaussians: Gaussians,
    /// Elements that were dropped or repaired.
    pub report: LoadReport,
}

/// Loads a 3DGS `.ply` file: ascii or binary of either byte order, spherical harmonics of degree 0 to 3, properties of
/// any type in any order; properties and elements that are no part of a Gaussian are ignored.
///
/// Peak memory is the scene itself plus a few MiB. `progress` is called now and then with the bytes read so far and
/// the file's size, last with both equal. A `vertex` element of zero Gaussians is an empty scene, not an error.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it is not a scene or is cut off, [`Error::Memory`] if
/// it doesn't fit. Single bad elements are no error: see [`LoadReport`].
pub fn load(path: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<Loaded> {
    // This is checked before the file is opened, since opening a pipe would wait for its writer.
    let metadata = std::fs::metadata(path).map_err(Error::io(path))?;
    if !metadata.is_file() {
        return Err(Error::format(
            path,
            "this is a folder or a device, not a file; give a .ply file",
        ));
    }
    let file = File::open(path).map_err(Error::io(path))?;
    load_from(file, path, progress)
}

/// Loads a 3DGS `.ply` from anything that can be read and sought in, such as an archive's entry in a
/// [`Cursor`](std::io::Cursor). `name` stands for it in messages. Otherwise like [`load`].
///
/// # Errors
/// As [`load`].
pub fn load_from<R: Read + Seek>(
    mut source: R,
    name: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Loaded> {
    let format = |message: String| Error::format(name, message);
    let total = source.seek(SeekFrom::End(0)).map_err(Error::io(name))?;
    source.rewind().map_err(Error::io(name))?;

    let mut start = Vec::new();
    let limit = header::MAX_BYTES as u64;
    (&mut source)
        .take(limit)
        .read_to_end(&mut start)
        .map_err(Error::io(name))?;
    let header = Header::parse(&start).map_err(format)?;
    drop(start);

    let layout = Layout::of(&header).map_err(format)?;
    let left = total.saturating_sub(header.size);
    layout.check_size(header.encoding, left).map_err(format)?;
    let mut assembler = Assembler::with_room(layout.count, layout.sh_degree).ok_or_else(|| {
        Error::Memory(format!(
            "{}: no memory for {} Gaussians; free some or split the file",
            name.display(),
            layout.count
        ))
    })?;

    source
        .seek(SeekFrom::Start(header.size))
        .map_err(Error::io(name))?;
    let read = match header.encoding {
        Encoding::Ascii => ascii::read::<R>,
        Encoding::BinaryLittleEndian | Encoding::BinaryBigEndian => binary::read::<R>,
    };
    let mut progress = Progress {
        total,
        call: progress,
    };
    read(
        source,
        left,
        &header,
        &layout,
        &mut assembler,
        &mut progress,
    )
    .map_err(|failure| match failure {
        Failure::Io(error) => Error::io(name)(error),
        Failure::Format(message) => format(message),
    })?;
    progress.left(0);
    let (gaussians, report) = assembler.finish();
    Ok(Loaded { gaussians, report })
}

/// The caller's progress callback, for readers that know how many bytes are left.
struct Progress<'a> {
    total: u64,
    call: &'a mut dyn FnMut(u64, u64),
}

impl Progress<'_> {
    fn left(&mut self, left: u64) {
        (self.call)(self.total.saturating_sub(left), self.total);
    }
}
