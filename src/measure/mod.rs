//! How far apart two pictures are.

#![forbid(unsafe_code)]

mod ssim;

use crate::{Error, Picture, Result};

/// The differences between two pictures.
///
/// Channels are compared as they are: premultiplied, not clamped, no transfer function. Red, green, blue and alpha
/// all count, except that alpha is left out where both pictures are opaque throughout: it would only dilute the
/// averages.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// Largest difference of a channel, in units of 1/255.
    pub max: f64,
    /// Mean absolute difference over all channels, in units of 1/255.
    pub l1: f64,
    /// Root of the mean squared difference over all channels, in units of 1/255.
    pub rmse: f64,
    /// Peak signal to noise ratio for a peak of 1, decibels; infinite where the pictures are equal.
    pub psnr: f64,
    /// Structural similarity, the mean over all pixels and channels: 1 where the pictures are equal. See [`compare`].
    pub ssim: f64,
    /// Share of the pixels of which any channel differs by more than 2/255.
    pub share_over_2: f64,
}

/// Compares two pictures of the same size.
///
/// SSIM is that of Wang, Bovik, Sheikh and Simoncelli (2004): a Gaussian window of 11 x 11 pixels and sigma 1.5,
/// K1 = 0.01, K2 = 0.03, a range of 1. At the picture's edges the window is cut off and renormalised.
pub fn compare(a: &Picture, b: &Picture) -> Result<Comparison> {
    if (a.width, a.height) != (b.width, b.height) {
        return Err(Error::Invalid(format!(
            "pictures of {}x{} and {}x{} cannot be compared; they must have the same size",
            a.width, a.height, b.width, b.height
        )));
    }
    if a.pixels.is_empty() {
        return Err(Error::Invalid(
            "pictures without a pixel cannot be compared".into(),
        ));
    }
    for picture in [a, b] {
        if let Some(i) = picture
            .pixels
            .iter()
            .position(|pixel| !pixel.iter().all(|v| v.is_finite()))
        {
            let (x, y) = (i % picture.width as usize, i / picture.width as usize);
            return Err(Error::Invalid(format!(
                "pixel {x},{y} of a picture to compare is not finite: {:?}",
                picture.pixels[i]
            )));
        }
    }

    let opaque = |picture: &Picture| picture.pixels.iter().all(|pixel| pixel[3] == 1.0);
    let channels = if opaque(a) && opaque(b) { 3 } else { 4 };
    let (mut max, mut sum, mut squares, mut over) = (0.0_f64, 0.0, 0.0, 0_usize);
    for (a, b) in a.pixels.iter().zip(&b.pixels) {
        let mut largest = 0.0_f64;
        for channel in 0..channels {
            let difference = 255.0 * (f64::from(a[channel]) - f64::from(b[channel])).abs();
            largest = largest.max(difference);
            sum += difference;
            squares += difference * difference;
        }
        max = max.max(largest);
        over += usize::from(largest > 2.0);
    }
    let pixels = a.pixels.len() as f64;
    let values = pixels * channels as f64;
    let rmse = (squares / values).sqrt();
    let ssim = (0..channels)
        .map(|channel| ssim::channel(a, b, channel))
        .sum::<f64>()
        / channels as f64;
    Ok(Comparison {
        max,
        l1: sum / values,
        rmse,
        psnr: 20.0 * (255.0 / rmse).log10(),
        ssim,
        share_over_2: over as f64 / pixels,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise that repeats for ever: enough to make structure of.
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
        assert_eq!(same.psnr, f64::INFINITY);
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
}
