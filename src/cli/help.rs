//! `rara help`: the commands, all flags of one with a summary each, and everything about the flags of a topic.
//!
//! A topic is a heading under which commands list flags. `rara help COMMAND` and `rara COMMAND -h` have a summary of each flag;
//! `rara help TOPIC` and `rara COMMAND --help` have its whole text. All of them come from the flags' definitions alone.

use std::ffi::OsString;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::{Arg, ArgAction, Args, Command};

use super::failure::Failure;
use super::output;

/// List all flags of a command, or explain the flags of a topic
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  PROGRAM help
  PROGRAM help clip")]
pub(super) struct Help {
    /// A command or a topic
    #[arg(value_name = "COMMAND|TOPIC")]
    of: Option<String>,
}

/// Returns the definitions of a program's flags as people see them, given those that were written.
pub(super) fn command(definitions: Command) -> Command {
    let program = definitions.get_name().to_owned();
    let listed = format!(
        "The help topics are {}.",
        all_topics(&definitions).join(", ")
    );
    let help = Arg::new("help")
        .short('h')
        .long("help")
        .help("List the flags (-h), or explain each of them (--help)")
        .action(ArgAction::Help)
        .display_order(1000);
    let overview = definitions.get_after_help().map(StyledStr::to_string);
    let overview = overview.map_or(String::new(), |overview| format!("{overview}\n\n"));
    let command = definitions
        .disable_help_flag(true)
        .after_help(format!("{overview}{listed}"))
        .mut_subcommands(|part| {
            // What a command writes comes first, and the rest as it is defined.
            let mut order = 0;
            let part = part.mut_args(|arg| {
                order += 1;
                let is_output = arg.get_id() == "output";
                // A number below zero is the flag's value, of which the flag says what is wrong, and no other flag.
                let takes_numbers = !arg.is_positional() && arg.get_action().takes_values();
                arg.display_order(if is_output { 0 } else { order })
                    .allow_negative_numbers(takes_numbers)
            });
            let names: Vec<_> = topics(&part).iter().map(|heading| topic(heading)).collect();
            let more = match part.get_name() {
                "help" => listed.clone(),
                _ if part.get_arguments().all(|arg| arg.get_long_help().is_none()) => return part,
                name if names.is_empty() => format!("{program} {name} --help explains each flag."),
                name => format!(
                    "{program} {name} --help explains each flag, and {program} help TOPIC explains the flags of the {} {}.",
                    if names.len() == 1 { "topic" } else { "topics" },
                    names.join(", ")
                ),
            };
            let after = part.get_after_help().map(StyledStr::to_string);
            let after = after.map_or(String::new(), |after| format!("{after}\n\n"));
            part.after_help(format!("{after}{more}"))
        })
        .mut_subcommands(|part| {
            let Some(after) = part.get_after_help() else {
                return part;
            };
            let after = unwrapped(&after.to_string().replace("PROGRAM", &program));
            let long = part.get_after_long_help().map(StyledStr::to_string);
            match long {
                Some(long) => part.after_long_help(format!("{}\n\n{after}", unwrapped(&long))),
                None => part,
            }
            .after_help(after)
        });
    command.arg(help.global(true))
}

/// A text whose paragraphs are a line each, so that they are wrapped once. Lines that begin with a blank stay as they are.
fn unwrapped(text: &str) -> String {
    let mut whole = String::new();
    let mut was_prose = false;
    for line in text.lines() {
        let is_prose = !line.is_empty() && !line.starts_with(' ') && !line.ends_with(':');
        if !whole.is_empty() {
            whole.push(if was_prose && is_prose { ' ' } else { '\n' });
        }
        whole += line;
        was_prose = is_prose;
    }
    whole
}

/// The headings under which a command lists flags, in its order.
fn topics(command: &Command) -> Vec<String> {
    let mut topics: Vec<String> = Vec::new();
    for heading in command.get_arguments().filter_map(Arg::get_help_heading) {
        if !topics.iter().any(|known| known == heading) {
            topics.push(heading.to_owned());
        }
    }
    topics
}

/// The names of the topics of all commands, each once.
fn all_topics(program: &Command) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for heading in program.get_subcommands().flat_map(topics) {
        let topic = topic(&heading);
        if !all.contains(&topic) {
            all.push(topic);
        }
    }
    all
}

/// The name by which a heading is asked for: its first word.
fn topic(heading: &str) -> String {
    let word = heading.split(|letter: char| !letter.is_alphabetic()).next();
    word.unwrap_or_default().to_lowercase()
}

impl Help {
    /// Prints the help of a program's commands; `beside` is the sentence of which program has others.
    pub(super) fn run(self, mut command: Command, beside: &str) -> Result<(), Failure> {
        command.build();
        let Some(of) = self.of else {
            return Ok(output::answer(&command.render_help().to_string())?);
        };
        if let Some(part) = command.find_subcommand(&of) {
            return Ok(output::answer(&of_command(part))?);
        }
        let mut known: Vec<String> = Vec::new();
        for part in command.get_subcommands() {
            known.push(part.get_name().to_owned());
            let of_topic = |arg: &&Arg| {
                let heading = arg.get_help_heading();
                heading.is_some_and(|heading| topic(heading) == of)
            };
            let flags: Vec<Arg> = part.get_arguments().filter(of_topic).cloned().collect();
            if !flags.is_empty() {
                let whose = format!(
                    "These are flags of {} {}, and of other commands that list them.",
                    command.get_name(),
                    part.get_name()
                );
                let flags = page(flags).render_long_help();
                return Ok(output::answer(&format!("{flags}\n{whose}"))?);
            }
        }
        known.extend(all_topics(&command));
        let meant = super::values::meant(&of, known.iter().map(String::as_str));
        Err(Failure::Usage(format!(
            "help {of}: this is neither a command nor a topic; there are {}{meant}; {beside}",
            known.join(", ")
        )))
    }
}

/// Flags that rara does not have although other programs do, and rara's own with the same purpose.
const MEANT: &[(&str, &[&str])] = &[
    ("--width", &["size"]),
    ("--height", &["size"]),
    ("--resolution", &["size"]),
    ("--near", &["clip-near", "near-cut"]),
    ("--far", &["clip-far"]),
    ("--fov", &["fov-y"]),
    ("--opacity", &["layer-opacity", "min-opacity"]),
    ("--bg", &["background"]),
    ("--out", &["output"]),
];

/// An error about words that were typed, with the flag that is meant by one that does not exist. Clap's own tips go by the
/// letters of a name, not by its purpose; and nobody means a flag to be the name of a scene.
pub(super) fn with_tip(mut error: Error, program: &Command, words: &[OsString]) -> Error {
    let Some(ContextValue::String(wrong)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let meant = MEANT.iter().find(|(other, _)| other == wrong);
    error.remove(ContextKind::Suggested);
    let Some((_, meant)) = meant else {
        return error;
    };
    error.remove(ContextKind::SuggestedArg);
    let mut program = program.clone();
    program.build(); // without which flags have no text
    let mut parts = words
        .iter()
        .filter_map(|word| program.find_subcommand(word));
    let flags = parts.next().into_iter().flat_map(Command::get_arguments);
    let flags = flags.filter(|flag| flag.get_long().is_some_and(|long| meant.contains(&long)));
    let tips = flags.map(|flag| {
        let summary = flag.get_help().map(ToString::to_string);
        format!("{flag} ({})", summary.unwrap_or_default())
    });
    let tips: Vec<String> = tips.collect();
    if !tips.is_empty() {
        let tip = format!("use {}", tips.join(" or ")).into();
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}

/// A page with all that is to be said of flags.
fn page(flags: Vec<Arg>) -> Command {
    Command::new("page")
        .version(env!("CARGO_PKG_VERSION")) // which a flag among them prints
        .disable_version_flag(true)
        .disable_help_flag(true)
        .max_term_width(100)
        .help_template("{all-args}")
        .args(flags)
}

/// All flags of a command with a summary each, and all else that its help says.
fn of_command(command: &Command) -> String {
    let after = command.get_after_long_help().cloned();
    let after = after.or_else(|| command.get_after_help().cloned());
    let mut command = command.clone().after_help(after.unwrap_or_default());
    command.render_help().to_string()
}

#[cfg(test)]
mod tests;
