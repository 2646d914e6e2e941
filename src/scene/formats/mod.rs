//! Formats beside 3DGS `.ply`, one file each. All are read from the whole file in memory, since most are compressed; no
//! count in a file is believed before there are bytes for it.

mod bytes;
mod gltf;
mod inflate;
mod ksplat;
mod sog;
mod splat;
mod spz;
mod wrapped;
mod write;

use std::io::{Cursor, Read};
use std::path::Path;

use glam::DAffine3;

pub(super) use self::write::WRITERS;
use super::assemble::{Assembler, room};
use super::failure::Failure;
use super::load::{Input, Progress, load_from_with};
use super::{Annotations, Format, Gaussians, LoadReport, Property, SH_0, SceneFile};
use crate::placement::Placement;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// What a reader makes of a file.
#[derive(Default)]
struct FormatOutput {
    gaussians: Gaussians,
    report: LoadReport,
    /// The file's elements, those included that were dropped.
    elements: u64,
    /// The numbers of those that were dropped or not asked for, which ascend.
    dropped: Vec<u64>,
    annotations: Option<Annotations>,
}

impl From<Assembler> for FormatOutput {
    fn from(assembler: Assembler) -> Self {
        let (elements, dropped) = (assembler.rows(), assembler.dropped.clone());
        let (loaded, _) = assembler.finish();
        Self {
            gaussians: loaded.gaussians,
            report: loaded.report,
            elements,
            dropped,
            annotations: None,
        }
    }
}

impl FormatOutput {
    /// Appends what another part of the file has become.
    fn append(&mut self, other: Self) -> std::result::Result<(), Failure> {
        let before = self.elements;
        let differs = self.gaussians.training() != other.gaussians.training();
        if differs && !self.gaussians.is_empty() && !other.gaussians.is_empty() {
            self.report.note(format!(
                "some parts were trained in other ways; all are drawn {}, as the first is",
                self.gaussians.training()
            ));
        }
        if self.gaussians.is_empty() {
            self.gaussians = other.gaussians; // most files have one part
        } else {
            self.gaussians
                .try_append(&other.gaussians)
                .ok_or_else(|| Failure::Memory(counted(other.elements + before, "Gaussian")))?;
        }
        self.report.append(other.report, before);
        self.elements += other.elements;
        let dropped = other.dropped.iter().map(|element| before + element);
        self.dropped.extend(dropped);
        Ok(())
    }

    /// The element that each Gaussian was.
    fn numbers(&self) -> impl Iterator<Item = u64> {
        let mut dropped = self.dropped.iter().peekable();
        (0..self.elements).filter(move |element| dropped.next_if(|next| *next == element).is_none())
    }

    /// Places the Gaussians; what cannot be held there is dropped.
    fn place(&mut self, placement: &Placement) {
        let lost = self.gaussians.place(placement);
        self.drop_lost(lost);
    }

    /// Applies a transform that is no placement; what cannot be held where it leads is dropped.
    fn transform(&mut self, transform: &DAffine3) {
        let lost = self.gaussians.transform(transform);
        self.drop_lost(lost);
    }

    /// Drops the Gaussians of these numbers, which are gone.
    fn drop_lost(&mut self, lost: Vec<u32>) {
        if lost.is_empty() {
            return;
        }
        let numbers: Vec<u64> = self.numbers().collect();
        for index in lost {
            let element = numbers[index as usize];
            self.dropped.push(element);
            self.report.drop_element(element, || {
                "it is beyond single precision where it is placed".into()
            });
        }
        self.dropped.sort_unstable();
    }
}

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
    /// What is made of a whole file, with the folder of those that it may name.
    fn(&[u8], Option<&Path>) -> Outcome,
);

/// The readers, of which the first whose format a file is of reads it.
const READERS: [Reader; 6] = [
    Reader(
        |start, _| matches!(start, [0x1f, 0x8b, ..] | [b'N', b'G', b'S', b'P', ..]),
        |bytes, _| Ok((spz::read(bytes, true)?, Format::Spz)),
    ),
    Reader(
        |start, _| matches!(start, [b'P', b'K', 3 | 5, 4 | 6, ..]),
        |bytes, _| Ok((sog::read_archive(bytes)?, Format::Sog)),
    ),
    Reader(
        |start, _| start.starts_with(b"glTF"),
        |bytes, folder| Ok((gltf::read_binary(bytes, folder)?, Format::Gltf)),
    ),
    Reader(
        |start, _| bare(start).trim_ascii_start().starts_with(b"{"),
        read_json,
    ),
    Reader(ksplat::is, |bytes, _| {
        Ok((ksplat::read(bytes)?, Format::Ksplat))
    }),
    Reader(splat::is, |bytes, _| {
        Ok((splat::read(bytes)?, Format::Splat))
    }),
];

/// What a file is that none of the formats reads, and what to do about it.
fn unknown(start: &[u8]) -> String {
    let guess = match start {
        [] => "it is empty",
        [b'P', b'X', b'R', b'-', ..] | [b'#', b'u', b's', b'd', b'a', ..] => "it is a USD scene",
        [b'L', b'A', b'S', b'F', ..] => "it is a LAS point cloud",
        [0x28, 0xb5, 0x2f, 0xfd, ..] => "it is compressed with zstd",
        [b'R', b'A', b'D', b'0', ..] => "it is a .rad scene of Spark",
        [0x89, b'H', b'D', b'F', ..] => "it is an HDF5 file, perhaps a checkpoint of a trainer",
        [b'R', b'I', b'F', b'F', ..] => {
            "it is a WebP picture; give the meta.json or the folder that it belongs to"
        }
        [b'[', ..] => "it is a JSON list, perhaps of cameras",
        _ => "its first bytes are those of none",
    };
    format!(
        "this is no scene of a format that is read, {guess}; {} are: convert it to one of these, for example with \
         splat-transform",
        Format::readable()
    )
}

/// Reads a file that is no PLY and begins like this.
pub(super) fn read(
    start: &[u8],
    input: Input<'_>,
    progress: &mut Progress<'_>,
) -> Result<(SceneFile, Vec<Property>)> {
    let Input { source, name, .. } = input;
    let total = progress.total();
    let reader = READERS.iter().find(|Reader(is, _)| is(start, total));
    let Reader(_, read) = reader.ok_or_else(|| Error::format(name, unknown(start)))?;
    let mut bytes = Vec::new();
    let room = usize::try_from(total).is_ok_and(|total| bytes.try_reserve_exact(total).is_ok());
    if !room {
        return Err(Failure::Memory(format!("its {}", counted(total, "byte"))).error_in(name));
    }
    source
        .take(total)
        .read_to_end(&mut bytes)
        .map_err(Error::io(name))?;
    if let Some(scene) = wrapped::scene(&bytes).map_err(|failure| failure.error_in(name))? {
        drop(bytes);
        return read_wrapped(&scene, name, input.properties);
    }
    let read = read(&bytes, input.folder);
    let (made, format) = read.map_err(|failure| failure.error_in(name))?;
    if let Some(property) = input.properties.first() {
        return Err(Error::format(
            name,
            format!(
                "a {format} file has no property `{}` beside what a Gaussian is made of; only 3DGS .ply files have such",
                rara_base::error::shortened(property)
            ),
        ));
    }
    let loaded = SceneFile {
        // Writers that know nothing of it leave the flag of their format unset.
        antialiased: made.gaussians.is_antialiased().then_some(true),
        gaussians: made.gaussians,
        report: made.report,
        format,
        annotations: made.annotations,
    };
    Ok((loaded, Vec::new()))
}

/// Reads a scene that another file wraps, which wraps no other.
fn read_wrapped(
    scene: &[u8],
    name: &Path,
    properties: &[&str],
) -> Result<(SceneFile, Vec<Property>)> {
    let again = wrapped::scene(scene).map_err(|failure| failure.error_in(name))?;
    if again.is_some() {
        return Err(Error::format(
            name,
            "it is compressed twice; decompress it once",
        ));
    }
    load_from_with(Cursor::new(scene), name, properties, &mut |_, _| ())
}

/// JSON of any of the formats that are JSON.
fn read_json(bytes: &[u8], folder: Option<&Path>) -> Outcome {
    let document = json(bytes)?;
    let has = |key: &str| document.get(key).is_some();
    if has("means") {
        return Ok((sog::read_folder(&document, folder)?, Format::Sog));
    }
    if has("tree") && has("filenames") {
        return Ok((sog::read_streamed(&document, folder)?, Format::StreamedSog));
    }
    if has("asset") {
        return Ok((gltf::read_document(&document, None, folder)?, Format::Gltf));
    }
    let what = match has("layers") {
        true => "it is a list of layers, which the program rara reads where its name ends in .json",
        false => "it is JSON, but neither the meta.json of a SOG scene nor glTF",
    };
    let read = Format::readable();
    Err(format!("this is no scene: {what}; {read} are read").into())
}

/// Text without a byte-order mark.
fn bare(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// A JSON document; its text is the limit of its memory, and its depth is bounded.
fn json(bytes: &[u8]) -> std::result::Result<serde_json::Value, String> {
    serde_json::from_slice(bare(bytes))
        .map_err(|error| format!("its JSON is damaged: {error}; export the scene again"))
}

/// A file beside the scene's, whose name stands in it: within its folder, and a name that cannot lead out.
fn beside(name: &str, folder: Option<&Path>) -> std::result::Result<Vec<u8>, Failure> {
    let quoted = rara_base::error::shortened(name);
    let folder = folder.ok_or_else(|| {
        format!("it needs the file \"{quoted}\" beside it; load it by its path, not from memory")
    })?;
    let mut parts = Path::new(name).components();
    if name.is_empty()
        || name.contains(['\\', ':'])
        || !parts.all(|part| matches!(part, std::path::Component::Normal(_)))
    {
        return Err(Failure::Format(format!(
            "it names \"{quoted}\", which is no name of a file in its own folder; export the scene again"
        )));
    }
    let path = folder.join(name);
    Ok(std::fs::read(&path).map_err(Error::io(&path))?)
}
