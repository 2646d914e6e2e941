//! How a Gaussian's spherical harmonics lie in device memory: the twin of `glsl/sh_storage.glsl`.

use crate::half::{from_half, to_half};
use crate::precision::ShFormat;

/// Words of a Gaussian with `numbers` coefficients, all three channels counted.
pub(crate) fn words(format: ShFormat, numbers: usize) -> usize {
    match format {
        ShFormat::Float => numbers,
        ShFormat::Half => numbers.div_ceil(2),
        ShFormat::Packed if numbers == 3 => 3,
        ShFormat::Packed => 3 + numbers / 3,
        ShFormat::Byte => 2 + (numbers - 3).div_ceil(4),
    }
}

/// Appends a Gaussian's coefficients, `[coefficient][r, g, b]`, to `out`.
pub(crate) fn pack(format: ShFormat, numbers: &[f32], out: &mut Vec<u32>) {
    let pair = |a: f32, b: f32| u32::from(to_half(a)) | u32::from(to_half(b)) << 16;
    match format {
        ShFormat::Float => out.extend(numbers.iter().map(|v| v.to_bits())),
        ShFormat::Half => out.extend(
            numbers
                .chunks(2)
                .map(|two| pair(two[0], *two.get(1).unwrap_or(&0.0))),
        ),
        ShFormat::Packed => pack_words(numbers, out),
        ShFormat::Byte => {
            let (constant, rest) = numbers.split_at(3);
            // What the shader will multiply by is the rounded scale.
            let scale = from_half(to_half(largest(rest)));
            out.push(pair(constant[0], constant[1]));
            out.push(pair(constant[2], scale));
            out.extend(rest.chunks(4).map(|four| {
                let bytes = four.iter().map(|v| share(*v, scale, 8)).enumerate();
                bytes.fold(0, |word, (place, byte): (usize, u32)| {
                    word | byte << (8 * place)
                })
            }));
        }
    }
}

/// Bits of red, green and blue of a packed coefficient, and of the scales of degrees 1, 2 and 3.
const BITS: [u32; 3] = [11, 11, 10];

fn pack_words(numbers: &[f32], out: &mut Vec<u32>) {
    let (constant, rest) = numbers.split_at(3);
    out.extend(constant.iter().map(|v| v.to_bits()));
    if rest.is_empty() {
        return;
    }
    let scales_at = out.len();
    out.push(0);
    let mut rest = rest;
    for (degree, bits) in BITS.into_iter().enumerate() {
        let (numbers, higher) = rest.split_at(rest.len().min(3 * (2 * degree + 3)));
        let (stored, scale) = scale(largest(numbers), bits);
        out[scales_at] |= stored << (11 * degree);
        out.extend(numbers.chunks_exact(3).map(|rgb| {
            let channel = |c: usize| share(rgb[c], scale, BITS[c]);
            channel(0) | channel(1) << 11 | channel(2) << 22
        }));
        rest = higher;
    }
}

/// The least unsigned float of so many bits, five of them the exponent's, that is not below `value`, and its value. The
/// largest there is below infinity is 65024 in eleven bits and 64512 in ten: larger coefficients become that.
fn scale(value: f32, bits: u32) -> (u32, f32) {
    let dropped = 15 - bits; // a half without its sign and its last bits
    let float = |stored: u32| from_half((stored << dropped) as u16);
    // Down, then one up where that is below.
    let below = u32::from(to_half(value)) >> dropped;
    let most = (31 << (bits - 5)) - 1;
    let stored = (below + u32::from(float(below) < value)).min(most);
    (stored, float(stored))
}

/// `value` as a share of `scale`, a signed integer of so many bits whose largest is the scale.
fn share(value: f32, scale: f32, bits: u32) -> u32 {
    let most = (1 << (bits - 1)) - 1;
    // Scales are 2^-24 or more, so that this is finite.
    let unit = if scale > 0.0 {
        most as f32 / scale
    } else {
        0.0
    };
    // Clamped: a scale may be below the largest; `as` stays in range by itself. `round` would be a call for each number.
    let share = value * unit;
    let count = (share + 0.5_f32.copysign(share)) as i32;
    count.clamp(-most, most) as u32 & ((1 << bits) - 1)
}

fn largest(numbers: &[f32]) -> f32 {
    numbers.iter().fold(0.0, |most, v| most.max(v.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ShFormat; 4] = [
        ShFormat::Float,
        ShFormat::Half,
        ShFormat::Packed,
        ShFormat::Byte,
    ];

    /// What the shader reads.
    fn component(format: ShFormat, packed: &[u32], k: usize) -> f32 {
        let half = |k: usize| from_half((packed[k / 2] >> (16 * (k % 2))) as u16);
        let signed = |word: u32, low: u32, bits: u32| {
            ((word << (32 - low - bits)) as i32 >> (32 - bits)) as f32
        };
        match format {
            ShFormat::Float => f32::from_bits(packed[k]),
            ShFormat::Half => half(k),
            ShFormat::Packed if k < 3 => f32::from_bits(packed[k]),
            ShFormat::Packed => {
                let scale = match degree(k) {
                    1 => (packed[3] & 0x7ff) << 4,
                    2 => (packed[3] & 0x003f_f800) >> 11 << 4,
                    _ => packed[3] >> 22 << 5,
                };
                let (low, bits) = [(0, 11), (11, 11), (22, 10)][k % 3];
                let most = ((1 << (bits - 1)) - 1) as f32;
                signed(packed[3 + k / 3], low, bits) * (from_half(scale as u16) / most)
            }
            ShFormat::Byte if k < 3 => half(k),
            ShFormat::Byte => {
                let word = packed[2 + (k - 3) / 4];
                signed(word, 8 * ((k as u32 - 3) % 4), 8) * (half(3) / 127.0)
            }
        }
    }

    fn degree(k: usize) -> usize {
        match k / 3 {
            0 => 0,
            1..4 => 1,
            4..9 => 2,
            _ => 3,
        }
    }

    /// How far number `k` may be off, where nothing is beyond the range of 16 bits.
    fn bound(format: ShFormat, numbers: &[f32], k: usize) -> f32 {
        let half = (numbers[k].abs() / 2048.0).max(3e-8); // half a step; of subnormal ones 2^-25
        let same = (0..numbers.len()).filter(|j| degree(*j) == degree(k));
        let of_degree = same.fold(0.0_f32, |most, j| most.max(numbers[j].abs()));
        match format {
            ShFormat::Float => 0.0,
            ShFormat::Half => half,
            ShFormat::Packed if k < 3 => 0.0,
            // Half a step of a scale that was rounded up by a 64th at most, a 32nd for degree 3, or to the least there
            // is; and what computing it in single precision loses.
            ShFormat::Packed => {
                let step = if k % 3 == 2 {
                    1.0 / 1022.0
                } else {
                    1.0 / 2046.0
                };
                let (rounding, least) = if degree(k) == 3 {
                    (1.0 / 32.0, 2.0_f32.powi(-19))
                } else {
                    (1.0 / 64.0, 2.0_f32.powi(-20))
                };
                (of_degree * (1.0 + rounding)).max(of_degree + least) * step * 1.001
            }
            ShFormat::Byte if k < 3 => half,
            // Half a step, and what rounding the scale moves.
            ShFormat::Byte => largest(&numbers[3..]) * (1.0 / 254.0 + 1.0 / 2048.0) + 3e-8,
        }
    }

    fn check(numbers: &[f32]) {
        for format in ALL {
            let mut packed = Vec::new();
            pack(format, numbers, &mut packed);
            assert_eq!(packed.len(), words(format, numbers.len()));
            for (k, v) in numbers.iter().enumerate() {
                let error = (component(format, &packed, k) - v).abs();
                let bound = bound(format, numbers, k);
                assert!(
                    error <= bound,
                    "{format:?}, number {k} of {numbers:?}: off by {error}, beyond {bound}"
                );
            }
        }
    }

    #[test]
    fn what_is_stored_is_what_went_in_within_each_formats_bound() {
        let mut state = 7_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for degree in 0..=3 {
            let count = 3 * (degree + 1) * (degree + 1);
            for size in [0.0, 1e-30, 1e-9_f32, 1e-6, 3e-5, 1e-3, 0.3, 5.0, 6e4] {
                for _ in 0..20 {
                    check(&(0..count).map(|_| size * next()).collect::<Vec<_>>());
                }
                // One that is large, and the others nothing beside it.
                let mut one: Vec<f32> = (0..count).map(|_| 1e-6 * size * next()).collect();
                one[count - 1] = size;
                check(&one);
            }
        }
    }

    #[test]
    fn each_degree_of_the_packed_ones_has_a_scale_of_its_own() {
        let mut numbers = [0.0; 48];
        numbers[3..12].fill(100.0);
        numbers[12..27].fill(-1.0);
        numbers[27..].fill(0.01);
        check(&numbers);
    }

    #[test]
    fn a_scale_is_the_least_that_is_large_enough() {
        for bits in [10, 11] {
            let most = (31 << (bits - 5)) - 1;
            let float = |stored: u32| from_half((stored << (15 - bits)) as u16);
            for stored in 0..=most {
                let value = float(stored);
                assert_eq!(scale(value, bits), (stored, value));
                if stored < most {
                    let above = f32::from_bits(value.to_bits() + 1);
                    assert_eq!(scale(above, bits).0, stored + 1, "above {value}");
                }
            }
            assert_eq!(scale(f32::MAX, bits).0, most);
        }
    }

    #[test]
    fn beyond_the_range_of_sixteen_bits_the_largest_is_kept() {
        let mut packed = Vec::new();
        pack(ShFormat::Half, &[1e6, -1e6, 0.5], &mut packed);
        assert_eq!(component(ShFormat::Half, &packed, 0), 65504.0);
        assert_eq!(component(ShFormat::Half, &packed, 1), -65504.0);
        assert_eq!(component(ShFormat::Half, &packed, 2), 0.5);
        let mut numbers = [3e38; 48];
        numbers[1] = -3e38;
        numbers[13] = -3e38;
        packed.clear();
        pack(ShFormat::Packed, &numbers, &mut packed);
        let read = |k| component(ShFormat::Packed, &packed, k);
        assert_eq!((read(0), read(1)), (3e38, -3e38));
        // Where single precision rounds the last bit of the product is not the point.
        for (k, most) in [(3, 65024.0), (12, 65024.0), (13, -65024.0), (27, 64512.0)] {
            assert!((read(k) / most - 1.0).abs() < 1e-6, "{k}: {}", read(k));
        }
    }
}
