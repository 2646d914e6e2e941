//! 16-bit floats: a sign, five bits of exponent, ten of fraction.

#![forbid(unsafe_code)]

/// The largest finite one.
pub(crate) const MAX: f32 = 65504.0;

/// The nearest 16-bit float, ties to even; what is beyond the largest becomes the largest.
pub(crate) fn to_half(value: f32) -> u16 {
    let sign = ((value.to_bits() >> 16) & 0x8000) as u16;
    let size = value.abs().min(MAX);
    // Adding a number whose last bit is the result's lets the addition itself round, to even.
    let bits = if size < f32::from_bits(113 << 23) {
        // Below 2^-14 the result is subnormal: multiples of 2^-24.
        (size + 0.5).to_bits() - 0.5_f32.to_bits()
    } else {
        let bits = size.to_bits();
        let rounded = bits + 0xfff + ((bits >> 13) & 1);
        (rounded >> 13) - (112 << 10)
    };
    sign | bits as u16
}

/// The same number in 32 bits, exactly.
pub(crate) fn from_half(half: u16) -> f32 {
    let (sign, exponent, fraction) = (half >> 15, half >> 10 & 31, half & 1023);
    let size = match exponent {
        0 => f32::from(fraction) * f32::from_bits(103 << 23), // 2^-24
        31 if fraction == 0 => f32::INFINITY,
        31 => f32::NAN,
        _ => f32::from_bits((u32::from(exponent) + 112) << 23 | u32::from(fraction) << 13),
    };
    if sign == 0 { size } else { -size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_survives_the_way_there_and_back() {
        for half in (0..=u16::MAX).filter(|half| half >> 10 & 31 != 31) {
            assert_eq!(to_half(from_half(half)), half, "{half:#06x}");
        }
        assert_eq!(from_half(0x7c00), f32::INFINITY);
        assert!(from_half(0x7c01).is_nan());
    }

    #[test]
    fn rounding_is_to_the_nearest_and_ties_go_to_even() {
        let mut state = 1_u32;
        for _ in 0..200_000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let value = f32::from_bits(state);
            if value.is_nan() || value.abs() > MAX {
                continue;
            }
            let error = f64::from(from_half(to_half(value))) - f64::from(value);
            let bound = (f64::from(value.abs()) * 2.0_f64.powi(-11)).max(2.0_f64.powi(-25));
            assert!(error.abs() <= bound, "{value}");
        }
        assert_eq!(from_half(to_half(1.0 + 1.0 / 2048.0)), 1.0);
        assert_eq!(from_half(to_half(1.0 + 3.0 / 2048.0)), 1.0 + 2.0 / 1024.0);
        assert_eq!(from_half(to_half(1e9)), MAX);
        assert_eq!(from_half(to_half(-1e9)), -MAX);
    }
}
