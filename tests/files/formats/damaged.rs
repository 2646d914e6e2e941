//! Damaged files of every format: each is refused or loads as a sound scene, and none panics.

use std::sync::OnceLock;

use proptest::prelude::*;
use rara::scene::{Kind, generate, save};

use super::load_bytes;
use crate::common::folder::Folder;
use crate::files::ply::made::assert_sound;

/// A whole file of every format that is written, and some that are put together here.
fn whole() -> &'static Vec<Vec<u8>> {
    static FILES: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    FILES.get_or_init(|| {
        let folder = Folder::new("formats-damaged");
        let mut scene = generate(Kind::General, 20, 1);
        scene.set_sh_degree(1);
        let saved = ["a.compressed.ply", "a.spz", "a.sog", "a.glb"].map(|name| {
            let path = folder.join(name);
            save(&path, &scene).unwrap();
            std::fs::read(&path).unwrap()
        });
        let mut files = saved.to_vec();
        files.extend([splat(), ksplat(0), ksplat(1), ksplat(2), plain_spz()]);
        files
    })
}

/// A `.splat` of three Gaussians.
pub(super) fn splat() -> Vec<u8> {
    let mut bytes = Vec::new();
    for number in 0..3 {
        [1.0, 2.0, number as f32, 0.1, 0.2, 0.3]
            .iter()
            .for_each(|v: &f32| bytes.extend(v.to_le_bytes()));
        bytes.extend([255, 128, 0, 200, 255, 128, 128, 128]);
    }
    bytes
}

/// A `.ksplat` of two Gaussians of degree 1 in one bucket, at a level of compression.
pub(super) fn ksplat(level: u16) -> Vec<u8> {
    let mut bytes = vec![0; 4096 + 1024];
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(1, &[1]);
    [4, 8].iter().for_each(|at| put(*at, &1_u32.to_le_bytes()));
    [12, 16, 4096, 4100]
        .iter()
        .for_each(|at| put(*at, &2_u32.to_le_bytes()));
    put(20, &level.to_le_bytes());
    if level > 0 {
        put(4096 + 8, &256_u32.to_le_bytes());
        put(4096 + 12, &1_u32.to_le_bytes());
        put(4096 + 16, &4_f32.to_le_bytes());
        put(4096 + 20, &12_u16.to_le_bytes());
        put(4096 + 36, &1_u32.to_le_bytes());
    }
    put(4096 + 40, &1_u16.to_le_bytes());
    if level > 0 {
        bytes.extend(2_u32.to_le_bytes());
        [1.0_f32, 2.0, 3.0]
            .iter()
            .for_each(|v| bytes.extend(v.to_le_bytes()));
    }
    for number in 0..2_u16 {
        let numbers = [0.5, 0.25, 2.0, 1.0, 0.0, 0.0, 0.0];
        if level == 0 {
            [f32::from(number), 2.0, 3.0]
                .iter()
                .chain(&numbers)
                .for_each(|v| bytes.extend(v.to_le_bytes()));
        } else {
            [32767 + number, 32767, 65534]
                .iter()
                .for_each(|v| bytes.extend(v.to_le_bytes()));
            numbers.iter().for_each(|v| bytes.extend(half(*v)));
        }
        bytes.extend([255, 128, 0, 51]);
        for coefficient in 0..9_u8 {
            let value = f32::from(coefficient) / 8.0;
            match level {
                0 => bytes.extend(value.to_le_bytes()),
                1 => bytes.extend(half(value)),
                _ => bytes.push(coefficient * 16),
            }
        }
    }
    bytes
}

/// A multiple of an eighth up to 2 in half precision.
fn half(value: f32) -> [u8; 2] {
    let bits = value.to_bits();
    if value == 0.0 {
        return [0; 2];
    }
    let exponent = (bits >> 23) as i32 - 127 + 15;
    ((exponent as u16) << 10 | (bits >> 13) as u16 & 1023).to_le_bytes()
}

/// A `.spz` of version 2 that is not compressed.
fn plain_spz() -> Vec<u8> {
    let mut bytes = b"NGSP\x02\0\0\0\x02\0\0\0\0\x0c\0\0".to_vec();
    bytes.extend((0..38).map(|byte| byte * 6));
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutations_never_panic(
        file in any::<prop::sample::Index>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..6),
    ) {
        let mut bytes = file.get(whole()).clone();
        for (at, byte, how) in edits {
            // Most of what decides is at the beginning.
            let at = if how == 3 { at.index(bytes.len().min(200)) } else { at.index(bytes.len()) };
            match how {
                0 | 3 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        if let Ok(loaded) = load_bytes(&bytes) {
            assert_sound(&loaded.gaussians);
        }
    }

    #[test]
    fn what_is_cut_off_is_noticed(file in any::<prop::sample::Index>(), cut in any::<prop::sample::Index>()) {
        let bytes = file.get(whole());
        let end = cut.index(bytes.len());
        // A .splat has no count; what is left is whole where its length is.
        if let Ok(loaded) = load_bytes(&bytes[..end]) {
            prop_assert_eq!(loaded.format, rara::scene::Format::Splat);
        }
    }
}

#[test]
fn put_together_files_are_what_they_were_put_together_of() {
    for level in 0..3 {
        let loaded = load_bytes(&ksplat(level)).unwrap();
        assert!(loaded.report.is_clean(), "{}", loaded.report);
        let made = loaded.gaussians;
        assert_eq!(
            (loaded.format, made.len(), made.sh_degree()),
            (rara::scene::Format::Ksplat, 2, 1)
        );
        assert_eq!(made.scales()[1].to_array(), [0.5, 0.25, 2.0]);
        assert!((made.opacities()[0] - 0.2).abs() < 1e-6);
        let step = if level == 0 { 1.0 } else { 2.0 / 32767.0 };
        let expected = if level == 0 {
            [1.0, 2.0, 3.0]
        } else {
            [1.0 + step, 2.0, 5.0]
        };
        assert_eq!(made.positions()[1].to_array(), expected);
        // Channel by channel: the second coefficient's green is the fifth number.
        let value = if level == 2 {
            -1.5 + 3.0 * 64.0 / 255.0
        } else {
            0.5
        };
        assert!(
            (made.sh_of(0)[3 + 3 + 1] - value).abs() < 1e-6,
            "{:?}",
            made.sh_of(0)
        );
    }
}
