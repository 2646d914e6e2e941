//! The `rara` command: one file a command, and the pieces they share, of which [`parts`] are for programs beside it.
#![deny(unsafe_code)] // only the process's environment and signals need it
#![allow(missing_docs)] // it is no API

mod aspect;
mod bake;
mod batch;
mod camera;
mod clip;
mod combine;
mod compare;
mod convert;
mod demo;
mod devices;
mod failure;
mod film;
mod frame;
mod generate;
mod help;
mod info;
mod json_kind;
mod kept;
mod labels;
mod layer_clip;
mod layer_look;
mod layer_names;
mod memory;
mod moving;
mod near;
mod needs;
mod output;
mod panorama;
pub mod parts;
mod path;
mod pattern;
mod pictures;
mod place;
#[allow(unsafe_code)]
mod process;
mod profile;
mod program;
mod progress;
mod reading;
mod render;
mod report;
mod residual;
mod save_camera;
mod scenes;
mod section;
mod session;
mod settings;
mod sheet;
mod shell;
mod slice;
mod sweep;
mod times;
mod trained;
mod up;
mod values;
#[cfg(feature = "view")]
mod view;
mod views;
mod warm;

use std::path::Path;
use std::process::ExitCode;

use clap::Subcommand;

use failure::Failure;

#[derive(Debug, Subcommand)]
enum Command {
    Render(render::Render),
    #[cfg(feature = "view")]
    View(view::ViewCommand),
    Sweep(sweep::Sweep),
    Batch(batch::Batch),
    Demo(demo::Demo),
    Compare(compare::Compare),
    Convert(convert::Convert),
    Generate(generate::Generate),
    Bake(bake::Bake),
    Info(info::Info),
    Devices(devices::Devices),
    Warm(warm::Warm),
}

impl program::Commands for Command {
    const NAME: &'static str = "rara";
    const ABOUT: &'static str =
        "Draws 3D Gaussian Splatting scenes with Vulkan and cuts them exactly";
    const EXAMPLES: &'static str = "  rara render scene.ply -o picture.png
  rara render scene.ply -o cut.png --clip plane:1,0,0,-0.5
  rara sweep scene.ply --clip-normal 0,0,1 -o frames
  rara demo scene.ply -o out";
    const BESIDE: &'static str = "rara-lab has the commands that measure rara: bench, measure, \
         ablate, stress, paper, study and study-report";

    fn run(self) -> Result<(), Failure> {
        match self {
            Self::Render(command) => command.run(),
            #[cfg(feature = "view")]
            Self::View(command) => command.run(),
            Self::Sweep(command) => command.run(),
            Self::Batch(command) => command.run(),
            Self::Demo(command) => command.run(),
            Self::Compare(command) => command.run(),
            Self::Convert(command) => command.run(),
            Self::Generate(command) => command.run(),
            Self::Bake(command) => command.run(),
            Self::Info(command) => command.run(),
            Self::Devices(command) => command.run(),
            Self::Warm(command) => command.run(),
        }
    }

    fn save_job(
        file: &Path,
        command: &clap::Command,
        typed: &clap::ArgMatches,
    ) -> Result<(), Failure> {
        batch::save_job(file, command, typed)
    }
}

/// Runs `rara`.
pub fn main() -> ExitCode {
    program::main::<Command>()
}

#[cfg(test)]
mod tests {
    #[test]
    fn clap_finds_no_fault_with_the_definitions() {
        super::program::all::<super::Command>().debug_assert();
    }
}
