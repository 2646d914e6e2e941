//! `rara-lab measure`: what frames take by stage, and what happens before the first one.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;
use clap::builder::PossibleValuesParser;
use rara::{Error, HeadlessDesc};
use rara_cli::parts::{
    Failure, answer, check_drawing, make_drivers_folder, make_folder, one_file, say, text,
};
use rara_lab::run_time::{self, Program, RunTimeOptions};
use rara_lab::table::Table;

/// Measure frames by stage, size, mode and raster path, and the start of a process
#[derive(Debug, Args)]
#[command(after_help = "\
Sections, in the order in which they run:
  correct     compares every raster path and mode with the picture in double precision; always runs, but for --unchecked
  passes      times each stage, by Gaussians, size (512, 1024, 2048), mode and raster path
  bound       compares a frame with the bytes, fragments and keys that it cannot avoid
  proportion  times frames that show a hundredth of a scene
  start       times a process of its own, from its start to its first picture
  fixed       times dispatches that do nothing, one waiting for the other
  full-hd     times frames at 1920x1080 by stage, whole and cut by a plane, a sphere and a combination, drawn with tiles

Examples:
  rara-lab measure -o measured                # measures everything: nearly an hour on two cores
  rara-lab measure --quick                    # checks that everything runs: seconds
  rara-lab measure passes --gaussians 500000 --sizes 1024
  rara-lab measure passes start --scene scene.ply --cameras cameras.json -o measured

Things that are compared take turns: each round measures all of them once, and a ratio compares times of the same round. Tables have \
the median and, in brackets, the smallest value. The folder of -o gets bench.csv, with a line for each number. If a combination draws a \
wrong picture, it is not timed, and the exit status is 1.")]
pub(super) struct Measure {
    /// The sections to measure [default: all]
    #[arg(value_name = "SECTION", value_parser = PossibleValuesParser::from(run_time::sections()), hide_possible_values = true)]
    sections: Vec<String>,
    /// Only check that everything runs, with tiny scenes and one round
    #[arg(long)]
    quick: bool,
    /// Leave out section correct where other sections are named
    #[arg(long, requires = "sections")]
    unchecked: bool,
    /// Folder for bench.csv; created if it does not exist
    #[arg(short, long, value_name = "DIR", value_parser = one_file())]
    output: Option<PathBuf>,
    /// A scene file to measure instead of generated ones (repeatable)
    #[arg(long = "scene", value_name = "FILE")]
    scene_files: Vec<PathBuf>,
    /// The cameras that draw the scenes of --scene, one frame each in turn [default: an orbit]
    #[arg(long, value_name = "FILE")]
    cameras: Option<PathBuf>,
    /// Numbers of Gaussians of the generated scenes [default: depends on the section]
    #[arg(long, value_name = "N,N...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    gaussians: Vec<u32>,
    /// Picture widths in px; passes uses all, full-hd none, other sections the first [default: 1024]
    #[arg(long, value_name = "N,N...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=16384))]
    sizes: Vec<u32>,
    /// Most rounds; fewer, but at least three, if they take over half a minute [default: 9]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    rounds: Option<u32>,
    /// A folder with SPIR-V modules, named as in glsl/spirv, that full-hd measures in the place of the program's own (repeatable)
    #[arg(long, value_name = "DIR")]
    modules: Vec<PathBuf>,
    /// Number of the device, or part of its name, as rara devices prints them
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
    /// Be the process whose start another one measures
    #[arg(long, hide = true, requires = "scene_files")]
    child: bool,
}

impl Measure {
    pub(super) fn run(mut self) -> Result<(), Failure> {
        if let Some(folder) = &self.output {
            make_folder(folder)?;
        }
        make_drivers_folder();
        let options = RunTimeOptions {
            sections: self.sections.clone(),
            unchecked: self.unchecked,
            quick: self.quick,
            scenes: self.scene_files.clone(),
            cameras: self.cameras.clone(),
            gaussians: self.gaussians.clone(),
            sizes: self.sizes.clone(),
            rounds: self.rounds,
            modules: self.modules.clone(),
            device: HeadlessDesc::default().device(self.device.clone()),
        };
        if self.child {
            return Ok(run_time::start(&options, &mut answer)?);
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
        say(what);
    }

    fn take(&mut self, table: &Table, all: &Table) -> rara::Result<()> {
        if let Some(folder) = &self.output {
            text(&folder.join("bench.csv"), &all.csv())?;
        }
        answer(&format!("\n{}", table.markdown()))
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
        check_drawing(gaussians)
    }
}
