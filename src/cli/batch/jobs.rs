//! Jobs: commands as JSON, by the names of their flags, and many of them as one with `for` and `zip`.

use std::ffi::OsString;
use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;

use clap::parser::ValueSource;
use clap::{ArgMatches, Command};
use rara::Error;
use serde_json::{Map, Value};

use super::super::failure::Failure;
use super::super::output::{self, STANDARD};

/// Jobs of one file at most, so that a slip of a finger in a range does not fill the memory.
const MOST: usize = 1_000_000;

/// The flags that a run of many commands has itself.
const REFUSED: [&str; 6] = [
    "quiet",
    "json",
    "json-lines",
    "part",
    "skip-existing",
    "save-job",
];

#[derive(Debug, Clone)]
pub(super) struct Job {
    /// Messages call it by its file and its number there.
    pub(super) name: String,
    pub(super) words: Vec<OsString>,
}

pub(super) fn read(path: &Path) -> Result<Vec<Job>, Failure> {
    let mut text = String::new();
    match path == Path::new(STANDARD) {
        true => std::io::stdin().read_to_string(&mut text).map(drop),
        false => fs::read_to_string(path).map(|read| text = read),
    }
    .map_err(Error::io(path))?;
    let mut jobs = Vec::new();
    for value in serde_json::Deserializer::from_str(&text).into_iter::<Value>() {
        let value = value.map_err(|error| {
            let expected = "jobs are a list in JSON, or one job a line";
            Error::format(path, format!("{error}: {expected}"))
        })?;
        collect(value, &Map::new(), path, &mut jobs)?;
    }
    Ok(jobs)
}

/// Adds the jobs that a value is or lists; what `common` says holds for each unless it says otherwise.
fn collect(
    value: Value,
    common: &Map<String, Value>,
    path: &Path,
    jobs: &mut Vec<Job>,
) -> Result<(), Failure> {
    let wrong = |number: usize, why: String| {
        let message = format!("job {number}: {why}");
        Failure::from(Error::format(path, message))
    };
    match value {
        Value::Array(all) => all
            .into_iter()
            .try_for_each(|one| collect(one, common, path, jobs)),
        Value::Object(mut job) => {
            for (key, value) in common {
                job.entry(key).or_insert_with(|| value.clone());
            }
            if let Some(all) = job.remove("jobs") {
                return collect(all, &job, path, jobs);
            }
            for filled in templates(job).map_err(|why| wrong(jobs.len() + 1, why))? {
                let number = jobs.len() + 1;
                if number > MOST {
                    return Err(wrong(number, format!("a file has at most {MOST} jobs")));
                }
                jobs.push(Job {
                    name: format!("{}, job {number}", path.display()),
                    words: words(&filled).map_err(|why| wrong(number, why))?,
                });
            }
            Ok(())
        }
        other => Err(wrong(
            jobs.len() + 1,
            format!(
                "{other} is not a job, which is an object: {{\"scene\": \"a.ply\", \"output\": \"a.png\"}}"
            ),
        )),
    }
}

/// The values of names, for one job.
type Set<'a> = Vec<(&'a str, Value)>;

/// The jobs that a job with `for` and `zip` stands for: each value of each name of `for`, the last name the fastest, and faster
/// the values of `zip`, whose names change together.
fn templates(mut job: Map<String, Value>) -> Result<Vec<Map<String, Value>>, String> {
    let [names, together] = ["for", "zip"].map(|key| match job.remove(key) {
        None => Ok(Map::new()),
        Some(Value::Object(names)) => Ok(names),
        Some(other) => Err(format!(
            "\"{key}\" is an object of names and values, and not {other}"
        )),
    });
    let (names, together) = (names?, together?);
    if let Some(name) = together.keys().find(|name| names.contains_key(*name)) {
        return Err(format!("{name} is a name in \"for\" and in \"zip\""));
    }
    let mut all = vec![Vec::new()];
    for (name, values) in &names {
        let values = series(values).map_err(|why| format!("\"for\", {name}: {why}"))?;
        let values = values.into_iter().map(|value| vec![(&name[..], value)]);
        all = product(&all, &values.collect::<Vec<_>>())?;
    }
    if !together.is_empty() {
        all = product(&all, &zipped(&together)?)?;
    }
    let filled = |set: Set<'_>| {
        let value = substituted(&Value::Object(job.clone()), &set)?;
        match value {
            Value::Object(job) => Ok(job),
            _ => unreachable!("an object stays one"),
        }
    };
    all.into_iter().map(filled).collect()
}

/// Each of some sets with each of others, the others the faster.
fn product<'a>(all: &[Set<'a>], with: &[Set<'a>]) -> Result<Vec<Set<'a>>, String> {
    if all.len().saturating_mul(with.len()) > MOST {
        return Err(format!("\"for\" and \"zip\" make more than {MOST} jobs"));
    }
    let pairs = all
        .iter()
        .flat_map(|one| with.iter().map(move |other| (one, other)));
    Ok(pairs
        .map(|(one, other)| [&one[..], other].concat())
        .collect())
}

/// The sets of names that change together.
fn zipped(names: &Map<String, Value>) -> Result<Vec<Set<'_>>, String> {
    let mut all: Option<(&str, Vec<Set<'_>>)> = None;
    for (name, values) in names {
        let values = series(values).map_err(|why| format!("\"zip\", {name}: {why}"))?;
        let (first, sets) = all.get_or_insert_with(|| (name, vec![Vec::new(); values.len()]));
        if sets.len() != values.len() {
            return Err(format!(
                "\"zip\" changes its names together, and {first} has {} and {name} {}: give both as many values",
                output::counted(sets.len() as u64, "value"),
                values.len()
            ));
        }
        for (set, value) in sets.iter_mut().zip(values) {
            set.push((name, value));
        }
    }
    Ok(all.map_or(Vec::new(), |(_, sets)| sets))
}

/// The values of a list, of `0..9` (whole numbers, both ends included) or of `0..1:11` (so many numbers in equal steps).
fn series(values: &Value) -> Result<Vec<Value>, String> {
    let text = match values {
        Value::Array(all) => return Ok(all.clone()),
        Value::String(text) => text,
        other => return Err(format!("{other} is neither a list nor a range")),
    };
    let expected = || format!("'{text}' is not a range, as 0..9 or 0..1:11");
    let (from, rest) = text.split_once("..").ok_or_else(expected)?;
    let Some((to, count)) = rest.split_once(':') else {
        let (from, to) = (from.trim().parse::<i64>(), rest.trim().parse::<i64>());
        let (Ok(from), Ok(to)) = (from, to) else {
            return Err(expected());
        };
        if from.abs_diff(to) >= MOST as u64 {
            return Err(format!("'{text}' is more than {MOST} values"));
        }
        let up = (from.min(to)..=from.max(to)).map(Value::from);
        return Ok(match from <= to {
            true => up.collect(),
            false => up.rev().collect(),
        });
    };
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
    let count = count
        .trim()
        .parse::<usize>()
        .ok()
        .filter(|count| *count > 0);
    let (Some(from), Some(to), Some(count)) = (number(from), number(to), count) else {
        return Err(expected());
    };
    if count > MOST {
        return Err(format!("'{text}' is more than {MOST} values"));
    }
    let at = |index: usize| match count {
        1 => from,
        _ => from + (to - from) * index as f64 / (count - 1) as f64,
    };
    // Twelve digits, so that 0..1:11 has 0.3 and not 0.30000000000000004.
    let rounded = |value: f64| format!("{value:.12}").parse::<f64>().unwrap_or(value);
    Ok((0..count).map(|index| rounded(at(index)).into()).collect())
}

/// A value in whose texts `${name}` is replaced, and `${name:04}` by a number with zeros before it.
fn substituted(value: &Value, set: &[(&str, Value)]) -> Result<Value, String> {
    Ok(match value {
        Value::String(text) => Value::String(filled(text, set)?),
        Value::Array(all) => {
            let all = all.iter().map(|one| substituted(one, set));
            Value::Array(all.collect::<Result<_, _>>()?)
        }
        Value::Object(all) => {
            let all = all
                .iter()
                .map(|(key, value)| Ok((key.clone(), substituted(value, set)?)));
            Value::Object(all.collect::<Result<_, String>>()?)
        }
        other => other.clone(),
    })
}

fn filled(text: &str, set: &[(&str, Value)]) -> Result<String, String> {
    let mut made = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("${") {
        let (name, after) = after
            .split_once('}')
            .ok_or_else(|| format!("'{text}' has ${{ and no }}"))?;
        let (name, digits) = match name.split_once(":0") {
            Some((name, digits)) => (name, digits.parse::<usize>().ok().filter(|d| *d < 20)),
            None => (name, Some(0)),
        };
        let value = set
            .iter()
            .find(|(of, _)| *of == name)
            .map(|(_, value)| value);
        let (Some(value), Some(digits)) = (value, digits) else {
            let names: Vec<_> = set.iter().map(|(name, _)| *name).collect();
            return Err(format!(
                "'{text}' asks for '{name}', and \"for\" and \"zip\" have {}",
                names.join(", ")
            ));
        };
        made += before;
        made += &match value {
            Value::String(value) => format!("{value:0>digits$}"),
            number => format!("{:0>digits$}", number.to_string()),
        };
        rest = after;
    }
    Ok(made + rest)
}

/// The command line that a job is.
fn words(job: &Map<String, Value>) -> Result<Vec<OsString>, String> {
    let command = match job.get("command") {
        None => "render",
        Some(Value::String(command)) if command == "render" || command == "sweep" => command,
        Some(other) => {
            return Err(format!(
                "the command {other} is neither \"render\" nor \"sweep\""
            ));
        }
    };
    let mut words: Vec<OsString> = vec!["rara".into(), command.into()];
    let mut scenes = Vec::new();
    for (key, value) in job {
        let flag = key.replace('_', "-");
        match (key.as_str(), value) {
            ("command", _) => {}
            _ if REFUSED.contains(&flag.as_str()) => {
                return Err(format!(
                    "\"{key}\" cannot be a part of a job: rara batch has its own"
                ));
            }
            ("scene", value) => scenes = texts(key, value)?,
            (_, Value::Bool(true)) => words.push(format!("--{flag}").into()),
            (_, Value::Bool(false) | Value::Null) => {}
            (_, value) => {
                let given = texts(key, value)?;
                words.extend(given.iter().map(|text| format!("--{flag}={text}").into()));
            }
        }
    }
    if scenes.is_empty() {
        return Err("\"scene\" is missing: a file, or a list of files that are its layers".into());
    }
    words.push("--".into());
    words.extend(scenes.into_iter().map(OsString::from));
    Ok(words)
}

/// Returns what is typed behind a flag, once for each time.
fn texts(key: &str, value: &Value) -> Result<Vec<String>, String> {
    match value {
        Value::String(text) => Ok(vec![text.clone()]),
        Value::Number(number) => Ok(vec![number.to_string()]),
        Value::Array(all) => {
            let all = all.iter().map(|one| texts(key, one));
            Ok(all.collect::<Result<Vec<_>, _>>()?.concat())
        }
        other => Err(format!(
            "\"{key}\" is a text, a number or a list of these, and not {other}"
        )),
    }
}

/// Adds the job that a command line means to a file, as a line.
pub(in super::super) fn save(
    file: &Path,
    command: &Command,
    typed: &ArgMatches,
) -> Result<(), Failure> {
    output::check_file(file)?;
    let line = format!("{}\n", of_command_line(command, typed));
    let opened = fs::File::options().create(true).append(true).open(file);
    let written = opened.and_then(|mut opened| opened.write_all(line.as_bytes()));
    Ok(written.map_err(Error::io(file))?)
}

fn of_command_line(command: &Command, typed: &ArgMatches) -> Value {
    let mut job = Map::new();
    job.insert("command".into(), command.get_name().into());
    for arg in command.get_arguments() {
        let id = arg.get_id().as_str();
        let is_typed = typed.value_source(id) == Some(ValueSource::CommandLine);
        if !is_typed || ["save_job", "quiet"].contains(&id) {
            continue;
        }
        let key = arg.get_long().unwrap_or("scene").to_owned();
        let raw = typed.get_raw(id).into_iter().flatten();
        let mut values: Vec<Value> = raw.map(|raw| raw.to_string_lossy().into()).collect();
        let value = match (arg.get_action().takes_values(), values.len()) {
            (false, _) => true.into(),
            (true, 1) => values.remove(0),
            (true, _) => values.into(),
        };
        job.insert(key, value);
    }
    job.into()
}

#[cfg(test)]
mod tests;
