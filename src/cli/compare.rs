//! `rara compare`: how far two pictures are apart.

use std::path::PathBuf;

use clap::Args;
use rara::Picture;
use serde::Serialize;

use super::failure::Failure;
use super::output::{self, say};
use rara::measure::{self, Comparison};

/// Measure how far two pictures are apart
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara compare picture.png reference.exr --json

Differences are on the scale of 0 to 255. Equal pictures have no PSNR: it is null in the JSON.")]
pub(super) struct Compare {
    /// A picture, .png or .exr
    a: PathBuf,
    /// Another of the same size
    b: PathBuf,
    /// Print the measures as JSON to stdout
    #[arg(long)]
    json: bool,
}

/// The measures as a document.
#[derive(Debug, Serialize)]
pub(super) struct Measures {
    pub(super) max: f64,
    pub(super) l1: f64,
    pub(super) rmse: f64,
    /// None where the pictures are equal.
    pub(super) psnr: Option<f64>,
    pub(super) ssim: f64,
    pub(super) share_over_2: f64,
}

impl From<Comparison> for Measures {
    fn from(c: Comparison) -> Self {
        let psnr = Some(c.psnr).filter(|psnr| psnr.is_finite());
        Self {
            max: c.max,
            l1: c.l1,
            rmse: c.rmse,
            psnr,
            ssim: c.ssim,
            share_over_2: c.share_over_2,
        }
    }
}

impl Measures {
    /// The PSNR for people.
    pub(super) fn psnr_text(&self) -> String {
        self.psnr
            .map_or("equal".into(), |psnr| format!("{psnr:.2}"))
    }
}

impl Compare {
    pub(super) fn run(self) -> Result<(), Failure> {
        let (a, b) = (Picture::load(&self.a)?, Picture::load(&self.b)?);
        let measures = Measures::from(measure::compare(&a, &b)?);
        if self.json {
            return Ok(output::json(&measures)?);
        }
        say(format_args!("L1            {:.4} of 255", measures.l1));
        say(format_args!("RMSE          {:.4} of 255", measures.rmse));
        say(format_args!("largest       {:.2} of 255", measures.max));
        let unit = if measures.psnr.is_some() { " dB" } else { "" };
        say(format_args!("PSNR          {}{unit}", measures.psnr_text()));
        say(format_args!("SSIM          {:.6}", measures.ssim));
        say(format_args!(
            "over 2/255    {:.4} % of the pixels",
            100.0 * measures.share_over_2
        ));
        Ok(())
    }
}
