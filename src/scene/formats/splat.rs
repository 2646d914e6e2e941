//! `.splat`: nothing but records of 32 bytes, so that only their content tells them from something else.

use super::super::assemble::{ColumnForm, OPACITY, ROTATION, SCALES, SH};
use super::bytes::f32_at;
use super::{Failure, FormatOutput, colour, room};

/// Bytes of one Gaussian: centre and scales in single precision, red, green, blue and opacity, and the quaternion, w
/// first, in bytes about 128.
const RECORD: usize = 32;

/// True where the records that `start` holds whole look like Gaussians and `total` bytes are a number of them. Random
/// bytes do so in one of ten thousand records.
pub(super) fn is(start: &[u8], total: u64) -> bool {
    let records = start.chunks_exact(RECORD);
    let count = records.len();
    let plausible = records.filter(|record| is_plausible(record)).count();
    total > 0 && total.is_multiple_of(RECORD as u64) && count > 0 && 4 * plausible >= 3 * count
}

fn is_plausible(record: &[u8]) -> bool {
    let number = |index: usize| f32_at(record, 4 * index);
    let length: f64 = quaternion(record).map(|q| q * q).iter().sum();
    let is_near = |index: usize| number(index).abs() < 1e9;
    let is_scale = |index: usize| (0.0..1e6).contains(&number(index));
    (0..3).all(is_near) && (SCALES..SCALES + 3).all(is_scale) && (0.8..1.25).contains(&length)
}

fn quaternion(record: &[u8]) -> [f64; 4] {
    [28, 29, 30, 31].map(|at| (f64::from(record[at]) - 128.0) / 128.0)
}

pub(super) fn read(bytes: &[u8]) -> Result<FormatOutput, Failure> {
    let count = bytes.len() / RECORD;
    let made = room(count as u64, 0, ColumnForm::Plain)?.make(|number, row| {
        let record = &bytes[number * RECORD..][..RECORD];
        for (slot, to) in row[..ROTATION].iter_mut().enumerate() {
            *to = f32_at(record, 4 * slot);
        }
        row[ROTATION..OPACITY].copy_from_slice(&quaternion(record));
        row[OPACITY] = f64::from(record[27]) / 255.0;
        for channel in 0..3 {
            row[SH + channel] = colour(record[24 + channel]);
        }
        Ok(())
    })?;
    Ok(made.into())
}
