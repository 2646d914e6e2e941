use super::*;

#[test]
fn zeros_and_ones_are_stored_finite_and_come_back() {
    assert_eq!(f64::from(log(0.0)).exp() as f32, 0.0);
    let back = |o: f32| (1.0 / (1.0 + (-f64::from(logit(o))).exp())) as f32;
    assert_eq!((back(0.0), back(1.0), back(0.5)), (0.0, 1.0, 0.5));
    assert!((back(1.0 - 6e-8) - 1.0).abs() < 1e-6 && back(1e-40) > 0.0);
}

#[test]
fn names_say_the_format_that_is_written() {
    let of = |name: &str| Format::of_name(Path::new(name));
    assert_eq!(of("a/b.PLY"), Some(Format::Ply));
    assert_eq!((of("b.splat"), of("ply"), of("")), (None, None, None));
    assert_eq!(
        [
            of("b.compressed.ply"),
            of("c.glb"),
            of("c.d.spz"),
            of("x.sog")
        ],
        [
            Format::CompressedPly,
            Format::Gltf,
            Format::Spz,
            Format::Sog
        ]
        .map(Some)
    );
}
