//! Reading 3DGS `.ply` scenes: header through `ply-rs`, payload by our own chunked readers straight into the arrays.

mod ascii;
mod binary;
mod header;
mod layout;
mod number;
mod packed;
mod trained;

use std::fs::File;
use std::io::{Cursor, Read, SeekFrom};
use std::path::Path;

use glam::DVec3;
use ply_rs::ply::Encoding;

pub(super) use self::header::PlyHeader;
use self::layout::Layout;
pub(super) use self::number::Number;
use self::trained::TrainerKind;
pub(super) use self::trained::up_comment;
use super::assemble::{ColumnForm, DEGREE_4, room_with};
use super::input::{ALL, Input, LoadOptions, Progress};
use super::placed::far_origin;
use super::scene_file::SceneFile;
use super::{Format, LoadReport, Property};
use crate::Training;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// Gaussians of which one says where a scene is.
const FIRST: u64 = 64;

/// The direction that is up in the scene of a file, where that is a `.ply` whose comment says it (`Vertical Axis: z`).
pub fn stated_up(path: &Path) -> Option<DVec3> {
    let is_file = path.is_file(); // opening a pipe would wait for its writer
    let mut start = Vec::new();
    let file = File::open(path).ok().filter(|_| is_file)?;
    file.take(header::MAX_BYTES as u64)
        .read_to_end(&mut start)
        .ok()?;
    PlyHeader::parse(&start).ok()?.up
}

/// Reads a file that is in memory, and tells nobody how far.
pub(super) fn read_bytes(
    bytes: &[u8],
    name: &Path,
    options: LoadOptions<'_>,
) -> Result<(SceneFile, Vec<Property>)> {
    let input = Input {
        source: &mut Cursor::new(bytes),
        name,
        options,
    };
    read(
        input,
        &mut Progress::new(bytes.len() as u64, &mut |_, _| ()),
    )
}

/// Reads 3DGS `.ply` files, compressed ones too.
pub(super) fn read(
    input: Input<'_>,
    progress: &mut Progress<'_>,
) -> Result<(SceneFile, Vec<Property>)> {
    let Input {
        source,
        name,
        options,
    } = input;
    let asked = options.properties;
    let form = ColumnForm::plain(
        options.scales_are_activated,
        options.opacities_are_activated,
    );
    let format = |message: String| Error::format(name, message);
    let mut start = Vec::new();
    let limit = header::MAX_BYTES as u64;
    let mut beginning = (&mut *source).take(limit);
    beginning.read_to_end(&mut start).map_err(Error::io(name))?;
    let header = PlyHeader::parse(&start).map_err(format)?;
    drop(start);

    let mut training = header.training.0;
    let mut antialiased = header.kind.map(|kind| kind == TrainerKind::Antialiased);
    let left = progress.total().saturating_sub(header.size);
    if packed::is(&header) {
        if let Some(property) = asked.iter().find(|asked| **asked != ALL) {
            return Err(format(format!(
                "a compressed PLY has no property `{}` next to those of a Gaussian; only plain 3DGS .ply files have \
                 such",
                rara_base::error::shortened(property)
            )));
        }
        let start = SeekFrom::Start(header.size);
        source.seek(start).map_err(Error::io(name))?;
        let made = packed::read(source, &header, left, progress);
        let made = made.map_err(|failure| failure.error_in(name))?;
        let (mut loaded, properties) = made.finish();
        loaded.format = Format::CompressedPly;
        loaded.others = packed::others(&header);
        loaded.up = header.up;
        note(&mut loaded.report, &header, false);
        loaded.says(antialiased, training);
        return Ok((loaded, properties));
    }
    let layout = Layout::from_header(&header, asked).map_err(format)?;
    layout.check_size(header.encoding, left).map_err(format)?;
    let mut rows = |layout: &Layout, origin: DVec3, progress: &mut Progress<'_>| {
        let properties = layout.properties.clone();
        let room = room_with(layout.count, layout.sh_degree, form, properties);
        let room = room.map_err(|failure| failure.error_in(name))?;
        let mut assembler = room.about(origin);
        source
            .seek(SeekFrom::Start(header.size))
            .map_err(Error::io(name))?;
        let (source, header, assembled) = (&mut *source, &header, &mut assembler);
        let read = match header.encoding {
            Encoding::Ascii => ascii::read(source, left, header, layout, assembled, progress),
            Encoding::BinaryLittleEndian | Encoding::BinaryBigEndian => {
                binary::read(source, left, header, layout, assembled, progress)
            }
        };
        read.map_err(|failure| failure.error_in(name))?;
        Ok(assembler)
    };
    // What is stored in single precision has it already.
    let origin = match layout.has_wide_centres() {
        true => {
            let first = Layout {
                count: layout.count.min(FIRST),
                ..layout.clone()
            };
            let first = rows(
                &first,
                DVec3::ZERO,
                &mut Progress::new(left, &mut |_, _| ()),
            );
            // What is wrong with a row is said where all are read.
            let first = first.map(|first| first.finish().0.gaussians);
            first.map_or(DVec3::ZERO, |first| match first.is_empty() {
                true => DVec3::ZERO,
                false => far_origin(first.centre(0)),
            })
        }
        false => DVec3::ZERO,
    };
    let assembler = rows(&layout, origin, progress)?;
    let (mut loaded, mut properties) = assembler.finish();
    loaded.others = layout.others;
    loaded.up = header.up;
    note(&mut loaded.report, &header, layout.is_flat);
    if layout.stored_degree > layout.sh_degree {
        loaded.report.note(DEGREE_4.into());
    }
    if form == ColumnForm::Logarithms {
        note_activated(&mut loaded);
    }
    if layout.is_flat {
        trained::flatten(&mut loaded.gaussians);
    }
    if let Some(full) = layout.full_colour {
        trained::colour(&mut loaded.gaussians, full);
        let note = "took the colours from red, green and blue, since there is no f_dc_0";
        loaded.report.note(note.into());
    }
    if let Some(at) = properties
        .iter()
        .position(|property| property.name == trained::FILTER)
    {
        let unusable = trained::smooth(&mut loaded.gaussians, &properties[at].values);
        antialiased = Some(true);
        if training.low_pass == Training::default().low_pass {
            training.low_pass = trained::LOW_PASS;
        }
        loaded.report.note(format!(
            "smoothed the Gaussians by {}, and draws them antialiased, as Mip-Splatting does",
            trained::FILTER
        ));
        if unusable > 0 {
            loaded.report.note(format!(
                "{unusable} values of {} are not finite numbers, and smooth nothing",
                trained::FILTER
            ));
        }
        if !asked.contains(&trained::FILTER) {
            properties.remove(at);
        }
    }
    loaded.says(antialiased, training);
    Ok((loaded, properties))
}

/// Says so where what was read as logits, or as logarithms, all lies within 0 to 1: then it may be opacities, or scales.
fn note_activated(loaded: &mut SceneFile) {
    let set = &loaded.gaussians;
    let ends = |(least, most): (f32, f32), value: f32| (least.min(value), most.max(value));
    let none = (f32::INFINITY, f32::NEG_INFINITY);
    let opacities = set.opacities().iter().copied().fold(none, ends);
    let scales = set.scales().iter().flat_map(|scale| scale.to_array());
    let scales = scales.fold(none, ends);
    // Of the logits 0 and 1, and of the logarithms.
    const OPACITIES: (f32, f32) = (0.5, 0.731_058_6);
    const SCALES: (f32, f32) = (1.0, std::f32::consts::E);
    let within = |own: (f32, f32), (least, most): (f32, f32)| {
        least <= own.0 && own.1 <= most && own.1 > least
    };
    for (is_so, what, stored) in [
        (within(opacities, OPACITIES), "opacity", "logits"),
        (
            within(scales, SCALES) && scales.0 > 1.0,
            "scale",
            "logarithms",
        ),
    ] {
        if is_so {
            loaded.report.note(format!(
                "all numbers of {what} lie within 0 to 1, and are taken for {stored}; where they are not, --activated {what} \
                 reads them as they are"
            ));
        }
    }
}

/// Says what of a header is drawn otherwise than it stands there.
fn note(report: &mut LoadReport, header: &PlyHeader, is_flat: bool) {
    if is_flat || header.kind == Some(TrainerKind::Discs) {
        report.note(trained::DISCS.into());
    }
    for mark in &header.training.1 {
        report.note(mark.clone());
    }
    if header.blank > 0 {
        report.note(format!(
            "skipped {} of the header",
            counted(header.blank, "blank line")
        ));
    }
}
