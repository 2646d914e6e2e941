//! Some flags have no effect without others. Clap's own `requires` waives what conflicts with something that is given, and
//! would then leave a flag without any.

#[cfg(all(test, feature = "view"))]
mod tests;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};

use super::failure::Failure;
use super::output;

enum Need {
    /// One of these flags.
    Flag(&'static [&'static str]),
    /// This flag with one of these values.
    Value(&'static str, &'static [&'static str]),
    /// This flag with another value.
    Other(&'static str, &'static str),
    /// Two of these flags, or one of them twice.
    Two(&'static [&'static str]),
    /// This flag must not be given.
    Without(&'static str),
}

use Need::{Flag, Other, Two, Value, Without};

/// Something that cuts.
const CUT: Need = Flag(&["section", "clip", "clip_expr", "clip_file", "lasso", "from"]);

/// The needs of the flags that have any, by the flags' names in the definitions; where a command has none of the flags
/// that are needed, it needs nothing. Where a value is needed a note says so, since scripts give such flags to one value
/// after another.
const NEEDS: &[(&str, Need)] = &[
    // What is written.
    ("aov", Flag(&["output"])),
    ("skip_existing", Flag(&["output"])),
    ("save_job", Flag(&["output"])),
    ("png", Flag(&["output"])),
    ("fps", Flag(&["output"])),
    ("alpha", Flag(&["output"])),
    ("format", Flag(&["output"])),
    (
        "part",
        Flag(&["path", "view", "section", "clip_normal", "from"]),
    ),
    // The camera.
    ("up", Other("views", "0")),
    ("cameras", Flag(&["scene_files"])),
    ("undistort", Flag(&["cameras", "camera", "view", "path"])),
    ("size", Other("views", "0")),
    ("frames", Flag(&["path", "clip_normal", "from"])),
    ("ease", Flag(&["path", "clip_normal", "from"])),
    // Sections.
    ("section_thickness", Flag(&["section"])),
    ("section_thickness", Without("slice")),
    ("section_scale", Flag(&["section"])),
    ("slice", Flag(&["section"])),
    ("opaque", Flag(&["slice"])),
    ("outline", CUT),
    ("outline_width", Flag(&["outline"])),
    ("rim", CUT),
    ("rim_width", Flag(&["rim"])),
    ("cut_level", Flag(&["outline", "rim", "opaque"])),
    // The clip. A file may hold several shapes, and sections refuse `or` themselves.
    (
        "clip_op",
        Two(&[
            "clip",
            "clip_expr",
            "clip_file",
            "clip_file",
            "section",
            "section",
            "lasso",
            "lasso",
            "clip_normal",
            "from",
        ]),
    ),
    ("lasso", Without("section")),
    ("from", Flag(&["to"])),
    ("to", Flag(&["from"])),
    // How it is drawn.
    ("decay", Value("mode", &["exact", "rara"])),
    ("trace_all", Value("mode", &["exact", "rara"])),
    ("sigma", Value("mode", &["rara"])),
    ("miss", Value("mode", &["rara"])),
    ("phi", Value("mode", &["exact"])),
    ("beam_switch", Value("mode", &["exact"])),
    ("transmittance_min", Value("raster", &["tiles", "auto"])),
    ("device", Other("views", "0")),
    ("validation", Other("views", "0")),
    ("no_pipeline_cache", Other("views", "0")),
    // Of single commands.
    ("children", Value("mode", &["exact", "rara"])),
    ("leave", Value("mode", &["exact", "rara"])),
];

/// Refuses flags of a command that have no effect together with what else was typed, or says so.
pub(super) fn check(command: &Command, typed: &ArgMatches) -> Result<(), Failure> {
    for (flag, need) in NEEDS {
        let is_typed =
            |id: &str| has(command, id) && typed.value_source(id) == Some(ValueSource::CommandLine);
        if !is_typed(flag) {
            continue;
        }
        let shown = shown(command, flag);
        match need.missing(command, typed) {
            None => {}
            Some((what, true)) => {
                let relation = match need {
                    Without(_) => "together with",
                    _ => "without",
                };
                output::say(format_args!(
                    "note: {shown} changes nothing {relation} {what}"
                ));
            }
            Some((what, false)) => {
                let it = match need {
                    Flag(ids) if ids.iter().filter(|id| has(command, id)).count() > 1 => {
                        "one of them"
                    }
                    _ => "it",
                };
                let give = match need.rival(command, typed) {
                    Some(rival) => format!("give {it} in place of {rival}"),
                    None => format!("give {it}"),
                };
                return Err(Failure::Usage(format!(
                    "{shown} changes nothing without {what}: {give}, or leave out {shown}"
                )));
            }
        }
    }
    Ok(())
}

impl Need {
    /// What is missing, if something is, and whether that is only worth a note.
    fn missing(&self, command: &Command, typed: &ArgMatches) -> Option<(String, bool)> {
        let count = |ids: &[&str]| -> usize {
            let ids = ids.iter().filter(|id| has(command, id));
            let is_typed = |id: &&&str| typed.value_source(id) == Some(ValueSource::CommandLine);
            let occurrences = |id: &&str| typed.indices_of(id).map_or(1, Iterator::count);
            ids.filter(is_typed).map(occurrences).sum()
        };
        let is = |id: &str, value: &str| {
            typed
                .get_raw(id)
                .is_some_and(|mut raw| raw.any(|raw| raw == value))
        };
        match *self {
            Flag(ids) if ids.iter().any(|id| has(command, id)) => {
                let names: Vec<_> = (ids.iter().filter(|id| has(command, id)))
                    .map(|id| shown(command, id))
                    .collect();
                (count(ids) == 0).then(|| (either(&names), false))
            }
            // A window's keys choose other values.
            Value(..) | Other(..) if command.get_name() == "view" => None,
            Value(id, values) if has(command, id) && !values.iter().any(|value| is(id, value)) => {
                Some((format!("{} {}", shown(command, id), either(values)), true))
            }
            Other(id, value) if has(command, id) && is(id, value) => {
                let name = shown(command, id);
                Some((format!("{name} other than {value}"), true))
            }
            Without(id) if count(&[id]) > 0 => Some((shown(command, id), true)),
            Two(ids) if count(ids) < 2 => Some(("a second shape".into(), true)),
            _ => None,
        }
    }

    /// What was typed that each of the needed flags conflicts with.
    fn rival(&self, command: &Command, typed: &ArgMatches) -> Option<String> {
        let Flag(ids) = self else {
            return None;
        };
        let is_typed = |id: &str| {
            typed
                .value_source(id)
                .is_some_and(|source| source == ValueSource::CommandLine)
        };
        let conflict = |a: &Arg, b: &Arg| command.get_arg_conflicts_with(a).contains(&b);
        let needed = || {
            command
                .get_arguments()
                .filter(|arg| ids.contains(&arg.get_id().as_str()))
        };
        let mut given = command
            .get_arguments()
            .filter(|arg| is_typed(arg.get_id().as_str()));
        let rival =
            given.find(|given| needed().all(|need| conflict(given, need) || conflict(need, given)));
        rival.map(|rival| shown(command, rival.get_id().as_str()))
    }
}

/// "a, b or c".
fn either<T: std::borrow::Borrow<str>>(names: &[T]) -> String {
    match names {
        [others @ .., last] if !others.is_empty() => {
            format!("{} or {}", others.join(", "), last.borrow())
        }
        names => names.concat(),
    }
}

fn has(command: &Command, id: &str) -> bool {
    command
        .get_arguments()
        .any(|argument| argument.get_id() == id)
}

fn shown(command: &Command, id: &str) -> String {
    let mut arguments = command.get_arguments();
    let argument = arguments.find(|argument| argument.get_id() == id);
    let long = argument.and_then(|argument| argument.get_long());
    format!("--{}", long.unwrap_or(id))
}
