//! Reading 3DGS `.ply` scenes: header through `ply-rs`, payload by our own chunked readers straight into the arrays.

mod ascii;
mod assemble;
mod binary;
mod header;
mod layout;
mod number;

use std::io::{Read, SeekFrom};
use std::path::Path;

use ply_rs::ply::Encoding;

use self::assemble::Assembler;
use self::binary::Failure;
use self::header::Header;
use self::layout::Layout;
use super::Property;
use super::load::{Format, Loaded, Progress, Source};
use crate::error::{Error, Result};

/// 3DGS `.ply` files.
pub(super) const FORMAT: Format = Format {
    is: |start, _| start.starts_with(b"ply"),
    read,
};

fn read(
    source: &mut dyn Source,
    name: &Path,
    asked: &[&str],
    progress: &mut Progress<'_>,
) -> Result<(Loaded, Vec<Property>)> {
    let format = |message: String| Error::format(name, message);
    let mut start = Vec::new();
    let limit = header::MAX_BYTES as u64;
    let mut beginning = (&mut *source).take(limit);
    beginning.read_to_end(&mut start).map_err(Error::io(name))?;
    let header = Header::parse(&start).map_err(format)?;
    drop(start);

    let layout = Layout::of(&header, asked).map_err(format)?;
    let left = progress.total().saturating_sub(header.size);
    layout.check_size(header.encoding, left).map_err(format)?;
    let properties = layout.properties.clone();
    let assembler = Assembler::with_room(layout.count, layout.sh_degree, properties);
    let mut assembler = assembler.ok_or_else(|| {
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
        Encoding::Ascii => ascii::read,
        Encoding::BinaryLittleEndian | Encoding::BinaryBigEndian => binary::read,
    };
    read(source, left, &header, &layout, &mut assembler, progress).map_err(
        |failure| match failure {
            Failure::Io(error) => Error::io(name)(error),
            Failure::Format(message) => format(message),
        },
    )?;
    Ok(assembler.finish())
}
