//! Gaussians to the bytes of a file, one file a format.

mod codebook;
mod glb;
mod packed;
mod sog;
mod spz;

use glam::Vec3;

use super::super::{Format, Gaussians, SaveOptions};
use rara_base::error::Result;

/// How files of a format are written.
pub(in super::super) struct Writer {
    pub(in super::super) format: Format,
    /// The ending of their names.
    pub(in super::super) ending: &'static str,
    encode: fn(&Gaussians, &SaveOptions) -> Result<Vec<u8>>,
    ranges: Ranges,
}

pub(in super::super) const WRITERS: [Writer; 4] = [
    Writer {
        format: Format::CompressedPly,
        ending: ".compressed.ply",
        encode: |gaussians, _| Ok(packed::encode(gaussians)),
        ranges: packed::RANGES,
    },
    Writer {
        format: Format::Spz,
        ending: ".spz",
        encode: |gaussians, options| spz::encode(gaussians, options.spz_version),
        ranges: spz::RANGES,
    },
    Writer {
        format: Format::Sog,
        ending: ".sog",
        encode: |gaussians, _| sog::encode(gaussians),
        ranges: sog::RANGES,
    },
    Writer {
        format: Format::Gltf,
        ending: ".glb",
        encode: |gaussians, options| glb::encode(gaussians, options.annotations.as_ref()),
        ranges: Ranges::ALL,
    },
];

impl Writer {
    /// The bytes of a file, and how many Gaussians have a number that it holds no nearer than at an end of its range.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara_base::error::Error::Invalid) for Gaussians that it cannot hold.
    pub(in super::super) fn encode(
        &self,
        gaussians: &Gaussians,
        options: &SaveOptions,
    ) -> Result<(Vec<u8>, u64)> {
        let bytes = (self.encode)(gaussians, options)?;
        let beyond = |&at: &usize| !self.ranges.hold(gaussians, at);
        Ok((bytes, (0..gaussians.len()).filter(beyond).count() as u64))
    }
}

/// The ends of what a format holds: logarithms of scales, and coefficients of degree 0 and above.
struct Ranges {
    logs: [f64; 2],
    colours: [f64; 2],
    coefficients: [f64; 2],
}

/// All numbers there are.
const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Ranges {
    const ALL: Self = Self {
        logs: ANY,
        colours: ANY,
        coefficients: ANY,
    };

    /// Whether a Gaussian is within them.
    fn hold(&self, gaussians: &Gaussians, at: usize) -> bool {
        let within = |value: f64, [low, high]: [f64; 2]| (low..=high).contains(&value);
        let (colour, rest) = gaussians.sh_of(at).split_at(3);
        let scales = gaussians.scales()[at].to_array();
        scales.iter().all(|&s| within(f64::from(s).ln(), self.logs))
            && colour.iter().all(|&c| within(c.into(), self.colours))
            && rest.iter().all(|&c| within(c.into(), self.coefficients))
    }
}

/// The Gaussians' numbers along a space-filling curve through their centres, so that neighbours in a file are alike.
fn along_a_curve(gaussians: &Gaussians) -> Vec<u32> {
    let all = gaussians.positions();
    let [low, high] = corners(all).map(|corner| corner.as_dvec3());
    let cells = 1023.0 / (high - low).max(glam::DVec3::splat(f64::MIN_POSITIVE));
    let key = |position: &glam::Vec3| {
        let cell = ((position.as_dvec3() - low) * cells).as_uvec3();
        let spread = |value: u32| (0..10).fold(0, |key, bit| key | (value >> bit & 1) << (3 * bit));
        spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
    };
    let keys: Vec<u32> = all.iter().map(key).collect();
    let mut order: Vec<u32> = (0..all.len() as u32).collect();
    order.sort_by_key(|&index| keys[index as usize]);
    order
}

/// The corners of the box around centres with the least and the greatest coordinates.
fn corners(centres: &[Vec3]) -> [Vec3; 2] {
    [Vec3::min, Vec3::max].map(|pick| centres.iter().copied().reduce(pick).unwrap_or_default())
}

/// A byte of a share from 0 to 1.
fn byte(share: f64) -> u8 {
    (share * 255.0).round().clamp(0.0, 255.0) as u8
}

/// The place of a unit quaternion's largest part among `parts`, and the others with the sign that makes it positive.
fn smallest_three(parts: [f32; 4]) -> (u32, [f64; 3]) {
    let is_larger = |a: &usize, b: &usize| parts[*a].abs().total_cmp(&parts[*b].abs());
    // The first of several.
    let largest = (0..4).rev().max_by(is_larger).unwrap_or_default();
    let sign = if parts[largest] < 0.0 { -1.0 } else { 1.0 };
    let mut others = (0..4).filter(|place| *place != largest);
    let others = [(); 3].map(|()| {
        let place = others.next().unwrap_or_default();
        sign * f64::from(parts[place])
    });
    (largest as u32, others)
}
