//! Writing `.spz`, version 3, which all readers of the last years know.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::super::super::Gaussians;
use super::super::spz::{ANTIALIASED, COLOUR, RIGHT_UP_BACK, signs};
use super::{Ranges, byte, smallest_three};
use rara_base::error::{Error, Result};

/// The most bits behind the point of a position that are used.
const MOST_BITS: u32 = 16;

/// With half a step more at each end.
pub(super) const RANGES: Ranges = Ranges {
    logs: [-10.0 - 0.5 / 16.0, -10.0 + 255.5 / 16.0],
    colours: [(-0.5 - 0.5 / 255.0) / COLOUR, (0.5 + 0.5 / 255.0) / COLOUR],
    coefficients: [-128.5 / 128.0, 127.5 / 128.0],
};

pub(super) fn encode(gaussians: &Gaussians) -> Result<Vec<u8>> {
    let largest = gaussians.positions().iter().map(|p| p.abs().max_element());
    let largest = f64::from(largest.fold(0.0, f32::max));
    let fits = |bits: &u32| largest * f64::from(1 << *bits) < f64::from(1 << 23) - 1.0;
    let bits = (0..=MOST_BITS).rev().find(fits).ok_or_else(|| {
        Error::Invalid(format!(
            "a centre is {largest:e} from the origin, and .spz holds up to 8 million; scale the scene down"
        ))
    })?;
    let count = gaussians.len();
    let mut plain = b"NGSP".to_vec();
    plain.extend(3_u32.to_le_bytes());
    plain.extend((count as u32).to_le_bytes());
    let flags = match gaussians.is_antialiased() {
        true => ANTIALIASED,
        false => 0,
    };
    plain.extend([gaussians.sh_degree() as u8, bits as u8, flags, 0]);
    for position in gaussians.positions() {
        for (value, sign) in position.to_array().into_iter().zip(RIGHT_UP_BACK) {
            let steps = (f64::from(value) * sign * f64::from(1 << bits)).round() as i32;
            plain.extend(&steps.to_le_bytes()[..3]);
        }
    }
    plain.extend(
        gaussians
            .opacities()
            .iter()
            .map(|&opacity| byte(opacity.into())),
    );
    let colour = |&value: &f32| byte(f64::from(value) * COLOUR + 0.5);
    (0..count).for_each(|at| plain.extend(gaussians.sh_of(at)[..3].iter().map(colour)));
    for scale in gaussians.scales() {
        // ln 0 is below all that there is, and becomes the least.
        plain.extend(scale.to_array().map(|scale| {
            let steps = (f64::from(scale).ln() + 10.0) * 16.0;
            steps.round().clamp(0.0, 255.0) as u8
        }));
    }
    for q in gaussians.rotations() {
        let [x, y, z] = RIGHT_UP_BACK.map(|sign| sign as f32);
        let (largest, others) = smallest_three([q.x * x, q.y * y, q.z * z, q.w]);
        let packed = others.iter().fold(largest, |packed, part| {
            let length = (part.abs() * std::f64::consts::SQRT_2 * 511.0)
                .round()
                .min(511.0) as u32;
            packed << 10 | u32::from(*part < 0.0) << 9 | length
        });
        plain.extend(packed.to_le_bytes());
    }
    let signs = signs(RIGHT_UP_BACK);
    for at in 0..count {
        let rest = gaussians.sh_of(at)[3..].iter().enumerate();
        plain.extend(rest.map(|(number, &value)| {
            let steps = f64::from(value) * signs[number / 3] * 128.0 + 128.0;
            steps.round().clamp(0.0, 255.0) as u8
        }));
    }
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    let packed = gzip.write_all(&plain).and_then(|()| gzip.finish());
    packed.map_err(|error| Error::Memory(format!("the scene could not be compressed: {error}")))
}
