//! `.ksplat`: sections of Gaussians, in full precision or relative to the centres of buckets.

use std::ops::Range;

use super::super::assemble::{ColumnForm, OPACITY, ROWS, SCALES, SH, SLOTS};
use super::super::sh_coefficients;
use super::bytes::{Bytes, f16_at, f32_at, u16_at};
use super::{Failure, FormatOutput, colour, room};
use rara_base::counted::counted;

/// Bytes of the file's header, and of each section's.
const HEADER: u64 = 4096;
const SECTION: u64 = 1024;
/// Half the steps along a bucket's side where a section does not say.
const STEPS: u32 = 32767;
/// The range of spherical harmonics in bytes where the file does not say.
const SH_RANGE: f32 = 1.5;

struct KsplatHeader {
    version: [u8; 2],
    /// Section headers that there is room for, and those in use (0 for all).
    sections: u32,
    used: u32,
    splats: u32,
    level: u16,
    /// The least and the greatest coefficient in bytes.
    sh_range: [f32; 2],
}

fn header(bytes: &[u8]) -> Result<KsplatHeader, String> {
    let mut bytes = Bytes(bytes);
    let what = "the header";
    let version = [bytes.u8(what)?, bytes.u8(what)?];
    bytes.u16(what)?;
    let (sections, used) = (bytes.u32(what)?, bytes.u32(what)?);
    bytes.u32(what)?;
    let (splats, level) = (bytes.u32(what)?, bytes.u16(what)?);
    bytes.take(14, what)?; // nothing, and the middle of the scene
    let [low, high] = [bytes.f32(what)?, bytes.f32(what)?];
    let or = |value: f32, default: f32| if value == 0.0 { default } else { value };
    Ok(KsplatHeader {
        version,
        sections,
        used,
        splats,
        level,
        sh_range: [or(low, -SH_RANGE), or(high, SH_RANGE)],
    })
}

/// True where the header's numbers fit each other and a file of `total` bytes; it has no mark of its own.
pub(super) fn is(start: &[u8], total: u64) -> bool {
    header(start).is_ok_and(|header| {
        let least = HEADER + SECTION * u64::from(header.sections);
        let each = record(header.level, 0);
        header.version[0] == 0
            && header.version[1] > 0
            && header.sections > 0
            && header.used <= header.sections
            && each.is_some_and(|each| {
                total.saturating_sub(least) / each as u64 >= u64::from(header.splats)
            })
    })
}

/// Bytes of one Gaussian at a level of compression; `None` for a level that there is not.
fn record(level: u16, degree: u32) -> Option<usize> {
    let coefficients = 3 * (sh_coefficients(degree) - 1);
    Some(match level {
        0 => 44 + 4 * coefficients,
        1 => 24 + 2 * coefficients,
        2 => 24 + coefficients,
        _ => return None,
    })
}

/// A section as its header describes it.
struct Section<'a> {
    degree: u32,
    /// Bytes of one Gaussian.
    record: usize,
    records: &'a [u8],
    bucket_size: u64,
    /// Centres of the buckets.
    buckets: &'a [u8],
    bucket_bytes: usize,
    /// World units of a step.
    step: f64,
    steps: f64,
    full: u64,
    /// How many Gaussians each bucket that is not full has.
    partial: &'a [u8],
}

impl<'a> Section<'a> {
    /// The section whose header is `head`; its data is next in `data`.
    fn read(head: &'a [u8], data: &mut Bytes<'a>, level: u16, number: u32) -> Result<Self, String> {
        let what = &format!("section {number}");
        let mut head = Bytes(head);
        let (splats, room) = (head.u32(what)?, head.u32(what)?);
        let (bucket_size, buckets) = (head.u32(what)?, head.u32(what)?);
        let block = head.f32(what)?;
        let bucket_bytes = head.u16(what)?;
        head.u16(what)?;
        let steps = head.u32(what)?;
        head.u32(what)?;
        let (full, partial) = (head.u32(what)?, head.u32(what)?);
        let degree = u32::from(head.u16(what)?);
        if degree > 3 {
            return Err(format!(
                "{what} has spherical harmonics of degree {degree}; 0 to 3 can be read, export the scene again"
            ));
        }
        let record = record(level, degree).unwrap_or(0);
        let room = if room == 0 { splats } else { room };
        if splats > room {
            return Err(format!(
                "{what} promises {} in room for {room}; export the scene again",
                counted(splats, "Gaussian")
            ));
        }
        let quantised = level > 0 && splats > 0;
        if quantised && (bucket_bytes < 12 || buckets == 0 || bucket_size == 0) {
            return Err(format!(
                "{what} has no buckets, which its Gaussians are relative to; export the scene again"
            ));
        }
        let partial = data.take(4 * u64::from(partial), what)?;
        let buckets = data.take(u64::from(bucket_bytes) * u64::from(buckets), what)?;
        let records = data.take(record as u64 * u64::from(room), what)?;
        let steps = f64::from(if steps == 0 { STEPS } else { steps });
        Ok(Self {
            degree,
            record,
            records: &records[..record * splats as usize],
            bucket_size: bucket_size.into(),
            buckets,
            bucket_bytes: usize::from(bucket_bytes).max(1),
            step: f64::from(block) / 2.0 / steps,
            steps,
            full: full.into(),
            partial,
        })
    }

    /// The bucket of each Gaussian, in their order.
    fn buckets(&self) -> impl Iterator<Item = usize> + '_ {
        let partial = self.partial.chunks_exact(4);
        let partial = partial.map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
        let full = std::iter::repeat_n(self.bucket_size, self.full as usize);
        // Where no bucket is said to be partly filled, the last one may be.
        let all = full.chain(partial).chain(std::iter::once(self.bucket_size));
        all.enumerate()
            .flat_map(|(bucket, count)| std::iter::repeat_n(bucket, count as usize))
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<FormatOutput, Failure> {
    let header = header(bytes)?;
    if record(header.level, 0).is_none() {
        return Err(Failure::Format(format!(
            "compression level {} is not known; 0, 1 and 2 are read, export the scene with one of them",
            header.level
        )));
    }
    let mut data = Bytes(bytes);
    data.take(HEADER, "the header")?;
    let heads = data.take(
        SECTION * u64::from(header.sections),
        "the sections' headers",
    )?;
    let used = if header.used == 0 {
        header.sections
    } else {
        header.used
    };
    let heads = heads.chunks_exact(SECTION as usize).take(used as usize);
    let mut sections = Vec::new();
    for (number, head) in (0..).zip(heads) {
        sections.push(Section::read(head, &mut data, header.level, number)?);
    }
    let count: u64 = sections
        .iter()
        .map(|s| (s.records.len() / s.record) as u64)
        .sum();
    let degree = sections.iter().map(|section| section.degree).max();
    let mut made = room(count, degree.unwrap_or(0), ColumnForm::Plain)?;
    let mut records = sections.iter().flat_map(|section| {
        let mut buckets = section.buckets();
        let records = section.records.chunks_exact(section.record).enumerate();
        records.map(move |(index, record)| {
            let bucket = match header.level {
                0 => 0, // there are none
                _ => buckets.next().unwrap_or(usize::MAX),
            };
            (section, index, record, bucket)
        })
    });
    let read = |numbers: Range<u64>| {
        let count = (numbers.end - numbers.start) as usize;
        Ok(records.by_ref().take(count).collect::<Vec<_>>())
    };
    made.read(ROWS, read, |records, rows| {
        for (section, index, record, bucket) in records {
            let mut row = [0.0; SLOTS];
            if header.level == 0 {
                (0..OPACITY).for_each(|slot| row[slot] = f32_at(record, 4 * slot));
            } else {
                let centre = section
                    .buckets
                    .chunks_exact(section.bucket_bytes)
                    .nth(bucket);
                let centre = centre.ok_or_else(|| {
                    format!("Gaussian {index} of a section is in bucket {bucket}, which the file does not have; export the scene again")
                })?;
                for (axis, to) in row[..SCALES].iter_mut().enumerate() {
                    let steps = f64::from(u16_at(record, 2 * axis)) - section.steps;
                    *to = steps * section.step + f32_at(centre, 4 * axis);
                }
                (SCALES..OPACITY).for_each(|slot| row[slot] = f16_at(record, 2 * slot));
            }
            let at = if header.level == 0 { 40 } else { 20 };
            (0..3).for_each(|channel| row[SH + channel] = colour(record[at + channel]));
            row[OPACITY] = f64::from(record[at + 3]) / 255.0;
            harmonics(
                &record[at + 4..],
                section.degree,
                &header,
                &mut row[SH + 3..],
            );
            rows.push(&row);
        }
        Ok(())
    })?;
    made.report.trailing_bytes = data.0.len() as u64;
    Ok(made.into())
}

/// Spherical harmonics above degree 0, which lie degree by degree and, in each, channel by channel.
fn harmonics(bytes: &[u8], degree: u32, header: &KsplatHeader, to: &mut [f64]) {
    let [low, high] = header.sh_range.map(f64::from);
    let number = |index: usize| match header.level {
        0 => f32_at(bytes, 4 * index),
        1 => f16_at(bytes, 2 * index),
        _ => low + (high - low) * f64::from(bytes[index]) / 255.0,
    };
    let mut next = 0;
    for band in 1..=degree {
        let first = sh_coefficients(band - 1) - 1;
        let count = 2 * band as usize + 1;
        for channel in 0..3 {
            for coefficient in first..first + count {
                to[3 * coefficient + channel] = number(next);
                next += 1;
            }
        }
    }
}
