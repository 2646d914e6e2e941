//! Writing `.spz`: version 3 where none is asked for, which all readers of the last years know.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;
use structured_zstd::encoding::{CompressionLevel, compress_slice_to_vec};

use super::super::super::Gaussians;
use super::super::spz::{ANTIALIASED, COLOUR, HEADER_4, MAGIC, RIGHT_UP_BACK, signs};
use super::{Ranges, byte, smallest_three};
use rara_base::error::{Error, Result};

/// The most bits behind the point of a position that are used.
const MOST_BITS: u32 = 16;

/// The level of zstd by which files of version 4 are smaller than by the gzip of version 3, in less time.
const LEVEL: i32 = 9;

/// With half a step more at each end.
pub(super) const RANGES: Ranges = Ranges {
    logs: [-10.0 - 0.5 / 16.0, -10.0 + 255.5 / 16.0],
    colours: [(-0.5 - 0.5 / 255.0) / COLOUR, (0.5 + 0.5 / 255.0) / COLOUR],
    coefficients: [-128.5 / 128.0, 127.5 / 128.0],
};

pub(super) fn encode(gaussians: &Gaussians, version: u32) -> Result<Vec<u8>> {
    let largest = gaussians.positions().iter().map(|p| p.abs().max_element());
    let largest = f64::from(largest.fold(0.0, f32::max));
    let fits = |bits: &u32| largest * f64::from(1 << *bits) < f64::from(1 << 23) - 1.0;
    let bits = (0..=MOST_BITS).rev().find(fits).ok_or_else(|| {
        Error::Invalid(format!(
            "a centre is {largest:e} from the origin, and .spz holds up to 8 million; scale the scene down"
        ))
    })?;
    let mut file = MAGIC.to_vec();
    file.extend(version.to_le_bytes());
    file.extend((gaussians.len() as u32).to_le_bytes());
    let flags = match gaussians.is_antialiased() {
        true => ANTIALIASED,
        false => 0,
    };
    let runs = runs(gaussians, version, bits);
    let [degree, bits] = [gaussians.sh_degree(), bits].map(|number| number as u8);
    match version {
        2 | 3 => {
            file.extend([degree, bits, flags, 0]);
            file.extend(runs.into_iter().flatten());
            let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
            let packed = gzip.write_all(&file).and_then(|()| gzip.finish());
            packed.map_err(|error| {
                Error::Memory(format!("the scene could not be compressed: {error}"))
            })
        }
        4 => {
            // Without harmonics there is no stream of them.
            let runs = &runs[..if degree == 0 { 5 } else { 6 }];
            file.extend([degree, bits, flags, runs.len() as u8]);
            file.extend((HEADER_4 as u32).to_le_bytes());
            file.resize(HEADER_4 as usize, 0);
            let streams = runs.iter().map(|run| {
                let stream = compress_slice_to_vec(run, CompressionLevel::from_level(LEVEL));
                (stream, run.len())
            });
            let streams: Vec<_> = streams.collect();
            for (stream, plain) in &streams {
                file.extend((stream.len() as u64).to_le_bytes());
                file.extend((*plain as u64).to_le_bytes());
            }
            file.extend(streams.into_iter().flat_map(|(stream, _)| stream));
            Ok(file)
        }
        _ => Err(Error::Invalid(format!(
            ".spz of version {version} is not written; give 2, 3 or 4"
        ))),
    }
}

/// The attributes in the order of the file.
fn runs(gaussians: &Gaussians, version: u32, bits: u32) -> [Vec<u8>; 6] {
    let count = gaussians.len();
    let [
        mut positions,
        mut colours,
        mut scales,
        mut rotations,
        mut harmonics,
    ] = [const { Vec::new() }; 5];
    for position in gaussians.positions() {
        for (value, sign) in position.to_array().into_iter().zip(RIGHT_UP_BACK) {
            let steps = (f64::from(value) * sign * f64::from(1 << bits)).round() as i32;
            positions.extend(&steps.to_le_bytes()[..3]);
        }
    }
    let opacities = gaussians.opacities().iter();
    let opacities = opacities.map(|&opacity| byte(opacity.into())).collect();
    let colour = |&value: &f32| byte(f64::from(value) * COLOUR + 0.5);
    (0..count).for_each(|at| colours.extend(gaussians.sh_of(at)[..3].iter().map(colour)));
    for scale in gaussians.scales() {
        // ln 0 is below all that there is, and becomes the least.
        scales.extend(scale.to_array().map(|scale| {
            let steps = (f64::from(scale).ln() + 10.0) * 16.0;
            steps.round().clamp(0.0, 255.0) as u8
        }));
    }
    for q in gaussians.rotations() {
        let [x, y, z] = RIGHT_UP_BACK.map(|sign| sign as f32);
        let turned = [q.x * x, q.y * y, q.z * z, q.w];
        if version == 2 {
            let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
            let part = |&part: &f32| byte(f64::midpoint(f64::from(part) * sign, 1.0));
            rotations.extend(turned[..3].iter().map(part));
            continue;
        }
        let (largest, others) = smallest_three(turned);
        let packed = others.iter().fold(largest, |packed, part| {
            let length = (part.abs() * std::f64::consts::SQRT_2 * 511.0)
                .round()
                .min(511.0) as u32;
            packed << 10 | u32::from(*part < 0.0) << 9 | length
        });
        rotations.extend(packed.to_le_bytes());
    }
    let signs = signs(RIGHT_UP_BACK);
    for at in 0..count {
        let rest = gaussians.sh_of(at)[3..].iter().enumerate();
        harmonics.extend(rest.map(|(number, &value)| {
            let steps = f64::from(value) * signs[number / 3] * 128.0 + 128.0;
            steps.round().clamp(0.0, 255.0) as u8
        }));
    }
    [positions, opacities, colours, scales, rotations, harmonics]
}
