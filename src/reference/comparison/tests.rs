//! The measures against values in closed form.

use super::*;
use crate::differences::psnr;

/// Noise that is the same in every run, so that pictures have structure.
fn noise(width: u32, height: u32, seed: u32) -> Picture {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let pixels = (0..width * height)
        .map(|_| [next(), next(), next(), next()])
        .collect();
    Picture {
        width,
        height,
        pixels,
    }
}

#[test]
fn equal_pictures_are_equal() {
    let picture = noise(33, 17, 1);
    let same = compare(&picture, &picture).unwrap();
    assert_eq!(
        (same.max, same.l1, same.rmse, same.share_over_2),
        (0.0, 0.0, 0.0, 0.0)
    );
    assert_eq!(
        (same.psnr, psnr(&picture, &picture).unwrap()),
        (f64::INFINITY, f64::INFINITY)
    );
    assert!((same.ssim - 1.0).abs() < 1e-12);
}

#[test]
fn a_known_difference_has_known_norms() {
    let a = Picture::filled(10, 10, [0.5, 0.5, 0.5, 1.0]);
    let mut b = a.clone();
    b.pixels[7][1] = 0.5 + 51.0 / 255.0; // one of 300 values differs by 51 levels
    let result = compare(&a, &b).unwrap();
    assert!((result.max - 51.0).abs() < 1e-5);
    assert!((result.l1 - 51.0 / 300.0).abs() < 1e-6);
    assert!((result.rmse - 51.0 / 300.0_f64.sqrt()).abs() < 1e-5);
    assert!((result.psnr - 20.0 * (255.0 * 300.0_f64.sqrt() / 51.0).log10()).abs() < 1e-5);
    assert_eq!(result.share_over_2, 0.01);
    assert_eq!((result.leak, result.loss), (0.0, result.l1), "b shows more");
    let ((back, whole), mut less) = (compare_within(&b, &a, None).unwrap(), a.clone());
    assert_eq!((back.leak, back.loss, whole), (result.l1, 0.0, None));
    less.pixels[8][0] = 0.5 - 51.0 / 255.0;
    let both = compare(&less, &b).unwrap();
    assert_eq!((both.leak, both.loss), (0.0, both.l1));
    // With alpha below 1 anywhere, alpha is a fourth channel.
    b.pixels[0][3] = 0.8;
    let result = compare(&a, &b).unwrap();
    assert!((result.l1 - 102.0 / 400.0).abs() < 1e-5);
    assert_eq!(result.share_over_2, 0.02);
}

#[test]
fn ssim_of_flat_pictures_is_the_luminance_term() {
    let (x, y) = (0.25_f64, 0.5_f64);
    let a = Picture::filled(20, 15, [x as f32, x as f32, x as f32, 1.0]);
    let b = Picture::filled(20, 15, [y as f32, y as f32, y as f32, 1.0]);
    let expected = (2.0 * x * y + 1e-4) / (x * x + y * y + 1e-4);
    assert!((compare(&a, &b).unwrap().ssim - expected).abs() < 1e-9);
}

#[test]
fn ssim_within_a_region_is_that_of_its_pixels() {
    let a = Picture::filled(40, 20, [0.25, 0.25, 0.25, 1.0]);
    // Differs from column 20 on; from column 25 on no window sees the border.
    let from = |column: usize| {
        let mut b = a.clone();
        for (i, pixel) in b.pixels.iter_mut().enumerate() {
            if i % 40 >= column {
                *pixel = [0.5, 0.5, 0.5, 1.0];
            }
        }
        b
    };
    let b = from(20);
    let right = Pixels::where_different(&a, &from(25), 0.0).unwrap();
    let (whole, within) = compare_within(&a, &b, Some(&right)).unwrap();
    let everywhere = Pixels::where_different(&a, &b, -1.0).unwrap();
    let all = compare_within(&a, &b, Some(&everywhere)).unwrap().1;
    assert!((all.unwrap() - whole.ssim).abs() < 1e-12);
    let flat = (2.0 * 0.25 * 0.5 + 1e-4) / (0.25 * 0.25 + 0.5 * 0.5 + 1e-4);
    assert!((within.unwrap() - flat).abs() < 1e-9);
    let none = Pixels::where_different(&a, &a, 0.0).unwrap();
    assert_eq!(compare_within(&a, &b, Some(&none)).unwrap().1, None);
}

#[test]
fn ssim_of_a_scaled_picture_about_its_mean_is_the_contrast_term() {
    // b - 1/2 = (a - 1/2) / 2 with a of two levels at random: where the window's mean of a is about 1/2, SSIM is
    // (2 s/2 v + C2) / (v + v/4 + C2), and every window's value must agree with that of its own moments.
    let mut a = noise(64, 64, 5);
    let mut b = a.clone();
    for (a, b) in a.pixels.iter_mut().zip(&mut b.pixels) {
        *a = a.map(|v| if v < 0.5 { 0.0 } else { 1.0 });
        *b = a.map(|v| 0.5 + (v - 0.5) / 2.0);
    }
    let ssim = compare(&a, &b).unwrap().ssim;
    let expected = (0.25 + 9e-4) / (0.25 * 1.25 + 9e-4);
    assert!(
        (ssim - expected).abs() < 0.02,
        "{ssim} is not near {expected}"
    );
    assert!(
        (compare(&b, &a).unwrap().ssim - ssim).abs() < 1e-12,
        "symmetric"
    );
}

#[test]
fn independent_noise_is_not_similar() {
    let ssim = compare(&noise(64, 64, 1), &noise(64, 64, 2)).unwrap().ssim;
    assert!(ssim.abs() < 0.1, "{ssim}");
}

#[test]
fn what_cannot_be_compared_is_an_error() {
    let a = Picture::filled(2, 2, [0.0; 4]);
    assert!(
        compare(&a, &Picture::filled(2, 3, [0.0; 4]))
            .unwrap_err()
            .to_string()
            .contains("2x3")
    );
    assert!(compare(&Picture::default(), &Picture::default()).is_err());
    let mut b = a.clone();
    b.pixels[3][0] = f32::NAN;
    assert!(compare(&a, &b).unwrap_err().to_string().contains("1,1"));
}
