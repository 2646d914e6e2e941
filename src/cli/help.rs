//! `rara help`: the commands, the flags of one in a line or two each, and all that is to be said of a topic.
//!
//! A topic is a heading under which commands list flags. Their help has a summary of each flag, a topic all of its text, so that
//! both come from the flags' definitions alone.

use clap::builder::StyledStr;
use clap::{Arg, ArgAction, Args, Command};

use super::failure::Failure;
use super::output;

/// Print the flags of a command, or everything about a topic
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
        .help("Print help")
        .action(ArgAction::HelpShort)
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
                arg.display_order(if is_output { 0 } else { order })
            });
            let topics = topics(&part);
            let names: Vec<_> = topics.iter().map(|heading| topic(heading)).collect();
            let more = match part.get_name() {
                "help" => listed.clone(),
                _ if topics.is_empty() => return part,
                name => format!(
                    "{0} help {1} explains the flags of the command, and {0} help TOPIC explains those of the {2} {3}.",
                    program,
                    name,
                    if names.len() == 1 { "topic" } else { "topics" },
                    names.join(", ")
                ),
            };
            let after = part.get_after_help().map(StyledStr::to_string);
            let after = after.map_or(String::new(), |after| format!("{after}\n\n"));
            part.after_help(format!("{after}{more}"))
        })
        .mut_subcommands(|part| match part.get_after_help() {
            Some(after) => {
                let after = after.to_string().replace("PROGRAM", &program);
                part.after_help(unwrapped(&after))
            }
            None => part,
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
            "help {of}: there is no such command or topic; there are {}{meant}; {beside}",
            known.join(", ")
        )))
    }
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

/// All that is to be said of a command, but for its topics.
fn of_command(command: &Command) -> String {
    let own = command.get_arguments();
    let own = own.filter(|arg| arg.get_help_heading().is_none() && arg.get_id() != "help");
    let usage = command.clone().render_usage();
    let about = command.get_about().cloned().unwrap_or_default();
    let after = [command.get_after_long_help(), command.get_after_help()];
    let after: Vec<String> = after.iter().flatten().map(ToString::to_string).collect();
    let page = page(own.cloned().collect())
        .help_template("{all-args}{after-help}")
        .after_help(unwrapped(&after.join("\n\n")));
    format!("{about}\n\n{usage}\n\n{}", page.clone().render_long_help())
}

#[cfg(test)]
mod tests;
