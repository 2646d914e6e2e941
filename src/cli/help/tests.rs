//! Tests of the help of `rara`.

use std::collections::HashMap;

use super::*;
use crate::program::all;

fn parts() -> Vec<Command> {
    let mut command = all::<crate::Command>();
    command.build();
    command.get_subcommands().cloned().collect()
}

fn help(part: &Command) -> String {
    part.clone().render_help().to_string()
}

#[test]
fn the_help_of_a_command_is_short_and_begins_with_its_output() {
    for part in parts() {
        let (name, text) = (part.get_name(), help(&part));
        let lines = text.lines().count();
        assert!(lines <= 200, "{name}: {lines} lines");
        let options = text.split_once("Options:\n").map(|(_, rest)| rest);
        let first = options.and_then(|rest| rest.lines().next()).unwrap_or("");
        let writes = part.get_arguments().any(|arg| arg.get_id() == "output");
        assert!(!writes || first.contains("--output"), "{name}: {first}");
    }
}

#[test]
fn a_command_lists_all_of_its_flags_by_their_headings() {
    for part in parts() {
        let text = of_command(&part);
        let mut rest = text.as_str();
        for heading in topics(&part) {
            let at = rest.find(&format!("\n{heading}:\n"));
            rest = &rest[at.unwrap_or_else(|| panic!("{}: {heading}", part.get_name()))..];
        }
        for arg in part.get_arguments() {
            let names = arg
                .get_long()
                .map(|long| [" ", "["].map(|end| format!("--{long}{end}")));
            let summary = arg.get_help().map(ToString::to_string).unwrap_or_default();
            let word = summary.split(' ').next().unwrap_or_default();
            let mut lines = text.lines();
            let is_named = |line: &str| names.iter().flatten().any(|name| line.contains(name));
            let is_of = |line: &&str| names.is_none() || is_named(line);
            assert!(
                lines.any(|line| is_of(&line) && line.contains(word)),
                "{arg:?}"
            );
        }
        assert!(
            !text.contains("\n\n          "),
            "{}: {text}",
            part.get_name()
        );
    }
}

#[test]
fn texts_are_for_readers_of_a_terminal() {
    let mut long: Vec<String> = Vec::new();
    for part in parts() {
        for arg in part.get_arguments() {
            let name = format!("{} {}", part.get_name(), arg.get_id());
            let summary = arg.get_help().map(ToString::to_string).unwrap_or_default();
            if summary.len() > 90 || summary.is_empty() || summary.ends_with('.') {
                long.push(format!("{name}: {summary}"));
            }
            let values = arg.get_possible_values().into_iter();
            let values = values.filter_map(|value| value.get_help().map(ToString::to_string));
            let details = arg.get_long_help().map(ToString::to_string);
            for text in values.chain(details).chain([summary]) {
                let is_for_rustdoc = text.contains("](") || text.contains("[`");
                assert!(!is_for_rustdoc, "{name}: {text}");
            }
        }
    }
    assert!(long.is_empty(), "no summaries: {long:#?}");
}

#[test]
fn paragraphs_are_wrapped_once() {
    for part in parts() {
        let text = help(&part);
        let lines: Vec<&str> = text.lines().collect();
        for pair in lines.windows(2) {
            let is_prose =
                |line: &str| line.starts_with(char::is_alphanumeric) && !line.ends_with(':');
            if !is_prose(pair[0]) || !is_prose(pair[1]) {
                continue;
            }
            let word = pair[1].split(' ').next().unwrap_or_default();
            let would_fit = pair[0].len() + 1 + word.len() <= 100;
            assert!(!would_fit, "{}: {pair:?}", part.get_name());
        }
    }
}

#[test]
fn a_topic_is_one_heading() {
    let mut headings: HashMap<String, String> = HashMap::new();
    for heading in parts().iter().flat_map(topics) {
        let known = headings.entry(topic(&heading)).or_insert(heading.clone());
        assert_eq!(*known, heading);
    }
    let commands: Vec<String> = parts().iter().map(|part| part.get_name().into()).collect();
    assert!(headings.keys().all(|topic| !commands.contains(topic)));
    assert!(headings.len() >= 8, "{headings:?}");
}

#[test]
fn flags_of_other_programs_have_a_tip_and_no_nonsense() {
    let said = |line: &str| {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        let command = all::<crate::Command>();
        let error = command.clone().try_get_matches_from(&words);
        let error = with_tip(error.expect_err("no such flag"), &command, &words);
        crate::failure::Failure::from(error).to_string()
    };
    for (line, tip) in [
        (
            "rara render a.ply --width 9",
            "tip: use --size <WxH> (Picture",
        ),
        (
            "rara render a.ply --height=9",
            "tip: use --size <WxH> (Picture",
        ),
        (
            "rara sweep a.ply --resolution 9",
            "tip: use --size <WxH> (Picture",
        ),
        (
            "rara render a.ply --near 1",
            "tip: use --clip-near <DEPTH> (Clip",
        ),
        ("rara render a.ply --near 1", "or --near-cut <DEPTH> (Leave"),
        (
            "rara render a.ply --far 1",
            "tip: use --clip-far <DEPTH> (Clip",
        ),
        (
            "rara render a.ply --fov 50",
            "tip: use --fov-y <DEG> (Vertical",
        ),
        (
            "rara convert a.ply --opacity 1",
            "tip: use --min-opacity <A> (Leave",
        ),
        (
            "rara render a.ply --bg 1,1,1",
            "tip: use --background <COLOUR>",
        ),
        (
            "rara render a.ply --out a.png",
            "tip: use --output <OUT> (A pic",
        ),
        (
            "rara render a.ply --clips x",
            "tip: a similar argument exists: '--clip",
        ),
    ] {
        let said = said(line);
        assert!(said.contains(tip), "{line}: {said}");
        assert!(!said.contains("as a value"), "{line}: {said}");
    }
    assert!(!said("rara render a.ply --opacity 1").contains("--part"));
    assert!(!said("rara render a.ply --zzz 1").contains("tip"));
}

#[test]
fn paragraphs_are_joined_and_lists_are_not() {
    let text = "Examples:\n  a\n  b\n\nOne\ntwo.\n\nThree:\n  c";
    assert_eq!(
        unwrapped(text),
        "Examples:\n  a\n  b\n\nOne two.\n\nThree:\n  c"
    );
}
