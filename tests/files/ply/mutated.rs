//! Random and damaged files: each is refused or loads as a sound scene, and none panics.

use proptest::prelude::*;

use super::made::{FIXED, FORMATS, assert_sound, floats, load_bytes, refusal, scene_file};

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), ply in any::<bool>()) {
        let start: &[u8] = if ply { b"ply\nformat ascii 1.0\nelement vertex 1\n" } else { b"" };
        if let Ok(loaded) = load_bytes(&[start, &bytes].concat()) {
            assert_sound(&loaded.gaussians);
        }
    }

    #[test]
    fn mutations_never_panic(
        format in 0..3_usize,
        list in any::<bool>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 1..8),
    ) {
        let mut properties = floats(FIXED);
        if list {
            properties.insert(3, ("list uint double", "a"));
        }
        let mut bytes = scene_file(FORMATS[format], 5, &properties).bytes();
        for (at, byte, how) in edits {
            let at = at.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        if let Ok(loaded) = load_bytes(&bytes) {
            assert_sound(&loaded.gaussians);
        }
    }

    /// The cut takes at least the whole last number, since nobody can notice digits that are missing from it.
    #[test]
    fn truncation_is_always_noticed(format in 0..3_usize, cut in 9..440_usize) {
        let bytes = scene_file(FORMATS[format], 8, &floats(FIXED)).bytes();
        refusal(&bytes[..bytes.len() - cut]);
    }
}
