//! SOG: attributes as the pixels of WebP pictures, and a `meta.json` that says what their values mean.

mod meta;
mod picture;
mod streamed;

use serde_json::Value;

use self::meta::{Meta, Range};
use self::picture::Picture;
use super::super::assemble::{ColumnForm, OPACITY, ROTATION, SCALES, SH, unit_quaternion};
use super::{Failure, Files, FormatOutput, room};
use rara_base::counted::counted;
use rara_base::error::shortened;

pub(super) use self::streamed::read as read_streamed;

/// Centroids in a row of the picture of spherical harmonics.
pub(super) const CENTROIDS: usize = 64;
/// Sets of spherical harmonics that labels can name.
const MOST_SETS: u64 = 1 << 16;
/// The alpha of a rotation's pixel is this and the place of its largest part.
pub(super) const LARGEST: u8 = 252;

/// Gaussians that a byte of the pictures may stand for, beside a few: of most scenes a Gaussian takes several bytes, but
/// what is all the same takes hardly any.
const MOST_OF_BYTE: u64 = 16;
const FEW: u64 = 1 << 16;

/// Reads what a `meta.json` describes, of whose pictures these are the files.
pub(super) fn read(document: &Value, pictures: Files<'_>) -> Result<FormatOutput, Failure> {
    let get = |name| pictures.get(name);
    let meta = Meta::from_json(document)?;
    let count = meta.count;
    let names = [
        meta.means[0],
        meta.means[1],
        meta.scales.0,
        meta.quats,
        meta.sh0.0,
    ];
    let files = names.map(get).into_iter().collect::<Result<Vec<_>, _>>()?;
    let stored: usize = files.iter().map(Vec::len).sum();
    if count > MOST_OF_BYTE * stored as u64 + FEW {
        return Err(Failure::Format(format!(
            "meta.json promises {}, which its pictures of {} cannot hold; get the scene again",
            counted(count, "Gaussian"),
            counted(stored, "byte")
        )));
    }
    let plane = |name: &str, file: &[u8]| -> Result<Picture, Failure> {
        let picture = Picture::decode(file, name, picture::most(count))?;
        if (picture.pixels().len() as u64) < count {
            return Err(Failure::Format(format!(
                "the picture {} has {} for its {}; get the scene again",
                shortened(name),
                counted(picture.pixels().len(), "pixel"),
                counted(count, "Gaussian")
            )));
        }
        Ok(picture)
    };
    let planes = names.iter().zip(&files);
    let planes: Vec<_> = planes
        .map(|(name, file)| plane(name, file))
        .collect::<Result<_, _>>()?;
    drop(files);
    let [low, high, scales, quats, sh0] = [0, 1, 2, 3, 4].map(|at| &planes[at]);
    let harmonics = match &meta.harmonics {
        Some(harmonics) => {
            let centroids = get(harmonics.centroids)?;
            let most = harmonics.count.unwrap_or(MOST_SETS) as usize;
            let most = CENTROIDS * 24 * most.div_ceil(CENTROIDS);
            let centroids = Picture::decode(&centroids, harmonics.centroids, most)?;
            let degree = harmonics.degree(centroids.width)?;
            let rows = centroids.pixels().len() / centroids.width;
            let room = (CENTROIDS * rows) as u64;
            let sets = harmonics.count.unwrap_or(room.min(MOST_SETS));
            if room < sets {
                return Err(Failure::Format(format!(
                    "the picture {} has room for {room} of {sets} sets of spherical harmonics; get the scene again",
                    shortened(harmonics.centroids),
                )));
            }
            Some((
                harmonics,
                sets,
                degree,
                centroids,
                plane(harmonics.labels, &get(harmonics.labels)?)?,
            ))
        }
        None => None,
    };
    let stored_degree = harmonics.as_ref().map_or(0, |(_, _, degree, ..)| *degree);
    let degree = stored_degree.min(3);
    let stored = if meta.is_first {
        ColumnForm::Logarithms
    } else {
        ColumnForm::LogScales
    };
    let made = room(count, stored_degree, stored)?.make(|index, row| {
        for axis in 0..3 {
            let value = u16::from_le_bytes([low.at(index)[axis], high.at(index)[axis]]);
            let [least, most] = meta.bounds[axis];
            let log = least + (most - least) * f64::from(value) / 65535.0;
            row[axis] = log.signum() * log.abs().exp_m1();
            row[SCALES + axis] = meta.scales.1.value(axis, scales.at(index)[axis]);
            row[SH + axis] = meta.sh0.1.value(axis, sh0.at(index)[axis]);
        }
        row[OPACITY] = match meta.sh0.1 {
            Range::Codebook(_) => f64::from(sh0.at(index)[3]) / 255.0,
            Range::Ends(_) => meta.sh0.1.value(3, sh0.at(index)[3]),
        };
        let [a, b, c, tag] = quats.at(index);
        let largest = tag.checked_sub(LARGEST).ok_or_else(|| {
            format!(
                "the rotation of Gaussian {index} has the mark {tag}, where {LARGEST} to 255 are possible; get the scene \
                 again"
            )
        })?;
        let part = |byte: u8| (f64::from(byte) / 255.0 - 0.5) * std::f64::consts::SQRT_2;
        let rotation = unit_quaternion(largest.into(), [part(a), part(b), part(c)]);
        row[ROTATION..OPACITY].copy_from_slice(&rotation);
        if let Some((harmonics, sets, stored, centroids, labels)) = &harmonics {
            let [low, high, ..] = labels.at(index);
            let label = usize::from(u16::from_le_bytes([low, high]));
            if label as u64 >= *sets {
                return Err(Failure::Format(format!(
                    "Gaussian {index} has the spherical harmonics of set {label}, of {sets} sets; get the scene again"
                )));
            }
            let stored = super::super::sh_coefficients(*stored) - 1;
            let first = label / CENTROIDS * centroids.width + label % CENTROIDS * stored;
            for coefficient in 0..super::super::sh_coefficients(degree) - 1 {
                let pixel = centroids.at(first + coefficient);
                for channel in 0..3 {
                    let value = harmonics.values.value(0, pixel[channel]);
                    row[SH + 3 + 3 * coefficient + channel] = value;
                }
            }
        }
        Ok(())
    })?;
    let mut made = FormatOutput::from(made);
    made.others = meta::others(document);
    made.gaussians.train(meta.training);
    Ok(made)
}
