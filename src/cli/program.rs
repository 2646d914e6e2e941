//! What programs of commands have in common: the command line, help, and how they end.
//!
//! A command goes from the text of the flags (clap's structs) to what they mean (the library's types, checked once) to the
//! work. Only [`output::answer`] writes to stdout what a command was asked for; everything else goes to stderr.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue};
use clap::{ArgMatches, Command, FromArgMatches, Parser, Subcommand};

use super::failure::Failure;
use super::{help, needs, output, process, shell};

/// The commands of a program, whose order is that of its help.
pub trait Commands: Subcommand {
    /// The program's name.
    const NAME: &'static str;
    /// The sentence of what it does.
    const ABOUT: &'static str;
    /// Its examples, a line each.
    const EXAMPLES: &'static str;
    /// The sentence of which program has other commands.
    const BESIDE: &'static str;

    /// Does the work.
    ///
    /// # Errors
    /// If the command line is wrong or the work failed.
    fn run(self) -> Result<(), Failure>;

    /// Saves what was typed of a command as a job of a batch.
    ///
    /// # Errors
    /// If it cannot be written, and for a program that has no batches.
    fn save_job(file: &Path, _command: &Command, _typed: &ArgMatches) -> Result<(), Failure> {
        let text = format!(
            "{} has no batches, for which {} could be a job",
            Self::NAME,
            file.display()
        );
        Err(Failure::Usage(text))
    }
}

#[derive(Debug, Parser)]
#[command(
    version,
    propagate_version = true,
    disable_help_subcommand = true, // there is one of our own
    arg_required_else_help = true,
    max_term_width = 100
)]
struct Line<C: Commands> {
    /// Print only the requested result and errors
    ///
    /// Notes, warnings and progress are not printed.
    #[arg(short, long, global = true, display_order = 900)]
    quiet: bool,
    #[command(subcommand)]
    command: All<C>,
}

#[derive(Debug, Subcommand)]
enum All<C: Commands> {
    #[command(flatten)]
    Own(C),
    Completions(shell::Completions),
    Man(shell::Man),
    Help(help::Help),
}

/// The definitions of a program's flags, as they were written.
pub(super) fn definitions<C: Commands>() -> Command {
    let command = <Line<C> as clap::CommandFactory>::command();
    command
        .name(C::NAME)
        .about(C::ABOUT)
        .after_help(format!(
            "Examples:\n{}\n\n{}.\n\nThe exit status is 0 if the command succeeded, 1 if it failed, and 2 if the command line is wrong.",
            C::EXAMPLES,
            C::BESIDE
        ))
}

/// The definitions of a program's flags, as people see them.
pub(super) fn all<C: Commands>() -> Command {
    help::command(definitions::<C>())
}

impl<C: Commands> All<C> {
    fn run(self) -> Result<(), Failure> {
        match self {
            Self::Own(command) => command.run(),
            Self::Completions(command) => command.run(all::<C>()),
            Self::Man(command) => command.run(all::<C>()),
            Self::Help(command) => command.run(all::<C>(), C::BESIDE),
        }
    }
}

/// A command line, and where its values are from.
fn parsed<C: Commands>(
    words: impl Iterator<Item = OsString>,
) -> Result<(Line<C>, ArgMatches), clap::Error> {
    let words: Vec<_> = words.collect();
    let typed = all::<C>().try_get_matches_from(&words);
    let typed = typed.map_err(|error| help::with_tip(error, &all::<C>(), &words))?;
    let line = Line::from_arg_matches(&typed);
    let line = line.map_err(|error| error.format(&mut all::<C>()))?;
    Ok((line, typed))
}

/// The command that somebody would have typed, whose flags all have an effect; none where it is one that every program has.
pub(super) fn command<C: Commands>(
    words: impl Iterator<Item = OsString>,
) -> Result<Option<C>, Failure> {
    let (line, typed) = parsed(words)?;
    needs_met::<C>(&typed)?;
    Ok(match line.command {
        All::Own(command) => Some(command),
        _ => None,
    })
}

/// Runs what was typed, or saves it as a job where that is wanted.
fn run<C: Commands>(line: Line<C>, typed: &ArgMatches) -> Result<(), Failure> {
    needs_met::<C>(typed)?;
    if let Some((name, typed)) = typed.subcommand()
        && let Ok(Some(file)) = typed.try_get_one::<PathBuf>("save_job")
    {
        let all = all::<C>();
        let command = all.find_subcommand(name).expect("it was typed");
        return C::save_job(file, command, typed);
    }
    line.command.run()
}

/// Fails where a flag has no effect.
fn needs_met<C: Commands>(typed: &ArgMatches) -> Result<(), Failure> {
    let all = all::<C>();
    match typed.subcommand() {
        Some((name, typed)) => {
            let command = all.find_subcommand(name);
            command.map_or(Ok(()), |command| needs::check(command, typed))
        }
        None => Ok(()),
    }
}

/// Why a command line is not understood. A command of another program is not taken for a misspelt one of this.
fn refusal<C: Commands>(error: clap::Error) -> Failure {
    let mut others = C::BESIDE.split([' ', ',']);
    match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(name)) if others.any(|other| other == name) => {
            Failure::Usage(format!("there is no command {name} here; {}", C::BESIDE))
        }
        _ => error.into(),
    }
}

/// Parses the command line, runs the command, and turns a failure into its sentence and exit status.
pub fn main<C: Commands>() -> ExitCode {
    output::begin(C::NAME);
    process::begin();
    output::tell_warnings();
    let outcome = match parsed::<C>(std::env::args_os()) {
        Ok((line, typed)) => {
            if line.quiet {
                output::be_quiet();
            }
            run(line, &typed)
        }
        Err(error) if !error.use_stderr() => {
            // `--help` and `--version` arrive as errors too; a closed pipe is the reader's business.
            let _ = error.print();
            Ok(())
        }
        Err(error) => Err(refusal::<C>(error)),
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
