//! How far apart two pictures are, and how alike they look.

mod pixels;
mod ssim;

pub use pixels::Pixels;

use rara_base::error::Result;
use rara_scene::picture::Picture;

use crate::differences::{channels, differences};

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
    /// Mean excess of the first picture over all channels, in units of 1/255: against a truth, light that the truth
    /// hides.
    pub leak: f64,
    /// Mean lack of the first picture over all channels, in units of 1/255: against a truth, light that the truth shows.
    /// `leak + loss` is `l1`, and `leak - loss` is the signed mean.
    pub loss: f64,
}

/// Compares two pictures of the same size.
///
/// SSIM is that of Wang, Bovik, Sheikh and Simoncelli (2004): a Gaussian window of 11 x 11 pixels and sigma 1.5,
/// K1 = 0.01, K2 = 0.03, a range of 1. At the picture's edges the window is cut off and renormalised.
pub fn compare(a: &Picture, b: &Picture) -> Result<Comparison> {
    compare_within(a, b, None).map(|(comparison, _)| comparison)
}

/// Compares two pictures as [`compare`] does, and also returns the mean SSIM over the pixels of a region, `None` where
/// the region has no pixel.
pub fn compare_within(
    a: &Picture,
    b: &Picture,
    region: Option<&Pixels>,
) -> Result<(Comparison, Option<f64>)> {
    let d = differences(a, b)?;
    let channels = channels(a, b);
    let mut similarity = vec![0.0; a.pixels.len()];
    (0..channels).for_each(|channel| ssim::add_channel(a, b, channel, &mut similarity));
    let per_channel = 1.0 / channels as f64;
    let comparison = Comparison {
        max: d.max,
        l1: d.l1,
        rmse: d.rmse,
        psnr: d.psnr,
        ssim: per_channel * similarity.iter().sum::<f64>() / a.pixels.len() as f64,
        share_over_2: d.share_over_2,
        leak: d.leak,
        loss: d.loss,
    };
    let within = region.and_then(|region| region.mean(&similarity));
    Ok((comparison, within.map(|sum| per_channel * sum)))
}

#[cfg(test)]
mod tests;
