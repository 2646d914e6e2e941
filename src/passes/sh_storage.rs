//! How a Gaussian's spherical harmonics lie in device memory: the twin of `glsl/sh_storage.glsl`.

use bytemuck::cast_slice;
use half::f16;

use crate::types;
use rara_base::parallel::in_parallel;
use rara_scene::precision::ShFormat;

/// Words of a Gaussian with `numbers` coefficients, all three channels counted.
pub(crate) fn words(format: ShFormat, numbers: usize) -> usize {
    match format {
        ShFormat::Float => numbers,
        ShFormat::Half => numbers.div_ceil(2),
        ShFormat::Packed => 1 + numbers / 3,
        ShFormat::Byte => 2 + (numbers - 3).div_ceil(4),
    }
}

/// Gaussians that a thread packs at a time.
const CHUNK: usize = 1 << 10;

/// Packs the coefficients of all of a layer's Gaussians, `numbers` of each, where they are: the words follow each other as
/// the bits of numbers, and the memory that is left is freed.
pub(crate) fn pack_in_place(format: ShFormat, numbers: usize, sh: &mut Vec<f32>) {
    let words = words(format, numbers);
    if words == numbers {
        return; // as they are
    }
    in_parallel(sh.chunks_mut(CHUNK * numbers), |chunk| {
        let mut packed = Vec::with_capacity(words);
        for index in 0..chunk.len() / numbers {
            packed.clear();
            pack(format, &chunk[index * numbers..][..numbers], &mut packed);
            chunk[index * words..][..words].copy_from_slice(cast_slice(&packed));
        }
    });
    let count = sh.len() / numbers;
    for first in (0..count).step_by(CHUNK) {
        let from = first * numbers;
        let length = CHUNK.min(count - first) * words;
        sh.copy_within(from..from + length, first * words);
    }
    sh.truncate(count * words);
    sh.shrink_to_fit();
}

/// Appends a Gaussian's coefficients, `[coefficient][r, g, b]`, to `out`.
pub(crate) fn pack(format: ShFormat, numbers: &[f32], out: &mut Vec<u32>) {
    let pair = |a: f32, b: f32| half_bits(a) | half_bits(b) << 16;
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
            // The shader will multiply by the rounded scale.
            let scale = nearest_half(largest(rest)).to_f32();
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

/// The nearest 16-bit float, ties to even; a value beyond the largest, or no number, becomes the largest.
fn nearest_half(value: f32) -> f16 {
    f16::from_f32(value.abs().min(f16::MAX.to_f32_const()).copysign(value))
}

fn half_bits(value: f32) -> u32 {
    nearest_half(value).to_bits().into()
}

/// Bits of red, green and blue of a packed coefficient.
const BITS: [u32; 3] = [11, 11, 10];

fn pack_words(numbers: &[f32], out: &mut Vec<u32>) {
    let (constant, mut rest) = numbers.split_at(3);
    out.push(half_bits(constant[0]) | half_bits(constant[1]) << 16);
    let exponents_at = out.len();
    out.push(half_bits(constant[2]));
    for degree in 1..=3 {
        let (numbers, higher) = rest.split_at(rest.len().min(3 * (2 * degree + 1)));
        let (exponent, scale) = scale(largest(numbers));
        out[exponents_at] |= exponent << (11 + 5 * degree);
        out.extend(numbers.chunks_exact(3).map(|rgb| {
            let channel = |c: usize| share(rgb[c], scale, BITS[c]);
            channel(0) | channel(1) << 11 | channel(2) << 22
        }));
        rest = higher;
    }
}

/// The least power of two that is not below `value`, as its five bits of exponent and itself. It is 2^16 at most, so that
/// larger coefficients become that.
fn scale(value: f32) -> (u32, f32) {
    // The sum carries into the exponent unless `value` is a power of two.
    let up = (value.to_bits() + 0x007f_ffff) >> 23;
    let exponent = up.saturating_sub(types::SH_EXPONENT_BIAS).min(31);
    let scale = f32::from_bits((exponent + types::SH_EXPONENT_BIAS) << 23);
    (exponent, scale)
}

/// `value` as a share of `scale`: a signed integer of `bits` bits whose largest value stands for the scale.
fn share(value: f32, scale: f32, bits: u32) -> u32 {
    let most = ((1 << (bits - 1)) - 1) as f32;
    // A scale is 0, or 2^-24 at least: this is finite.
    let unit = if scale > 0.0 { most / scale } else { 0.0 };
    // The scale may be below the largest, so the share is clamped. `round` would be a call for each number.
    let share = (value * unit).clamp(-most, most);
    (share + 0.5_f32.copysign(share)) as i32 as u32 & ((1 << bits) - 1)
}

fn largest(numbers: &[f32]) -> f32 {
    // In a way that passes over what is no number, and that is a single instruction.
    let larger = |most: f32, size: f32| if size > most { size } else { most };
    numbers.iter().map(|v| v.abs()).fold(0.0, larger)
}

#[cfg(test)]
mod tests;
