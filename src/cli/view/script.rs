//! `--script`: one action a line, so that a viewer can be driven without a person.

use std::fs;
use std::io::{self, BufRead};
use std::path::Path;

use rara::Error;

use rara_view::viewer::{self, Action};

use crate::failure::Failure;
use crate::values::picture_path;

/// A line's actions.
type Actions = Result<Vec<Action>, Failure>;

/// The actions of a script file.
pub(super) fn read(file: &Path) -> Actions {
    let text = fs::read_to_string(file).map_err(Error::io(file))?;
    parse(&text, &file.display().to_string())
}

/// Hands over the actions of standard input as its lines come, until it ends or `take` wants no more.
pub(super) fn follow(take: &mut dyn FnMut(Result<Vec<Action>, viewer::Failure>) -> bool) {
    for (number, line) in (1..).zip(io::stdin().lock().lines()) {
        let actions = match line {
            Ok(line) => of_line(&line, "standard input", number),
            Err(error) => Err(Error::io("standard input")(error).into()),
        };
        let failed = actions.is_err();
        if !take(actions.map_err(Into::into)) || failed {
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
        return Ok(vec![action(line).map_err(wrong)?]);
    };
    let (times, of) = rest.trim().split_once(' ').unwrap_or((rest, ""));
    let times = times
        .parse()
        .ok()
        .filter(|times| (1..=MOST).contains(times));
    let times = times.ok_or_else(|| wrong(format!("repeat takes 1 to {MOST} and an action")))?;
    Ok(vec![action(of).map_err(wrong)?; times as usize])
}

/// An action, whose screenshot has a name that a picture can have.
fn action(text: &str) -> Result<Action, String> {
    let action = text.parse()?;
    if let Action::Screenshot(Some(file)) = &action {
        picture_path(file.into())?;
    }
    Ok(action)
}

#[cfg(test)]
mod tests;
