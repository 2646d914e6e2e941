use super::*;

const ALL: [ShFormat; 4] = [
    ShFormat::Float,
    ShFormat::Half,
    ShFormat::Packed,
    ShFormat::Byte,
];

/// The number that the shader reads.
fn component(format: ShFormat, packed: &[u32], k: usize) -> f32 {
    let half = |k: usize| f16::from_bits((packed[k / 2] >> (16 * (k % 2))) as u16).to_f32();
    let signed =
        |word: u32, low: u32, bits: u32| ((word << (32 - low - bits)) as i32 >> (32 - bits)) as f32;
    match format {
        ShFormat::Float => f32::from_bits(packed[k]),
        ShFormat::Half => half(k),
        ShFormat::Packed if k < 3 => half(k),
        ShFormat::Packed => {
            let exponent = packed[1] >> (11 + 5 * degree(k)) & 31;
            let scale = f32::from_bits((exponent + types::SH_EXPONENT_BIAS) << 23);
            let (low, bits) = [(0, 11), (11, 11), (22, 10)][k % 3];
            let most = ((1 << (bits - 1)) - 1) as f32;
            signed(packed[1 + k / 3], low, bits) * (scale / most)
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
    let half = (numbers[k].abs() / 2048.0).max(3e-8); // half a step, which is 2^-25 for subnormal numbers
    let same = (0..numbers.len()).filter(|j| degree(*j) == degree(k));
    let of_degree = same.fold(0.0_f32, |most, j| most.max(numbers[j].abs()));
    match format {
        ShFormat::Float => 0.0,
        ShFormat::Half => half,
        ShFormat::Packed if k < 3 => half,
        // This is half a step of a scale that is below twice the largest, or the least scale, and what computing it
        // in single precision loses.
        ShFormat::Packed => {
            let most = if k % 3 == 2 { 511.0 } else { 1023.0 };
            of_degree.max(2.0_f32.powi(-16)) / most * 1.001
        }
        ShFormat::Byte if k < 3 => half,
        // This is half a step, and what rounding the scale moves.
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
            // One number is large, and the others are nothing beside it.
            let mut one: Vec<f32> = (0..count).map(|_| 1e-6 * size * next()).collect();
            one[count - 1] = size;
            check(&one);
        }
    }
}

#[test]
fn in_place_all_become_what_each_becomes() {
    let count = 3 * CHUNK + 7;
    for numbers in [3, 12, 27, 48] {
        let sh: Vec<f32> = (0..count * numbers).map(|n| (n as f32).sin()).collect();
        for format in ALL {
            let (mut each, mut all) = (Vec::new(), sh.clone());
            sh.chunks(numbers)
                .for_each(|of_one| pack(format, of_one, &mut each));
            pack_in_place(format, numbers, &mut all);
            assert!(cast_slice::<f32, u32>(&all) == each, "{format:?}");
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
fn a_scale_is_the_least_power_of_two_that_is_large_enough() {
    for exponent in 0..32 {
        let power = 2.0_f32.powi(exponent - 15);
        let exponent = exponent as u32;
        assert_eq!(scale(power), (exponent, power));
        let above = f32::from_bits(power.to_bits() + 1);
        assert_eq!(scale(above).0, (exponent + 1).min(31), "above {power}");
    }
    assert_eq!((scale(0.0).0, scale(1e-40).0), (0, 0));
    assert_eq!(scale(f32::MAX), (31, 65536.0));
}

#[test]
fn every_half_survives_the_way_there_and_back_and_ties_go_to_even() {
    for bits in 0..=u16::MAX {
        let half = f16::from_bits(bits);
        let back = nearest_half(half.to_f32());
        if half.is_finite() {
            assert_eq!(back.to_bits(), bits, "{bits:#06x}");
        } else {
            assert_eq!(back.to_f32().abs(), 65504.0, "{bits:#06x}");
        }
    }
    assert_eq!(nearest_half(1.0 + 1.0 / 2048.0).to_f32(), 1.0);
    assert_eq!(
        nearest_half(1.0 + 3.0 / 2048.0).to_f32(),
        1.0 + 2.0 / 1024.0
    );
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
    assert_eq!((read(0), read(1)), (65504.0, -65504.0));
    // The test allows for the last bit of the product.
    for (k, most) in [(3, 65536.0), (12, 65536.0), (13, -65536.0), (29, 65536.0)] {
        assert!((read(k) / most - 1.0).abs() < 1e-6, "{k}: {}", read(k));
    }
}
