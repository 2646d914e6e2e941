//! `rara compare`: how far two pictures are apart.

use std::path::PathBuf;

use clap::Args;
use rara::Picture;
use serde::Serialize;

use super::failure::Failure;
use super::{output, values};
use rara::measure::{self, Comparison};

/// Measure how far two pictures are apart
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara compare picture.png reference.exr --json

  rara compare picture.png reference.png --min-psnr 40 --max-l1 0.5

Differences are on the scale of 0 to 255. Equal pictures have no PSNR: it is null in the JSON. The measures are printed in
any case; a limit that they do not keep is exit status 1.")]
pub(super) struct Compare {
    /// A picture, .png or .exr
    a: PathBuf,
    /// Another of the same size
    b: PathBuf,
    /// Fail where the PSNR is less than this, dB; equal pictures never fail
    #[arg(long, value_name = "DB", value_parser = values::finite, allow_hyphen_values = true)]
    min_psnr: Option<f64>,
    /// Fail where the mean difference is more than this, of 255
    #[arg(long, value_name = "L1", value_parser = values::finite, allow_hyphen_values = true)]
    max_l1: Option<f64>,
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

    fn table(&self) -> String {
        let unit = if self.psnr.is_some() { " dB" } else { "" };
        let lines = [
            format!("L1            {:.4} of 255", self.l1),
            format!("RMSE          {:.4} of 255", self.rmse),
            format!("largest       {:.2} of 255", self.max),
            format!("PSNR          {}{unit}", self.psnr_text()),
            format!("SSIM          {:.6}", self.ssim),
            format!(
                "over 2/255    {:.4} % of the pixels",
                100.0 * self.share_over_2
            ),
        ];
        lines.join("\n")
    }
}

impl Compare {
    pub(super) fn run(self) -> Result<(), Failure> {
        let (a, b) = (Picture::load(&self.a)?, Picture::load(&self.b)?);
        let measures = Measures::from(measure::compare(&a, &b)?);
        if self.json {
            output::json(&measures)?;
        } else {
            output::answer(&measures.table())?;
        }
        self.judge(&measures)
    }

    /// Fails where a limit is not kept.
    fn judge(&self, measures: &Measures) -> Result<(), Failure> {
        let psnr = measures.psnr.unwrap_or(f64::INFINITY);
        let missed = match (self.min_psnr, self.max_l1) {
            (Some(least), _) if psnr < least => {
                format!("their PSNR is {psnr:.4} dB, where --min-psnr asks for {least}")
            }
            (_, Some(most)) if measures.l1 > most => {
                format!(
                    "their L1 is {:.6}, where --max-l1 allows {most}",
                    measures.l1
                )
            }
            _ => return Ok(()),
        };
        let (a, b) = (self.a.display(), self.b.display());
        Err(rara::Error::Invalid(format!("{a} and {b} differ: {missed}")).into())
    }
}
