//! Writing `.compressed.ply`.

use glam::{DVec3, Vec3};

use super::super::super::save::training_comments;
use super::super::super::{Gaussians, SH_0};
use super::{ANY, Ranges, byte, smallest_three};

/// Gaussians in a chunk.
const CHUNK: usize = 256;
/// Logarithms of scales that are written, at most and at least.
const LOG: f64 = 20.0;

pub(super) const RANGES: Ranges = Ranges {
    logs: [-LOG, LOG],
    colours: ANY,
    coefficients: [-4.0, 4.0],
};

/// Steps of a chunk's range, in 11, 10 and 11 bits.
const STEPS: DVec3 = DVec3::new(2047.0, 1023.0, 2047.0);

/// The ends of a chunk's values of three parts.
struct Range([f32; 3], [f32; 3]);

impl Range {
    fn around(values: &[[f64; 3]]) -> Self {
        let side = |pick: fn(f32, f32) -> f32, start: f32| {
            std::array::from_fn(|part| {
                values
                    .iter()
                    .map(|value| value[part] as f32)
                    .fold(start, pick)
            })
        };
        Self(
            side(f32::min, f32::INFINITY),
            side(f32::max, f32::NEG_INFINITY),
        )
    }

    /// The share of the range below a part of a value.
    fn share(&self, part: usize, value: f64) -> f64 {
        let (low, high) = (f64::from(self.0[part]), f64::from(self.1[part]));
        let size = high - low;
        if size > 0.0 {
            ((value - low) / size).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

/// Orders Gaussians so that those of a chunk are close together: it cuts them across the longest side of their box, down to chunks
/// that are as wide as deep. Chunks of a space-filling curve would be as large as the scene where the curve jumps.
fn gather(order: &mut [u32], positions: &[Vec3]) {
    let chunks = order.len().div_ceil(CHUNK);
    if chunks <= 1 {
        return;
    }
    let corner = |pick: fn(Vec3, Vec3) -> Vec3| {
        let centres = order.iter().map(|&at| positions[at as usize]);
        centres.reduce(pick).unwrap_or_default()
    };
    let sides = (corner(Vec3::max).as_dvec3() - corner(Vec3::min).as_dvec3()) / STEPS;
    let axis = sides.max_position();
    // The side of a chunk in a row of them, a layer, or a block.
    let mut sorted = sides.to_array();
    sorted.sort_by(f64::total_cmp);
    let [c, b, a] = sorted;
    let count = chunks as f64;
    let side = (a / count)
        .max((a * b / count).sqrt().min(b))
        .max((a * b * c / count).cbrt().min(c));
    let across = (a / side).round().clamp(2.0, count);
    let below = count * (across / 2.0).floor() / across;
    let middle = (below.round() as usize).clamp(1, chunks - 1) * CHUNK;
    let along = |at: u32| positions[at as usize][axis];
    order.select_nth_unstable_by(middle, |&a, &b| {
        along(a).total_cmp(&along(b)).then(a.cmp(&b))
    });
    let (below, above) = order.split_at_mut(middle);
    gather(below, positions);
    gather(above, positions);
}

pub(super) fn encode(gaussians: &Gaussians) -> Vec<u8> {
    let mut order: Vec<u32> = (0..gaussians.len() as u32).collect();
    gather(&mut order, gaussians.positions());
    let rest = 3 * (gaussians.sh_coefficients() - 1);
    let chunks = order.chunks(CHUNK);
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment made by rara\n{}element chunk {}\n",
        training_comments(gaussians),
        chunks.len()
    );
    for part in ["x", "scale_x", "r"] {
        for end in ["min", "max"] {
            let (stem, last) = part.split_at(part.len() - 1);
            let letters = if last == "x" {
                ["x", "y", "z"]
            } else {
                ["r", "g", "b"]
            };
            letters
                .iter()
                .for_each(|letter| header += &format!("property float {end}_{stem}{letter}\n"));
        }
    }
    header += &format!("element vertex {}\n", order.len());
    for name in ["position", "rotation", "scale", "color"] {
        header += &format!("property uint packed_{name}\n");
    }
    if rest > 0 {
        header += &format!("element sh {}\n", order.len());
        (0..rest).for_each(|number| header += &format!("property uchar f_rest_{number}\n"));
    }
    header += "end_header\n";
    let mut bytes = header.into_bytes();
    let mut vertices = Vec::with_capacity(16 * order.len());
    for chunk in chunks {
        let index = |&at: &u32| at as usize;
        let position = |at: usize| gaussians.positions()[at].to_array().map(f64::from);
        let scale = |at: usize| {
            gaussians.scales()[at]
                .to_array()
                .map(|scale| f64::from(scale).ln().clamp(-LOG, LOG))
        };
        let colour = |at: usize| {
            let own = gaussians.sh_of(at);
            [own[0], own[1], own[2]].map(|value| f64::from(value) * SH_0 + 0.5)
        };
        let range = |of: &dyn Fn(usize) -> [f64; 3]| {
            Range::around(&chunk.iter().map(index).map(of).collect::<Vec<_>>())
        };
        let ranges = [range(&position), range(&scale), range(&colour)];
        for end in ranges
            .iter()
            .flat_map(|Range(low, high)| low.iter().chain(high))
        {
            bytes.extend(end.to_le_bytes());
        }
        for at in chunk.iter().map(index) {
            let [positions, scales, colours] = &ranges;
            let q = gaussians.rotations()[at];
            let packed = [
                thirds(positions, position(at)),
                quaternion([q.w, q.x, q.y, q.z]),
                thirds(scales, scale(at)),
                {
                    let [red, green, blue] = colour(at);
                    let shares = [(0, red), (1, green), (2, blue)]
                        .map(|(part, value)| byte(colours.share(part, value)));
                    let alpha = byte(gaussians.opacities()[at].into());
                    u32::from_be_bytes([shares[0], shares[1], shares[2], alpha])
                },
            ];
            packed
                .iter()
                .for_each(|number| vertices.extend(number.to_le_bytes()));
        }
    }
    bytes.append(&mut vertices);
    for &at in &order {
        let own = gaussians.sh_of(at as usize);
        for number in 0..rest {
            let (channel, coefficient) = (number / (rest / 3), number % (rest / 3));
            let value = f64::from(own[3 + 3 * coefficient + channel]);
            bytes.push(((value / 8.0 + 0.5) * 256.0).clamp(0.0, 255.0) as u8);
        }
    }
    bytes
}

/// Shares in steps.
fn thirds(range: &Range, value: [f64; 3]) -> u32 {
    let part = |part: usize| (range.share(part, value[part]) * STEPS[part]).round() as u32;
    part(0) << 21 | part(1) << 11 | part(2)
}

fn quaternion(parts: [f32; 4]) -> u32 {
    let (largest, others) = smallest_three(parts);
    others.iter().fold(largest, |packed, part| {
        let share = part * std::f64::consts::FRAC_1_SQRT_2 + 0.5;
        packed << 10 | (share * 1023.0).round().clamp(0.0, 1023.0) as u32
    })
}
