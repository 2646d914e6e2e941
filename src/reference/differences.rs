//! How far apart two pictures are, pixel by pixel.

use rara_base::error::{Error, Result};
use rara_scene::picture::Picture;

/// The differences between two pictures, pixel by pixel.
///
/// Channels are compared as they are: premultiplied, not clamped, no transfer function. Red, green, blue and alpha
/// all count, except that alpha is left out where both pictures are opaque throughout: it would only dilute the averages.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Differences {
    /// Largest difference of a channel, in units of 1/255.
    pub max: f64,
    /// Mean absolute difference over all channels, in units of 1/255.
    pub l1: f64,
    /// Root of the mean squared difference over all channels, in units of 1/255.
    pub rmse: f64,
    /// Peak signal to noise ratio for a peak of 1, decibels; infinite where the pictures are equal.
    pub psnr: f64,
    /// Share of the pixels of which any channel differs by more than 2/255.
    pub share_over_2: f64,
    /// Mean excess of the first picture over all channels, in units of 1/255: against a truth, light that the truth
    /// hides.
    pub leak: f64,
    /// Mean lack of the first picture over all channels, in units of 1/255: against a truth, light that the truth shows.
    /// `leak + loss` is `l1`, and `leak - loss` is the signed mean.
    pub loss: f64,
}

/// Compares two pictures of the same size.
///
/// # Errors
/// If their sizes differ, if they have no pixel, or if a channel is not finite.
pub fn differences(a: &Picture, b: &Picture) -> Result<Differences> {
    comparable(a, b)?;
    let channels = channels(a, b);
    let (mut max, mut leak, mut loss, mut squares, mut over) = (0.0_f64, 0.0, 0.0, 0.0, 0_usize);
    for (a, b) in a.pixels.iter().zip(&b.pixels) {
        let mut largest = 0.0_f64;
        for channel in 0..channels {
            let difference = 255.0 * (f64::from(a[channel]) - f64::from(b[channel]));
            largest = largest.max(difference.abs());
            leak += difference.max(0.0);
            loss += (-difference).max(0.0);
            squares += difference * difference;
        }
        max = max.max(largest);
        over += usize::from(largest > 2.0);
    }
    let pixels = a.pixels.len() as f64;
    let values = pixels * channels as f64;
    let rmse = (squares / values).sqrt();
    Ok(Differences {
        max,
        l1: (leak + loss) / values,
        rmse,
        psnr: 20.0 * (255.0 / rmse).log10(),
        share_over_2: over as f64 / pixels,
        leak: leak / values,
        loss: loss / values,
    })
}

/// The channels that count: all but an alpha that says nothing.
pub fn channels(a: &Picture, b: &Picture) -> usize {
    let opaque = |picture: &Picture| picture.pixels.iter().all(|pixel| pixel[3] == 1.0);
    if opaque(a) && opaque(b) { 3 } else { 4 }
}

/// Peak signal to noise ratio of two pictures, as [`differences`] computes it.
pub fn psnr(a: &Picture, b: &Picture) -> Result<f64> {
    differences(a, b).map(|d| d.psnr)
}

/// Fails if the pictures' sizes differ.
///
/// # Errors
/// If their sizes differ.
pub fn same_size(a: &Picture, b: &Picture) -> Result<()> {
    if (a.width, a.height) != (b.width, b.height) {
        return Err(Error::Invalid(format!(
            "pictures of {}x{} and {}x{} cannot be compared; they must have the same size",
            a.width, a.height, b.width, b.height
        )));
    }
    Ok(())
}

fn comparable(a: &Picture, b: &Picture) -> Result<()> {
    same_size(a, b)?;
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
    Ok(())
}
