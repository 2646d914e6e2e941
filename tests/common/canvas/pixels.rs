//! Pixels that are read back from a canvas.

use rara::ash::vk;

/// Pixels as linear numbers; channels that a format lacks are 0.
pub(super) fn decoded(format: vk::Format, bytes: &[u8], pixels: usize) -> Vec<[f32; 4]> {
    let (channels, size) = match format {
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => (4, 1),
        vk::Format::R16G16_SFLOAT => (2, 2),
        vk::Format::R16G16B16A16_SFLOAT => (4, 2),
        vk::Format::R32G32_SFLOAT => (2, 4),
        vk::Format::R32G32B32A32_SFLOAT => (4, 4),
        other => panic!("this canvas cannot be read in {other:?}"),
    };
    let is_srgb = format == vk::Format::R8G8B8A8_SRGB;
    let linear = |v: f32| match v {
        v if v <= 0.040_45 => v / 12.92,
        v => ((v + 0.055) / 1.055).powf(2.4),
    };
    let channel = |pixel: &[u8], i: usize| match size {
        _ if i >= channels => 0.0,
        1 if is_srgb && i < 3 => linear(f32::from(pixel[i]) / 255.0),
        1 => f32::from(pixel[i]) / 255.0,
        2 => half(u16::from_le_bytes([pixel[2 * i], pixel[2 * i + 1]])),
        _ => f32::from_le_bytes(pixel[4 * i..][..4].try_into().expect("four bytes")),
    };
    let pixels = bytes.chunks_exact(channels * size).take(pixels);
    pixels
        .map(|p| [0, 1, 2, 3].map(|i| channel(p, i)))
        .collect()
}

/// A half-precision number.
fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    sign * match exponent {
        0 => mantissa * 2.0_f32.powi(-24),
        _ => (1024.0 + mantissa) * 2.0_f32.powi(exponent - 25),
    }
}
