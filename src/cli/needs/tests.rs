use super::*;
use crate::program::definitions;
use clap::Arg;
use clap::error::ErrorKind;

fn commands() -> Vec<Command> {
    let mut all = definitions::<crate::Command>();
    all.build();
    all.get_subcommands().cloned().collect()
}

/// The flags of a command, those of all programs and what has no name left out.
fn flags(command: &Command) -> Vec<&Arg> {
    let flags = command
        .get_arguments()
        .filter(|flag| flag.get_long().is_some());
    flags
        .filter(|flag| !["help", "version"].contains(&flag.get_id().as_str()))
        .collect()
}

/// What was typed, however little it is.
fn typed(command: &Command, words: &[&str]) -> ArgMatches {
    let command = command.clone().ignore_errors(true).no_binary_name(true);
    command.get_matches_from(words)
}

/// A word line of this flag that its command understands.
fn typed_flag(command: &Command, flag: &Arg) -> Vec<String> {
    let name = shown(command, flag.get_id().as_str());
    if !flag.get_action().takes_values() {
        return vec![name];
    }
    let listed = flag.get_possible_values();
    let listed = listed.iter().map(|value| value.get_name().to_owned());
    let others = [
        "1",
        "0.5",
        "8",
        "0,0,1",
        "1/1",
        "sphere:0,0,0,1",
        "orbit",
        "z=0.5",
        "8x8",
        "a.png",
        "a",
        "0,0;1,0;0,1",
    ];
    let mut values = listed.chain(others.map(String::from));
    let is_understood = |value: &String| {
        let command = command.clone().no_binary_name(true);
        let typed = command.try_get_matches_from([&name, value]);
        let wrong = [ErrorKind::ValueValidation, ErrorKind::InvalidValue];
        typed
            .err()
            .is_none_or(|error| !wrong.contains(&error.kind()))
    };
    let value = values.find(is_understood);
    vec![
        name.clone(),
        value.unwrap_or_else(|| panic!("no value for {name}")),
    ]
}

#[test]
fn every_row_names_a_flag() {
    let commands = commands();
    for (flag, _) in NEEDS {
        let is_there = commands.iter().any(|command| has(command, flag));
        assert!(is_there, "no command has {flag}");
    }
}

/// The short help of such a flag begins with the mode or the raster.
#[test]
fn every_flag_whose_help_names_its_mode_or_raster_has_a_row() {
    let mut found = 0;
    for command in commands() {
        for flag in flags(&command) {
            let help = flag.get_help().map(ToString::to_string);
            let help = help.unwrap_or_default();
            let Some((case, _)) = help.split_once(": ") else {
                continue;
            };
            let need = match case.split_once(' ').unwrap_or((case, "")) {
                ("Mode", mode) => ("mode", mode),
                ("Tiles", _) => ("raster", "tiles"),
                _ => continue,
            };
            let (id, name) = (flag.get_id().as_str(), command.get_name());
            let row = NEEDS.iter().find(|(flag, _)| *flag == id);
            let is_needed = matches!(row, Some((_, Value(flag, values)))
                if *flag == need.0 && values.contains(&need.1));
            assert!(is_needed, "{name} --{id} needs --{} {}", need.0, need.1);
            found += 1;
        }
    }
    assert!(found > 10, "{found}");
}

#[test]
fn a_flag_without_what_it_needs_is_refused_or_noted_by_both_names() {
    let mut found = 0;
    for command in commands() {
        for (id, need) in NEEDS.iter().filter(|(id, _)| has(&command, id)) {
            let flag = flags(&command).into_iter().find(|flag| flag.get_id() == id);
            let words = typed_flag(&command, flag.expect("it is there"));
            let mut words: Vec<&str> = words.iter().map(String::as_str).collect();
            // What makes a value's need unmet.
            let other = match need {
                Flag(ids) | Two(ids) if !ids.iter().any(|id| has(&command, id)) => continue,
                Without(_) => continue,
                Value(id, _) | Other(id, _)
                    if !has(&command, id) || command.get_name() == "view" =>
                {
                    continue;
                }
                Flag(ids) => ids
                    .iter()
                    .find(|id| has(&command, id))
                    .expect("one")
                    .to_string(),
                Two(_) => "second shape".into(),
                Value("mode", values) => {
                    let unmet = ["hard", "exact"]
                        .into_iter()
                        .find(|value| !values.contains(value));
                    words.extend(["--mode", unmet.expect("one")]);
                    "mode".into()
                }
                Value(_, _) => {
                    words.extend(["--raster", "quad"]);
                    "raster".into()
                }
                Other(id, value) => {
                    words.extend(["--views", value]);
                    id.to_string()
                }
            };
            let typed = typed(&command, &words);
            let (what, is_note) = need
                .missing(&command, &typed)
                .unwrap_or_else(|| panic!("{words:?}"));
            let other = if has(&command, &other) {
                shown(&command, &other)
            } else {
                other
            };
            assert!(what.contains(&other), "{words:?}: {what}");
            if !is_note {
                let refused = check(&command, &typed)
                    .expect_err("it is refused")
                    .to_string();
                assert!(
                    refused.contains(words[0]) && refused.contains(&what),
                    "{refused}"
                );
            }
            found += 1;
        }
    }
    assert!(found > 40, "{found}");
}

/// Clap waives what it requires where that conflicts with something else, so that nothing is left to it.
#[test]
fn what_conflicts_with_a_need_does_not_meet_it() {
    let render = commands()
        .into_iter()
        .find(|command| command.get_name() == "render");
    let render = render.expect("it is there");
    for (words, says) in [
        (
            "--section z=0.5 --frames 9",
            "without --path or --from: give one of them,",
        ),
        (
            "--panorama --slice",
            "without --section: give it in place of --panorama,",
        ),
        (
            "--panorama --section-thickness 1",
            "without --section: give it in place of --panorama,",
        ),
        ("--panorama --outline 1,1,1", "without --section, --clip"),
        ("--frames 9", "without --path or --from: give one of them,"),
    ] {
        let words: Vec<_> = words.split(' ').collect();
        let refused = check(&render, &typed(&render, &words)).expect_err("it is refused");
        assert!(refused.to_string().contains(says), "{words:?}: {refused}");
    }
    for words in [
        "--section z=0.5 --slice",
        "--clip-op or --clip-file a",
        "--view all --part 1/2",
    ] {
        let words: Vec<_> = words.split(' ').collect();
        assert!(check(&render, &typed(&render, &words)).is_ok(), "{words:?}");
    }
}
