//! `.spz`: each attribute in a run of its own, quantised; all in one gzip stream (versions 1 to 3), or each in a stream of
//! zstd (version 4).

use glam::{DQuat, DVec3};

use super::super::assemble::{ColumnForm, OPACITY, ROTATION, SCALES, SH, unit_quaternion};
use super::bytes::{Bytes, f16_at};
use super::inflate::{self, Gzip};
use super::{Failure, FormatOutput, room};
use crate::placement::Placement;
use rara_base::counted::counted;

pub(super) const MAGIC: &[u8; 4] = b"NGSP";
/// Bytes of the header that all versions have, and of version 4's.
const HEADER: u64 = 16;
pub(super) const HEADER_4: u64 = 32;
/// The flag for Gaussians that were trained antialiased.
pub(super) const ANTIALIASED: u8 = 1;
/// The flag for records after the Gaussians.
const HAS_EXTENSIONS: u8 = 2;
/// The record that says which way the axes point.
const AXES: u32 = 0xADBE_0003;
/// Bytes of such records that are read, at most.
const MOST_EXTENSIONS: u64 = 1 << 20;
/// The colours' range: a byte's 0 to 1 are 0.5 less, and then 0.15 of the coefficient.
pub(super) const COLOUR: f64 = 0.15;

struct SpzHeader {
    version: u32,
    count: u64,
    degree: u32,
    fraction_bits: u32,
    flags: u8,
    streams: u8,
}

impl SpzHeader {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let what = "the .spz header";
        let mut bytes = Bytes(bytes);
        if bytes.take(4, what)? != MAGIC {
            return Err(
                "it is compressed with gzip, but it is not a .spz scene; decompress it, and give the file that is in it".into(),
            );
        }
        let (version, count) = (bytes.u32(what)?, bytes.u32(what)?.into());
        let header = Self {
            version,
            count,
            degree: bytes.u8(what)?.into(),
            fraction_bits: bytes.u8(what)?.into(),
            flags: bytes.u8(what)?,
            streams: bytes.u8(what)?,
        };
        if !(1..=4).contains(&version) {
            return Err(format!(
                "this is .spz of version {version}; 1 to 4 are read, export the scene as one of these"
            ));
        }
        if header.degree > 4 {
            return Err(format!(
                "it has spherical harmonics of degree {}; .spz has 0 to 4, export the scene again",
                header.degree
            ));
        }
        if header.fraction_bits > 24 {
            return Err(format!(
                "its positions have {} bits behind the point, of 24 in all; export the scene again",
                header.fraction_bits
            ));
        }
        Ok(header)
    }

    /// Coefficients above degree 0, of three channels.
    fn coefficients(&self) -> usize {
        ((self.degree + 1) * (self.degree + 1) - 1) as usize
    }

    /// Bytes of one Gaussian in each of the runs.
    fn sizes(&self) -> [u64; 6] {
        let position = if self.version == 1 { 6 } else { 9 };
        let rotation = if self.version < 3 { 3 } else { 4 };
        [position, 1, 3, 3, rotation, 3 * self.coefficients() as u64]
    }

    fn size(&self) -> u64 {
        self.count * self.sizes().iter().sum::<u64>()
    }

    /// The Gaussians of six runs, with axes that become ours.
    fn made(&self, runs: [&[u8]; 6], axes: Axes) -> Result<FormatOutput, Failure> {
        let Axes {
            signs: axes,
            is_z_up,
        } = axes;
        let room = room(self.count, self.degree, ColumnForm::LogScales)?;
        let [position, _, _, _, rotation, harmonics] = self.sizes().map(|size| size as usize);
        let unit = f64::from(1_u32 << self.fraction_bits).recip();
        let sh_signs = signs(axes);
        let made = room.make(|index, row| {
            let centre = &runs[0][index * position..][..position];
            for axis in 0..3 {
                let value = match self.version {
                    1 => f16_at(centre, 2 * axis),
                    _ => {
                        let bytes = [
                            0,
                            centre[3 * axis],
                            centre[3 * axis + 1],
                            centre[3 * axis + 2],
                        ];
                        f64::from(i32::from_le_bytes(bytes) >> 8) * unit
                    }
                };
                row[axis] = value * axes[axis];
                row[SCALES + axis] = f64::from(runs[3][3 * index + axis]) / 16.0 - 10.0;
                row[SH + axis] = (f64::from(runs[2][3 * index + axis]) / 255.0 - 0.5) / COLOUR;
            }
            row[OPACITY] = f64::from(runs[1][index]) / 255.0;
            let stored = &runs[4][index * rotation..][..rotation];
            let [w, x, y, z] = match stored {
                &[x, y, z] => {
                    unit_quaternion(0, [x, y, z].map(|byte| f64::from(byte) / 127.5 - 1.0))
                }
                _ => smallest_three(stored),
            };
            // A reflected rotation turns about the reflected axis, the other way round.
            let mirror: f64 = axes.iter().product();
            let turned = [
                w,
                x * axes[0] * mirror,
                y * axes[1] * mirror,
                z * axes[2] * mirror,
            ];
            row[ROTATION..OPACITY].copy_from_slice(&turned);
            let stored = &runs[5][index * harmonics..][..harmonics];
            let to = row[SH + 3..].iter_mut().zip(stored).enumerate();
            for (at, (to, &byte)) in to {
                *to = (f64::from(byte) - 128.0) / 128.0 * sh_signs[at / 3];
            }
            Ok(())
        })?;
        let mut made = FormatOutput::from(made);
        made.gaussians
            .set_antialiased(self.flags & ANTIALIASED != 0);
        if is_z_up {
            let turn = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
            made.place(&Placement::new(DVec3::ZERO, turn, 1.0)?);
        }
        Ok(made)
    }
}

/// Four bytes: the place of the largest part of x, y, z, w in the top bits, then nine bits and a sign of each other.
fn smallest_three(stored: &[u8]) -> [f64; 4] {
    let mut bits = u32::from_le_bytes([stored[0], stored[1], stored[2], stored[3]]);
    let largest = (bits >> 30) as usize;
    let mut others = [0.0; 3];
    for part in others.iter_mut().rev() {
        let length = f64::from(bits & 511) / 511.0 * std::f64::consts::FRAC_1_SQRT_2;
        *part = if bits & 512 == 0 { length } else { -length };
        bits >>= 10;
    }
    let [x, y, z, w] = unit_quaternion(largest, others);
    [w, x, y, z]
}

/// The signs of the coefficients above degree 0 where the axes have these signs.
pub(super) fn signs([x, y, z]: [f64; 3]) -> [f64; 15] {
    [
        y,
        z,
        x,
        x * y,
        y * z,
        1.0,
        x * z,
        1.0,
        y,
        x * y * z,
        y,
        z,
        x,
        z,
        x,
    ]
}

/// The axes of .spz against ours, right, down and forward: right, up and back.
pub(super) const RIGHT_UP_BACK: [f64; 3] = [1.0, -1.0, -1.0];

/// How a file's axes become ours, right, down and forward.
#[derive(Clone, Copy)]
struct Axes {
    signs: [f64; 3],
    /// True where y goes along the view and z up or down: then a quarter turn about x, y to z, follows the signs.
    is_z_up: bool,
}

/// The axes that records after the header or the Gaussians say, if one does. A rest that is no record is ignored: it is after
/// everything that is needed.
fn extensions(bytes: &[u8]) -> Result<Option<Axes>, String> {
    let what = "an extension";
    let (mut bytes, mut axes) = (Bytes(bytes), None);
    while bytes.0.len() >= 8 {
        let (kind, size) = (bytes.u32(what)?, bytes.u32(what)?);
        let Ok(record) = bytes.take(size.into(), what) else {
            break;
        };
        let mut record = Bytes(record);
        if kind == AXES {
            let sign = |plus: bool| if plus { 1.0 } else { -1.0 };
            axes = match record.u32(what)? {
                0 => None, // not said
                // Left or right in the first bit, down or up in the second, back or forward in the third; in the fourth
                // whether z is what goes down or up.
                way @ 1..=16 => {
                    let way = way - 1;
                    let [x, down, forward] =
                        [sign(way & 1 == 1), sign(way & 2 == 0), sign(way & 4 == 4)];
                    let is_z_up = way & 8 == 8;
                    let signs = if is_z_up {
                        [x, forward, -down]
                    } else {
                        [x, down, forward]
                    };
                    Some(Axes { signs, is_z_up })
                }
                other => {
                    return Err(format!(
                        "its axes are ordered in a way that is not read ({other}); export the scene with the axes right, up \
                         and back"
                    ));
                }
            };
        }
    }
    Ok(axes)
}

/// Reads a whole file. The axes become ours where that is wanted; in glTF they are glTF's already.
pub(super) fn read(bytes: &[u8], turn: bool) -> Result<FormatOutput, Failure> {
    let as_they_are = |signs| Axes {
        signs,
        is_z_up: false,
    };
    let axes = |said: Option<Axes>| match turn {
        true => said.unwrap_or(as_they_are(RIGHT_UP_BACK)),
        false => as_they_are([1.0; 3]),
    };
    if bytes.starts_with(MAGIC) {
        let header = SpzHeader::read(bytes)?;
        return match header.version {
            4 => read_streams(&header, bytes, axes),
            _ => {
                let mut rest = Bytes(bytes);
                rest.take(HEADER, "the header")?;
                let runs = rest.take(header.size(), "the Gaussians")?;
                let said = said(&header, rest.0)?;
                let mut made = header.made(split(&header, runs), axes(said))?;
                made.report.trailing_bytes = trailing(&header, rest.0.len() as u64);
                Ok(made)
            }
        };
    }
    let mut gzip = Gzip::new(bytes);
    let header = SpzHeader::read(&gzip.next(HEADER)?)?;
    if header.version == 4 {
        return Err(Failure::Format(
            ".spz of version 4 is not compressed as a whole; decompress it with gzip first".into(),
        ));
    }
    if !inflate::may_become(bytes.len(), header.size()) {
        return Err(too_many(&header));
    }
    let runs = gzip.next(header.size())?;
    if (runs.len() as u64) < header.size() {
        return Err(too_many(&header));
    }
    let after = gzip.next(MOST_EXTENSIONS)?;
    let left = after.len() as u64 + gzip.rest()?;
    let said = said(&header, &after)?;
    let mut made = header.made(split(&header, &runs), axes(said))?;
    made.report.trailing_bytes = trailing(&header, left);
    Ok(made)
}

fn too_many(header: &SpzHeader) -> Failure {
    Failure::Format(format!(
        "the header promises {}, for which the file is too short; it is cut off, get it again",
        counted(header.count, "Gaussian")
    ))
}

fn said(header: &SpzHeader, after: &[u8]) -> Result<Option<Axes>, String> {
    match header.flags & HAS_EXTENSIONS {
        0 => Ok(None),
        _ => extensions(after),
    }
}

/// What follows the Gaussians is nothing where it is said to be there.
fn trailing(header: &SpzHeader, left: u64) -> u64 {
    if header.flags & HAS_EXTENSIONS == 0 {
        left
    } else {
        0
    }
}

/// The runs of a payload of the header's size.
fn split<'a>(header: &SpzHeader, mut payload: &'a [u8]) -> [&'a [u8]; 6] {
    header.sizes().map(|size| {
        let (run, rest) = payload.split_at((size * header.count) as usize);
        payload = rest;
        run
    })
}

/// Version 4: a table of streams, one for each run.
fn read_streams(
    header: &SpzHeader,
    bytes: &[u8],
    axes: impl Fn(Option<Axes>) -> Axes,
) -> Result<FormatOutput, Failure> {
    if !inflate::may_become(bytes.len(), header.size()) {
        return Err(too_many(header));
    }
    let mut rest = Bytes(bytes);
    let mut head = Bytes(rest.take(HEADER_4, "the header")?);
    head.take(HEADER, "the header")?;
    let table = u64::from(head.u32("the header")?);
    let before = table.checked_sub(HEADER_4).ok_or_else(|| {
        format!("its table of streams is said to be at byte {table}, inside the header; export the scene again")
    })?;
    let said = said(
        header,
        rest.take(before, "what is before the table of streams")?,
    )?;
    let mut table = Bytes(rest.take(16 * u64::from(header.streams), "the table of streams")?);
    let mut runs: [Vec<u8>; 6] = Default::default();
    let names = [
        "positions",
        "opacities",
        "colours",
        "scales",
        "rotations",
        "spherical harmonics",
    ];
    for (number, size) in header.sizes().into_iter().enumerate() {
        let (needed, name) = (size * header.count, names[number]);
        if number >= usize::from(header.streams) {
            if needed == 0 {
                continue;
            }
            return Err(Failure::Format(format!(
                "it has {}, and none for the {name}; export the scene again",
                counted(header.streams, "stream")
            )));
        }
        let (stored, plain) = (table.u64(name)?, table.u64(name)?);
        let stream = rest.take(stored, name)?;
        if plain != needed {
            return Err(Failure::Format(format!(
                "the stream of the {name} is said to have {}, but that of {} has {needed}; export the scene again",
                counted(plain, "byte"),
                counted(header.count, "Gaussian")
            )));
        }
        runs[number] = inflate::zstd(stream, needed, &format!("the {name}"))?;
    }
    let more = usize::from(header.streams).saturating_sub(6);
    for _ in 0..more {
        let (stored, _) = (table.u64("another stream")?, table.u64("another stream")?);
        rest.take(stored, "another stream")?;
    }
    let mut made = header.made(runs.each_ref().map(Vec::as_slice), axes(said))?;
    if more > 0 {
        made.report.note(format!(
            "left out {more} stream(s) that no known attribute is in"
        ));
    }
    made.report.trailing_bytes = rest.0.len() as u64;
    Ok(made)
}
