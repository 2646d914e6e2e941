//! `rara measure`: what frames take by stage, and what happens before the first one.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;
use clap::builder::PossibleValuesParser;
use rara::{Error, HeadlessDesc};
use rara_lab::run_time::{self, Program, RunTimeOptions};
use rara_lab::table::Table;

use super::failure::Failure;
use super::{memory, output, process};

/// Measure frames by stage, size, mode and raster path, and the start of a process
#[derive(Debug, Args)]
#[command(after_help = "\
Sections, in the order in which they run:
  correct     every raster path and mode against the picture in double precision; always runs
  passes      each stage, by Gaussians, size (512, 1024 and 2048), mode and raster path
  bound       a frame against what it cannot do without: bytes, fragments and keys
  proportion  frames that show a hundredth of a scene
  start       from nothing to the first picture, in a process of its own
  model       frames that rara model predicts, by stage, beside what it predicts for the GPU that the device is

Examples:
  rara measure -o measured                # everything: the better part of an hour on two cores
  rara measure --quick                    # that everything runs: seconds
  rara measure passes --gaussians 500000 --sizes 1024
  rara measure passes start --scene scene.ply --cameras cameras.json -o measured

What is compared is measured in turn, round by round; ratios are of the same round. Tables have the median and, in brackets, \
the least. The folder of -o gets bench.csv, a line for each number. What draws a wrong picture is not timed, and exit status 1 \
says so.")]
pub(super) struct Measure {
    /// The sections to measure [default: all]
    #[arg(value_name = "SECTION", value_parser = PossibleValuesParser::from(run_time::sections()), hide_possible_values = true)]
    sections: Vec<String>,
    /// Tiny scenes and one round: only whether everything runs
    #[arg(long)]
    quick: bool,
    /// Folder for bench.csv; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// A scene file to measure instead of generated ones (repeatable)
    #[arg(long = "scene", value_name = "FILE")]
    scene_files: Vec<PathBuf>,
    /// The cameras that frames of these scenes take in turn [default: an orbit]
    #[arg(long, value_name = "FILE")]
    cameras: Option<PathBuf>,
    /// Gaussians of the generated scenes [default: each section's own]
    #[arg(long, value_name = "N,N...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    gaussians: Vec<u32>,
    /// Picture widths, px; only passes takes more than the first [default: 1024]
    #[arg(long, value_name = "N,N...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=16384))]
    sizes: Vec<u32>,
    /// Rounds at most; at least three, as many as half a minute gives [default: 9]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    rounds: Option<u32>,
    /// Number or part of the name of the device, as rara devices lists them
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
    /// Be the process whose start another one measures
    #[arg(long, hide = true)]
    child: bool,
}

impl Measure {
    pub(super) fn run(mut self) -> Result<(), Failure> {
        if let Some(folder) = &self.output {
            output::make_folder(folder)?;
        }
        process::make_drivers_folder();
        let options = RunTimeOptions {
            sections: self.sections.clone(),
            quick: self.quick,
            scenes: self.scene_files.clone(),
            cameras: self.cameras.clone(),
            gaussians: self.gaussians.clone(),
            sizes: self.sizes.clone(),
            rounds: self.rounds,
            device: HeadlessDesc::default().device(self.device.clone()),
        };
        if self.child {
            return Ok(run_time::start(&options, &mut output::answer)?);
        }
        let wrong = run_time::run_time(&options, &mut self)?;
        match wrong.is_empty() {
            true => Ok(()),
            false => Err(Error::Invalid(format!(
                "not timed, because the picture is wrong: {}",
                wrong.join(", ")
            ))
            .into()),
        }
    }
}

impl Program for Measure {
    fn hear(&mut self, what: &str) {
        output::say(what);
    }

    fn take(&mut self, table: &Table, all: &Table) -> rara::Result<()> {
        if let Some(folder) = &self.output {
            output::text(&folder.join("bench.csv"), &all.csv())?;
        }
        output::answer(&format!("\n{}", table.markdown()))
    }

    fn start(&self, scene: &Path, width: u32) -> rara::Result<Command> {
        let program = std::env::current_exe().map_err(Error::io("this program"))?;
        let mut command = Command::new(program);
        command.args(["measure", "--child", "--scene"]);
        command.arg(scene).args(["--sizes", &width.to_string()]);
        if let Some(cameras) = &self.cameras {
            command.arg("--cameras").arg(cameras);
        }
        if let Some(device) = &self.device {
            command.args(["--device", device]);
        }
        Ok(command)
    }

    fn check_room(&self, gaussians: u64) -> rara::Result<()> {
        memory::check_drawing(gaussians)
    }
}
