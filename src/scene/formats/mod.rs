//! Finds the format of a file and reads it. Formats beside 3DGS `.ply` have a file each here. They are read from the whole
//! file in memory, since most are compressed; no count in a file is believed before there are bytes for it.

mod bytes;
mod files;
mod gltf;
mod inflate;
mod ksplat;
mod output;
mod project;
mod sog;
mod splat;
mod spz;
mod unread;
mod wrapped;
mod write;

use std::io::{Read, SeekFrom};
use std::path::Path;

use serde_json::Value;

use self::files::Archive;
pub(super) use self::files::Files;
pub(super) use self::gltf::triangles;
use self::output::FormatOutput;
pub use self::project::{FileLayer, file_layers, load_layer};
pub(super) use self::write::WRITERS;
use super::assemble::room;
use super::failure::Failure;
use super::input::{ALL, Input, LoadOptions, Progress};
use super::scene_file::SceneFile;
use super::{Format, Property, SH_0, ply};
use rara_base::counted::counted;
use rara_base::error::{Error, Result, shortened};

/// Bytes that a format is recognised by, at most.
const START: usize = 4096;

/// The names of what describes a SOG scene that is not packed, of one level of detail and of several.
pub(super) const SOG_DOCUMENTS: [&str; 2] = ["meta.json", "lod-meta.json"];

/// The coefficient of degree 0 that shows a colour channel.
fn colour(byte: u8) -> f64 {
    (f64::from(byte) / 255.0 - 0.5) / SH_0
}

/// What a reader makes of a file, and which format that is.
type Outcome = std::result::Result<(FormatOutput, Format), Failure>;

/// How files of a format are read.
struct Reader(
    /// Whether a file is of the format, by its first bytes and its size.
    fn(&[u8], u64) -> bool,
    /// What is made of a whole file, with those that it may name and the properties that are asked for.
    fn(&[u8], Files<'_>, &[&str]) -> Outcome,
);

/// The readers of whole files. The first one whose format a file is of reads it.
static READERS: [Reader; 6] = [
    Reader(
        |start, _| matches!(start, [0x1f, 0x8b, ..] | [b'N', b'G', b'S', b'P', ..]),
        |bytes, _, _| Ok((spz::read(bytes, true)?, Format::Spz)),
    ),
    Reader(|start, _| Archive::is(start), read_archive),
    Reader(
        |start, _| start.starts_with(b"glTF"),
        |bytes, files, asked| Ok((gltf::read_binary(bytes, files, asked)?, Format::Gltf)),
    ),
    Reader(
        |start, _| bare(start).trim_ascii_start().starts_with(b"{"),
        read_json,
    ),
    Reader(ksplat::is, |bytes, _, _| {
        Ok((ksplat::read(bytes)?, Format::Ksplat))
    }),
    Reader(splat::is, |bytes, _, _| {
        Ok((splat::read(bytes)?, Format::Splat))
    }),
];

/// Reads a scene, which may name these files.
pub(super) fn read(
    input: Input<'_>,
    files: Files<'_>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(SceneFile, Vec<Property>)> {
    let (source, name) = (&mut *input.source, input.name);
    let total = source.seek(SeekFrom::End(0)).map_err(Error::io(name))?;
    source.rewind().map_err(Error::io(name))?;
    let mut start = Vec::new();
    let mut beginning = source.take(START as u64);
    beginning.read_to_end(&mut start).map_err(Error::io(name))?;
    input.source.rewind().map_err(Error::io(name))?;
    let mut progress = Progress::new(total, progress);
    let (mut loaded, properties) = match is_ply(&start) {
        true => ply::read(input, &mut progress)?,
        false => {
            reader_of(&start, total).map_err(|what| Error::format(name, what))?;
            let read = read_whole(input, files, total);
            read.map_err(|failure| failure.error_in(name))?
        }
    };
    loaded.says_origin();
    progress.left(0);
    Ok((loaded, properties))
}

/// Reads a file that is no PLY, or the scene that such a file wraps.
fn read_whole(
    input: Input<'_>,
    files: Files<'_>,
    total: u64,
) -> std::result::Result<(SceneFile, Vec<Property>), Failure> {
    let Input {
        source,
        name,
        options,
    } = input;
    let mut bytes = Vec::new();
    let room = usize::try_from(total).is_ok_and(|total| bytes.try_reserve_exact(total).is_ok());
    if !room {
        return Err(Failure::Memory(format!("its {}", counted(total, "byte"))));
    }
    source.take(total).read_to_end(&mut bytes)?;
    if let Some(scene) = wrapped::decompressed(&bytes)? {
        drop(bytes);
        return read_bytes(&scene, name, files, options);
    }
    if Archive::is(&bytes) {
        let archive = Archive::open(&bytes)?;
        if let Some((scene, files)) = wrapped::unpacked(&archive)? {
            return read_bytes(&scene, name, files, options);
        }
    }
    read_bytes(&bytes, name, files, options)
}

/// Reads a scene that is in memory, and is not wrapped.
fn read_bytes(
    bytes: &[u8],
    name: &Path,
    files: Files<'_>,
    options: LoadOptions<'_>,
) -> std::result::Result<(SceneFile, Vec<Property>), Failure> {
    let (start, total) = (&bytes[..bytes.len().min(START)], bytes.len() as u64);
    if is_ply(start) {
        return Ok(ply::read_bytes(bytes, name, options)?);
    }
    let Reader(_, read) = reader_of(start, total)?;
    let (made, format) = read(bytes, files, options.properties)?;
    let has = |asked: &str| made.properties.iter().any(|own| own.name == asked);
    let mut asked = options.properties.iter();
    if let Some(property) = asked.find(|asked| **asked != ALL && !has(asked)) {
        let others = match format {
            Format::Gltf => "the notes on it name those that it has",
            _ => "only 3DGS .ply files and glTF have such",
        };
        return Err(Failure::Format(format!(
            "this {format} file has no property `{}` next to those of a Gaussian; {others}",
            shortened(property)
        )));
    }
    let mut loaded = SceneFile {
        // Writers that know nothing of it leave the flag of their format unset.
        antialiased: made.gaussians.is_antialiased().then_some(true),
        gaussians: made.gaussians,
        report: made.report,
        format,
        annotations: made.annotations,
        others: made.others,
        up: None,
    };
    if options.activated(false, false) != options {
        let note = "only a plain .ply is read as opacities or scales that are activated; this format says itself how it has them";
        loaded.report.note(note.into());
    }
    Ok((loaded, made.properties))
}

/// True for the first bytes of a PLY.
fn is_ply(start: &[u8]) -> bool {
    start.starts_with(b"ply")
}

/// The reader of a file that is no PLY, or what is wrong with one that no reader knows.
fn reader_of(start: &[u8], total: u64) -> std::result::Result<&'static Reader, String> {
    let reader = READERS.iter().find(|Reader(is, _)| is(start, total));
    reader.ok_or_else(|| unread::file(start, total))
}

/// An archive whose files are one scene together.
fn read_archive(bytes: &[u8], _: Files<'_>, asked: &[&str]) -> Outcome {
    let archive = Archive::open(bytes)?;
    match wrapped::description(&archive) {
        Some(name) => {
            let (document, files) = archive.document(name)?;
            read_document(&document, files, asked)
        }
        None => Err(unread::archive(&archive).into()),
    }
}

/// JSON of any of the formats that are JSON.
fn read_json(bytes: &[u8], files: Files<'_>, asked: &[&str]) -> Outcome {
    read_document(&json(bytes)?, files, asked)
}

fn read_document(document: &Value, files: Files<'_>, asked: &[&str]) -> Outcome {
    let has = |key: &str| document.get(key).is_some();
    if has("means") {
        return Ok((sog::read(document, files)?, Format::Sog));
    }
    if has("tree") && has("filenames") {
        return Ok((sog::read_streamed(document, files)?, Format::StreamedSog));
    }
    if project::is(document) {
        return Ok((project::read(document, files)?, Format::SuperSplat));
    }
    match unread::document(document) {
        Some(what) => Err(what.into()),
        None => Ok((
            gltf::read_document(document, None, files, asked)?,
            Format::Gltf,
        )),
    }
}

/// A list of an object; empty where there is none.
fn list<'a>(object: &'a Value, key: &str) -> &'a [Value] {
    let list = object.get(key).and_then(Value::as_array);
    list.map(Vec::as_slice).unwrap_or_default()
}

/// The numbers of a list, or a single one; none where something else is among them.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Array(all) => all.iter().map(Value::as_f64).collect(),
        one => Some(vec![one.as_f64()?]),
    }
}

/// The names of the members of an object that are not read, as messages have them.
fn unread_members(object: &Value, is_read: impl Fn(&str) -> bool) -> Vec<String> {
    let names = object.as_object().into_iter().flatten();
    let unread = names.filter(|(name, _)| !is_read(name));
    unread.map(|(name, _)| shortened(name)).collect()
}

/// Text without a byte-order mark.
fn bare(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// A JSON document; its text is the limit of its memory, and its depth is bounded.
fn json(bytes: &[u8]) -> std::result::Result<Value, String> {
    serde_json::from_slice(bare(bytes))
        .map_err(|error| format!("its JSON is damaged: {error}; export the scene again"))
}
