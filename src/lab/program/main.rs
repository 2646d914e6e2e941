//! The program `rara-lab`: what measures rara, with the flags of `rara`.

#![forbid(unsafe_code)]

mod ablate;
mod bench;
mod measure;
mod paper;
mod stress;
mod study;

use std::process::ExitCode;

use clap::Subcommand;
use rara_cli::parts::{self, Commands, Failure};

#[derive(Debug, Subcommand)]
enum Command {
    Bench(bench::Bench),
    Measure(measure::Measure),
    Ablate(ablate::Ablate),
    Stress(stress::Stress),
    Paper(paper::Paper),
    Study(study::Study),
    StudyReport(study::StudyReport),
}

impl Commands for Command {
    const NAME: &'static str = "rara-lab";
    const ABOUT: &'static str = "Measures rara, and repeats the experiments of the paper";
    const EXAMPLES: &'static str = "  rara-lab bench scene.ply -o bench
  rara-lab measure passes -o measured
  rara-lab paper -o report";
    const BESIDE: &'static str = "rara has the commands that draw and convert scenes: render, view, \
         sweep, batch, demo, compare, convert, generate, bake, info, devices and warm";

    fn run(self) -> Result<(), Failure> {
        match self {
            Self::Bench(command) => command.run(),
            Self::Measure(command) => command.run(),
            Self::Ablate(command) => command.run(),
            Self::Stress(command) => command.run(),
            Self::Paper(command) => command.run(),
            Self::Study(command) => command.run(),
            Self::StudyReport(command) => command.run(),
        }
    }
}

fn main() -> ExitCode {
    parts::main::<Command>()
}
