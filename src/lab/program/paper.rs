//! `rara-lab paper`: the paper's experiments on this device.

use std::path::PathBuf;

use clap::Args;
use rara_cli::parts::{DeviceArgs, Failure, ProgressLine, make_folder, one_file, say};
use rara_lab::cases::sources;
use rara_lab::paper::{self, PaperOptions};

/// Gaussians of a generated scene.
const GENERATED: usize = 6_000;

/// Repeat and extend the paper's experiments, and write a report
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara-lab paper -o report
  rara-lab paper skull.ply hair.ply heart.ply -o report --thorough

Without SCENE, the experiments run on eight generated scenes and take a few minutes. The folder gets index.html, which needs no
other file, and also report.md, results.json, a .csv for each table, and the error maps of every case. If a run was interrupted,
the same command continues it, provided that scenes, options, device and driver are the same.")]
pub(super) struct Paper {
    /// Scene files, each a scene of its own [default: eight generated scenes]
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Folder for the report; created if it does not exist
    #[arg(short, long, value_name = "DIR", value_parser = one_file(), default_value = "paper")]
    output: PathBuf,
    /// Larger pictures, more frames and all choices of precision
    #[arg(long)]
    thorough: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

impl Paper {
    pub(super) fn run(self) -> Result<(), Failure> {
        make_folder(&self.output)?;
        let sources = sources(&self.scenes, GENERATED)?;
        let mut options = match self.thorough {
            true => PaperOptions::thorough(),
            false => PaperOptions::quick(),
        };
        if !self.scenes.is_empty() {
            options.timed = (0..sources.len().min(3)).collect();
        }
        // The series use generated scenes, which are at most as large as the largest scene that was given.
        let largest = sources.iter().map(|source| source.gaussians.len()).max();
        options.count = options.count.min(largest.unwrap_or(0).max(1));
        let mut headless = self.device.headless()?;
        let mut progress = ProgressLine::new("measuring");
        paper::run(&mut headless, sources, &options, &self.output, &mut |now| {
            let left = now
                .seconds_left
                .map(|seconds| format!(", about {:.0} min left", (seconds / 60.0).ceil()));
            progress.describe(&format!("{}{}", now.what, left.unwrap_or_default()));
            progress.update(now.done as u64, now.parts as u64);
        })?;
        drop(progress);
        headless.close()?;
        say(format_args!(
            "the report is {}",
            self.output.join("index.html").display()
        ));
        Ok(())
    }
}
