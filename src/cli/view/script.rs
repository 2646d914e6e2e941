//! `--script`: one action a line, so that a viewer can be driven without a person.

use std::fs;
use std::io::{self, BufRead};
use std::path::Path;

use rara::Error;

use super::action::Action;
use crate::failure::Failure;

/// A line's actions.
type Actions = Result<Vec<Action>, Failure>;

/// The actions of a script file.
pub(super) fn read(file: &Path) -> Actions {
    let text = fs::read_to_string(file).map_err(Error::io(file))?;
    parse(&text, &file.display().to_string())
}

/// Hands over the actions of standard input as its lines come, until it ends or `take` wants no more.
pub(super) fn follow(mut take: impl FnMut(Actions) -> bool) {
    for (number, line) in (1..).zip(io::stdin().lock().lines()) {
        let actions = match line {
            Ok(line) => of_line(&line, "standard input", number),
            Err(error) => Err(Error::io("standard input")(error).into()),
        };
        let failed = actions.is_err();
        if !take(actions) || failed {
            return;
        }
    }
}

fn parse(text: &str, name: &str) -> Actions {
    let mut actions = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        actions.extend(of_line(line, name, number)?);
    }
    Ok(actions)
}

/// The most repetitions that one line can ask for.
const MOST: u32 = 1_000_000;

/// Parses `ACTION` or `repeat N ACTION`. Text behind a # is ignored; no action contains one.
fn of_line(line: &str, name: &str, number: usize) -> Actions {
    let line = line.split('#').next().unwrap_or("").trim();
    if line.is_empty() {
        return Ok(Vec::new());
    }
    let wrong = |what: String| Failure::Usage(format!("--script: {name}, line {number}: {what}"));
    let Some(rest) = line.strip_prefix("repeat ") else {
        return Ok(vec![line.parse().map_err(wrong)?]);
    };
    let (times, action) = rest.trim().split_once(' ').unwrap_or((rest, ""));
    let times = times
        .parse()
        .ok()
        .filter(|times| (1..=MOST).contains(times));
    let times = times.ok_or_else(|| wrong(format!("repeat takes 1 to {MOST} and an action")))?;
    let action: Action = action.parse().map_err(wrong)?;
    Ok(vec![action; times as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn comments_empty_lines_and_repetitions() {
        let text = "# what this is for\n\nrepeat 3 turn 2,0 # a bit\n  quit\n";
        let turn = Action::Turn(DVec2::new(2.0, 0.0));
        assert_eq!(
            parse(text, "s").unwrap(),
            [turn.clone(), turn.clone(), turn, Action::Quit]
        );
        assert_eq!(parse("", "s").unwrap(), []);
    }

    #[test]
    fn a_wrong_line_is_named() {
        for text in [
            "quit\nleap",
            "quit\nrepeat 0 quit",
            "quit\nrepeat 2",
            "quit\nrepeat x quit",
        ] {
            let error = parse(text, "smoke.txt").expect_err(text);
            assert!(matches!(error, Failure::Usage(_)));
            let error = error.to_string();
            assert!(error.contains("smoke.txt, line 2: "), "{error}");
        }
    }
}
