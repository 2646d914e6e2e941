//! How a Gaussian's spherical harmonics lie in device memory: the twin of `glsl/sh_storage.glsl`.

use crate::half::{from_half, to_half};
use crate::precision::ShFormat;

/// Words of a Gaussian with `numbers` coefficients, all three channels counted.
pub(crate) fn words(format: ShFormat, numbers: usize) -> usize {
    match format {
        ShFormat::Float => numbers,
        ShFormat::Half => numbers.div_ceil(2),
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
        ShFormat::Byte => {
            let (constant, rest) = numbers.split_at(3);
            let largest = rest.iter().fold(0.0_f32, |most, v| most.max(v.abs()));
            // What the shader will multiply by is the rounded scale.
            let scale = from_half(to_half(largest));
            let unit = if scale > 0.0 { 127.0 / scale } else { 0.0 };
            // `as` clamps: rounding may have left the scale just below the largest.
            let byte = |v: &f32| (((v * unit).round() as i32).clamp(-127, 127) as i8 as u8).into();
            out.push(pair(constant[0], constant[1]));
            out.push(pair(constant[2], scale));
            out.extend(rest.chunks(4).map(|four| {
                let bytes = four.iter().map(byte).enumerate();
                bytes.fold(0, |word, (place, byte): (usize, u32)| {
                    word | byte << (8 * place)
                })
            }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the shader reads.
    fn component(format: ShFormat, packed: &[u32], k: usize) -> f32 {
        let half = |k: usize| from_half((packed[k / 2] >> (16 * (k % 2))) as u16);
        match format {
            ShFormat::Float => f32::from_bits(packed[k]),
            ShFormat::Half => half(k),
            ShFormat::Byte if k < 3 => half(k),
            ShFormat::Byte => {
                let byte = (packed[2 + (k - 3) / 4] >> (8 * ((k - 3) % 4))) as u8 as i8;
                f32::from(byte) * (half(3) / 127.0)
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
            for size in [1e-9_f32, 1e-3, 0.3, 5.0] {
                let numbers: Vec<f32> = (0..count).map(|_| size * next()).collect();
                let largest = numbers[3..].iter().fold(0.0_f32, |m, v| m.max(v.abs()));
                for format in [ShFormat::Float, ShFormat::Half, ShFormat::Byte] {
                    let mut packed = Vec::new();
                    pack(format, &numbers, &mut packed);
                    assert_eq!(packed.len(), words(format, count));
                    for (k, v) in numbers.iter().enumerate() {
                        let error = (component(format, &packed, k) - v).abs();
                        let half = (v.abs() / 2048.0).max(3e-8);
                        let bound = match format {
                            ShFormat::Float => 0.0,
                            ShFormat::Half => half,
                            ShFormat::Byte if k < 3 => half,
                            // Half a step, and what rounding the scale moves.
                            ShFormat::Byte => largest * (1.0 / 254.0 + 1.0 / 2048.0) + 3e-8,
                        };
                        assert!(
                            error <= bound,
                            "{format:?} degree {degree}: {v} off by {error}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_the_range_of_sixteen_bits_the_largest_is_kept() {
        let mut packed = Vec::new();
        pack(ShFormat::Half, &[1e6, -1e6, 0.5], &mut packed);
        assert_eq!(component(ShFormat::Half, &packed, 0), 65504.0);
        assert_eq!(component(ShFormat::Half, &packed, 1), -65504.0);
        assert_eq!(component(ShFormat::Half, &packed, 2), 0.5);
    }
}
