//! `rara compare`: how far two pictures are apart.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::TypedValueParser;
use rara::Picture;
use rara_reference::comparison::{Comparison, compare};
use rara_reference::differences::differences;
use rara_reference::maps;
use serde::Serialize;

use super::failure::Failure;
use super::{output, values};
use rara_scene::picture::ink;

/// Measure the difference between two pictures
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara compare picture.png reference.exr --json
  rara compare picture.png reference.png --min-psnr 40 --max-l1 0.5
  rara compare cut.png whole.png --background white
  rara compare picture.png reference.png --map errors.png

Red, green and blue are compared after both pictures are drawn over the background. Alpha is compared too, on a line of \
its own. Differences are on a scale of 0 to 255. SSIM is the mean over pixels and channels, with a Gaussian window of \
11x11 pixels, a sigma of 1.5, K1 = 0.01, K2 = 0.03 and a data range of 1. Equal pictures have no PSNR; the JSON then has \
null. If a limit is not met, the measures are still printed, and the exit status is 1. In the map of --map, the colour of \
a pixel shows the largest difference of red, green and blue, from light to dark on a logarithmic scale. White means a \
difference of less than 0.1.")]
pub(super) struct Compare {
    /// A picture, .png or .exr
    a: PathBuf,
    /// Another picture of the same size
    b: PathBuf,
    /// The colour behind both pictures
    #[arg(long, value_name = "COLOUR", value_parser = values::colour, default_value = "black")]
    background: [f32; 3],
    /// Fail if the PSNR is less than this, in dB; equal pictures never fail
    #[arg(long, value_name = "DB", value_parser = values::finite, allow_hyphen_values = true)]
    min_psnr: Option<f64>,
    /// Fail if the mean difference is more than this, on a scale of 0 to 255
    #[arg(long, value_name = "L1", value_parser = values::finite, allow_hyphen_values = true)]
    max_l1: Option<f64>,
    /// Write a map of the differences with a colour scale below it, .png or .exr
    #[arg(long, value_name = "FILE", value_parser = values::one_file().try_map(|path| values::picture_path(path.into())))]
    map: Option<PathBuf>,
    /// Print the measures as JSON to standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
pub(super) struct Measures {
    pub(super) max: f64,
    pub(super) l1: f64,
    pub(super) rmse: f64,
    /// The PSNR, decibels; none where the pictures are equal.
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
    pub(super) fn psnr_text(&self) -> String {
        self.psnr
            .map_or("equal".into(), |psnr| format!("{psnr:.2}"))
    }

    fn lines(&self) -> [String; 6] {
        let unit = if self.psnr.is_some() { " dB" } else { "" };
        [
            format!("L1            {:.4} of 255", self.l1),
            format!("RMSE          {:.4} of 255", self.rmse),
            format!("largest       {:.2} of 255", self.max),
            format!("PSNR          {}{unit}", self.psnr_text()),
            format!("SSIM          {:.6}", self.ssim),
            format!(
                "over 2/255    {:.4} % of the pixels",
                100.0 * self.share_over_2
            ),
        ]
    }
}

/// How far two pictures are apart: their colours over a background, and their alpha.
#[derive(Debug, Serialize)]
struct Apart {
    #[serde(flatten)]
    colours: Measures,
    alpha_l1: f64,
    alpha_max: f64,
}

impl Apart {
    fn new(a: &Picture, b: &Picture, background: [f32; 3]) -> rara::Result<Self> {
        let alpha = |picture: &Picture| opaque(picture, |[.., a]| [a; 3]);
        let alpha = differences(&alpha(a), &alpha(b))?;
        Ok(Self {
            colours: compare(&over(a, background), &over(b, background))?.into(),
            alpha_l1: alpha.l1,
            alpha_max: alpha.max,
        })
    }

    fn table(&self) -> String {
        let alpha = format!(
            "alpha         L1 {:.4}, largest {:.2} of 255",
            self.alpha_l1, self.alpha_max
        );
        [self.colours.lines().join("\n"), alpha].join("\n")
    }
}

/// A picture over a background, for those who look at it: a viewer that does not know of transparency would show what is
/// hardly there as solid.
pub(super) fn over(picture: &Picture, background: [f32; 3]) -> Picture {
    let mut picture = picture.clone();
    picture.put_before(background);
    picture
}

/// An opaque picture of these colours of another one's pixels.
fn opaque(picture: &Picture, colours: impl Fn([f32; 4]) -> [f32; 3]) -> Picture {
    let mut picture = picture.clone();
    for pixel in &mut picture.pixels {
        let [r, g, b] = colours(*pixel);
        *pixel = [r, g, b, 1.0];
    }
    picture
}

/// A map of the differences, and below it its scale with numbers, which are as wide as the map or, below a narrow one, as
/// wide as they have to be.
fn map_with_scale(a: &Picture, b: &Picture) -> rara::Result<Picture> {
    let map = maps::error_map(a, b)?;
    let width = map.width.max(LEAST_WIDTH);
    let dot = (width / 480).max(1);
    let (words, bar) = (map.height + 3 * dot, map.height + 13 * dot);
    let numbers = bar + 10 * dot;
    let mut whole = Picture::filled(width, numbers + 10 * dot, PAPER);
    maps::put(&mut whole, &map, [0, 0]);
    maps::put(&mut whole, &maps::scale(width, 8 * dot), [0, bar]);
    let font = (ink::Font::Small, dot.into());
    let mut write = |words: &str, left: f64, top: u32| {
        ink::text(&mut whole, [left, top.into()], words, font, [0; 3]);
    };
    write("difference, of 255", dot.into(), words);
    for number in ["0.1", "1", "10", "100"] {
        let place = maps::place(number.parse().expect("it is a number"));
        // Each is centred below its place, except at the ends.
        let long = f64::from(6 * dot) * number.len() as f64;
        let middle = place * f64::from(width);
        let left = (middle - long / 2.0).clamp(dot.into(), f64::from(width) - long);
        write(number, left, numbers);
    }
    Ok(whole)
}

/// Pixels across that the scale of a map takes at least.
const LEAST_WIDTH: u32 = 120;
/// The colour behind the scale of a map, which white can be told apart from.
const PAPER: [f32; 4] = [0.85, 0.85, 0.85, 1.0];

impl Compare {
    pub(super) fn run(self) -> Result<(), Failure> {
        if let Some(file) = &self.map {
            if file == Path::new(output::STANDARD) {
                let message = "--map -: standard output gets the measures; name a file";
                return Err(Failure::Usage(message.into()));
            }
            output::check_file(file)?;
        }
        let (a, b) = (Picture::load(&self.a)?, Picture::load(&self.b)?);
        let apart = Apart::new(&a, &b, self.background)?;
        if let Some(file) = &self.map {
            let [a, b] = [&a, &b].map(|picture| over(picture, self.background));
            map_with_scale(&a, &b)?.save(file)?;
        }
        if self.json {
            output::json(&apart)?;
        } else {
            output::answer(&apart.table())?;
        }
        self.judge(&apart.colours)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_transparent_shows_the_background() {
        let made = over(&Picture::filled(1, 1, [0.25, 0.0, 0.0, 0.5]), [1.0; 3]);
        assert_eq!(made.at(0, 0), [0.75, 0.5, 0.5, 1.0]);
    }
}
