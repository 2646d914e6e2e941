use super::*;

#[test]
fn bytes_are_unpremultiplied_rounded_and_clamped() {
    assert_eq!(to_bytes([0.25, 0.0, 0.5, 0.5]), [128, 0, 255, 128]);
    assert_eq!(to_bytes([0.9, -1.0, 0.5, 0.5]), [255, 0, 255, 128]);
    assert_eq!(to_bytes([0.3, 0.3, 0.3, 0.0]), [0; 4]);
    assert_eq!(to_bytes([f32::NAN, 1.0, 0.0, 1.0]), [0, 255, 0, 255]);
    // Just below and just above the middle between two levels.
    assert_eq!(
        to_bytes([100.49 / 255.0, 100.51 / 255.0, 0.0, 1.0])[..2],
        [100, 101]
    );
}

#[test]
fn quantising_an_opaque_picture_moves_no_value_by_more_than_half_a_level_and_only_once() {
    let values = (0..1000).map(|i| i as f32 / 999.0);
    let picture = Picture {
        width: 1000,
        height: 1,
        pixels: values.map(|v| [v, 1.0 - v, v * v, 1.0]).collect(),
    };
    let once = picture.quantised();
    for (a, b) in picture
        .pixels
        .iter()
        .flatten()
        .zip(once.pixels.iter().flatten())
    {
        assert!((a - b).abs() <= 0.5 / 255.0 + 1e-6);
    }
    assert_eq!(once.quantised(), once);
}
