//! The `rara` command: one file a command, and the pieces they share.
//!
//! Each command goes from the text of the flags (clap's structs) to what they mean (the library's types, checked once) to
//! the work. Only [`output::answer`] writes to stdout what a command was asked for; everything else goes to stderr.
#![deny(unsafe_code)] // only the process's environment and signals need it

mod ablate;
mod aspect;
mod axis;
mod bake;
mod batch;
mod bench;
mod camera;
mod clip;
mod combine;
mod compare;
mod convert;
mod dataparser;
mod demo;
mod devices;
mod failure;
mod film;
mod frame;
mod framing;
mod generate;
mod help;
mod info;
mod ink;
mod json_kind;
mod kept;
mod layer_clip;
mod layer_place;
mod lens;
mod measure;
mod memory;
mod model;
mod needs;
mod output;
mod panorama;
mod paper;
mod path;
mod pattern;
mod pictures;
mod place;
mod precision;
#[allow(unsafe_code)]
mod process;
mod profile;
mod progress;
mod reading;
mod region;
mod render;
mod report;
mod residual;
mod save_camera;
mod scene_file;
mod scene_layers;
mod scenes;
mod section;
mod select;
mod session;
mod settings;
mod sheet;
mod shell;
mod slice;
mod stress;
mod study;
mod sweep;
mod times;
mod trained;
mod training;
mod values;
#[cfg(feature = "view")]
mod view;
mod views;
mod warm;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{ArgMatches, FromArgMatches, Parser, Subcommand};

use failure::Failure;

/// Draws 3D Gaussian Splatting scenes with Vulkan and cuts them exactly.
#[derive(Debug, Parser)]
#[command(
    name = "rara",
    version,
    propagate_version = true,
    disable_help_subcommand = true, // there is one of our own
    arg_required_else_help = true,
    max_term_width = 100
)]
#[command(after_help = "\
Examples:
  rara render scene.ply -o picture.png
  rara render scene.ply -o cut.png --clip plane:1,0,0,-0.5
  rara sweep scene.ply --clip-normal 0,0,1 -o frames
  rara demo scene.ply -o out

Exit status: 0 done, 1 the work failed, 2 the command line is wrong.")]
struct Cli {
    /// Print only what was asked for, and why something failed
    ///
    /// No notes, no warnings, no progress.
    #[arg(short, long, global = true, display_order = 900)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(render::Render),
    #[cfg(feature = "view")]
    View(view::ViewCommand),
    Sweep(sweep::Sweep),
    Batch(batch::Batch),
    Ablate(ablate::Ablate),
    Bench(bench::Bench),
    Measure(measure::Measure),
    Paper(paper::Paper),
    Study(study::Study),
    StudyReport(study::StudyReport),
    Model(model::Model),
    Demo(demo::Demo),
    Compare(compare::Compare),
    Convert(convert::Convert),
    Generate(generate::Generate),
    Bake(bake::Bake),
    Info(info::Info),
    Stress(stress::Stress),
    Devices(devices::Devices),
    Warm(warm::Warm),
    Completions(shell::Completions),
    Man(shell::Man),
    Help(help::Help),
}

impl Command {
    fn run(self) -> Result<(), Failure> {
        match self {
            Self::Render(command) => command.run(),
            #[cfg(feature = "view")]
            Self::View(command) => command.run(),
            Self::Sweep(command) => command.run(),
            Self::Batch(command) => command.run(),
            Self::Ablate(command) => command.run(),
            Self::Bench(command) => command.run(),
            Self::Measure(command) => command.run(),
            Self::Paper(command) => command.run(),
            Self::Study(command) => command.run(),
            Self::StudyReport(command) => command.run(),
            Self::Model(command) => command.run(),
            Self::Demo(command) => command.run(),
            Self::Compare(command) => command.run(),
            Self::Convert(command) => command.run(),
            Self::Generate(command) => command.run(),
            Self::Bake(command) => command.run(),
            Self::Info(command) => command.run(),
            Self::Stress(command) => command.run(),
            Self::Devices(command) => command.run(),
            Self::Warm(command) => command.run(),
            Self::Completions(command) => command.run(),
            Self::Man(command) => command.run(),
            Self::Help(command) => command.run(),
        }
    }
}

/// A command line, and where its values are from.
fn parsed(words: impl Iterator<Item = OsString>) -> Result<(Cli, ArgMatches), clap::Error> {
    let typed = help::command().try_get_matches_from(words)?;
    let cli = Cli::from_arg_matches(&typed);
    let cli = cli.map_err(|error| error.format(&mut help::command()))?;
    Ok((cli, typed))
}

/// Runs what was typed, or saves it as a job where that is wanted.
fn run(cli: Cli, typed: &ArgMatches) -> Result<(), Failure> {
    needs_met(typed)?;
    if let Some((name, typed)) = typed.subcommand()
        && let Ok(Some(file)) = typed.try_get_one::<PathBuf>("save_job")
    {
        let all = help::command();
        let command = all.find_subcommand(name).expect("it was typed");
        return batch::save_job(file, command, typed);
    }
    cli.command.run()
}

/// Fails where a flag has no effect.
fn needs_met(typed: &ArgMatches) -> Result<(), Failure> {
    let all = help::command();
    match typed.subcommand() {
        Some((name, typed)) => {
            let command = all.find_subcommand(name);
            command.map_or(Ok(()), |command| needs::check(command, typed))
        }
        None => Ok(()),
    }
}

/// Parses the command line, runs the command, and turns a failure into its sentence and exit status.
fn main() -> ExitCode {
    process::begin();
    output::tell_warnings();
    let outcome = match parsed(std::env::args_os()) {
        Ok((cli, typed)) => {
            if cli.quiet {
                output::be_quiet();
            }
            run(cli, &typed)
        }
        Err(error) if !error.use_stderr() => {
            // `--help` and `--version` arrive as errors too; a closed pipe is the reader's business.
            let _ = error.print();
            Ok(())
        }
        Err(error) => Err(error.into()),
    };
    match outcome {
        Ok(()) => {
            output::end();
            ExitCode::SUCCESS
        }
        Err(failure) => {
            failure.details().for_each(output::complain);
            output::complain(&failure);
            failure.exit_code()
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn clap_finds_no_fault_with_the_definitions() {
        super::help::command().debug_assert();
    }
}
