//! `rara-lab stress`: the stress suite's table on this device.

use clap::Args;
use rara_cli::parts::{DeviceArgs, Failure, ProgressLine, counted, json, say};
use rara_lab::stress::regimes;
use rara_lab::stress::{self, FormRow, RegimeRow};
use serde::Serialize;

/// Draw what is hard to draw, and compare it with the reference in double precision
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara-lab stress --validation
  rara-lab stress needles sigma

Each row of the table is a regime: a kind of single cut splat that is hard to draw. Its columns are
  alpha                     largest error of a pixel's alpha without the cut
  affine, beam, auto, rara  largest error of alpha times weight, against the same form in f64
  dB                        PSNR of the worst picture
  missed                    pixels that the reference covers and the picture leaves empty
A row that misses its target is marked, and the exit status is then 1.")]
pub(super) struct Stress {
    /// Run only the regimes whose names contain one of these texts
    #[arg(value_name = "NAME-PART")]
    names: Vec<String>,
    /// Print the table as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

#[derive(Debug, Serialize)]
struct StressJson {
    device: String,
    driver: String,
    rows: Vec<RegimeRow>,
}

impl Stress {
    pub(super) fn run(self) -> Result<(), Failure> {
        let chosen = |name: &str| {
            self.names.is_empty() || self.names.iter().any(|part| name.contains(part.as_str()))
        };
        let regimes: Vec<_> = regimes().into_iter().filter(|r| chosen(r.name)).collect();
        if regimes.is_empty() {
            return Err(Failure::Usage(
                "no regime has such a name; run without names to see all".into(),
            ));
        }
        let mut headless = self.device.headless()?;
        if !self.json {
            say(format_args!(
                "{:<52} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6}",
                "regime", "alpha", "affine", "beam", "auto", "rara", "dB", "missed"
            ));
        }
        let mut rows = Vec::new();
        let mut progress = ProgressLine::new("drawing");
        let total = regimes.len() as u64;
        for regime in regimes {
            progress.describe(regime.name);
            let row = stress::run(&mut headless, &regime, 1)?;
            if !self.json {
                print(&row);
            }
            rows.push(row);
            progress.update(rows.len() as u64, total);
        }
        drop(progress);
        let failed = rows.iter().filter(|row| !row.ok).count();
        let (device, driver) = (
            headless.device_name().to_owned(),
            headless.driver().to_owned(),
        );
        headless.close()?;
        if self.json {
            json(&StressJson {
                device,
                driver,
                rows,
            })?;
        }
        if failed > 0 {
            let message = format!("{failed} regime(s) of the stress suite miss their target");
            return Err(rara::Error::Invalid(message).into());
        }
        Ok(())
    }
}

fn print(row: &RegimeRow) {
    let weight = |form: &FormRow| format!("{:>8.1e}", form.weight);
    let weights: Vec<_> = row.forms.iter().map(weight).collect();
    let psnr = row.forms.iter().fold(f64::INFINITY, |a, f| a.min(f.psnr));
    say(format_args!(
        "{:<52} {:>8.1e} {} {psnr:>6.1} {:>6}{}",
        row.regime,
        row.alpha,
        weights.join(" "),
        row.missed,
        if row.ok { "" } else { "  <- misses its target" }
    ));
    if row.not_finite > 0 {
        say(format_args!(
            "  not finite: {}",
            counted(row.not_finite as u64, "value")
        ));
    }
    if row.miscounted > 1 {
        say(format_args!(
            "  counted on another side than in the reference: {}",
            counted(row.miscounted as u64, "splat")
        ));
    }
    if let Some(reason) = row.reason {
        say(format_args!("  target {:.0e}: {reason}", row.target));
    }
}
