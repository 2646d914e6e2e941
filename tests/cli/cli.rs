//! The `rara` command as people and scripts use it: texts, exit statuses, documents. Nothing here is timed.

#[path = "../common/folder.rs"]
mod folder;

mod aov;
mod bake;
mod batch;
mod cameras;
mod clips;
mod compare;
mod convert;
mod determinism;
mod films;
mod outputs;
mod panoramas;
mod paper;
mod paths;
mod plurals;
mod process;
mod profile;
mod refusals;
mod sections;
mod selections;
mod shape;
mod streams;
mod surprises;
mod timing;
mod trained;
mod work;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use folder::Folder;
use serde_json::Value;

/// Runs `rara` with these arguments.
fn rara<A: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = A>) -> Output {
    rara_with(arguments, None)
}

/// The same with a variable set in its environment.
fn rara_with<A: AsRef<std::ffi::OsStr>>(
    arguments: impl IntoIterator<Item = A>,
    variable: Option<(&str, &str)>,
) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
    command
        .args(arguments)
        // The tests must not use the user's own cache.
        .env("RARA_CACHE", "")
        .envs(variable)
        .output()
        .expect("the rara binary runs")
}

/// Runs `rara` with a line's words; `@` stands for `folder`. Commands that draw do so on `RARA_TEST_DEVICE` if that is
/// set.
fn line(folder: &Path, words: &str) -> Output {
    line_with(folder, words, None)
}

/// The same with a variable set in its environment.
fn line_with(folder: &Path, words: &str, variable: Option<(&str, &str)>) -> Output {
    let folder = folder.to_str().expect("the test folder's name is text");
    let mut words: Vec<String> = words
        .split_whitespace()
        .map(|word| word.replace('@', folder))
        .collect();
    let draws = [
        "render", "sweep", "ablate", "demo", "bench", "bake", "paper", "study",
    ]
    .contains(&words[0].as_str());
    if let Ok(device) = std::env::var("RARA_TEST_DEVICE")
        && draws
        && !words.iter().any(|word| word == "--device")
    {
        words.extend(["--device".into(), device]);
    }
    rara_with(words, variable)
}

fn folder(test: &str) -> Folder {
    Folder::new(&format!("cli-{test}"))
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("messages are UTF-8")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("documents are UTF-8")
}

/// Asserts success; the message has the command's stderr.
fn done(output: Output) -> Output {
    assert!(
        output.status.success(),
        "{:?}: {}",
        output.status,
        stderr(&output)
    );
    output
}

/// The one JSON document on stdout.
fn document(output: Output) -> Value {
    let output = done(output);
    serde_json::from_str(&stdout(&output)).expect("stdout is one JSON document and nothing else")
}

/// Asserts a failure with this status, nothing on stdout, and one line that says `what`.
#[track_caller]
fn refused(output: &Output, status: i32, what: &str) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(status), "{message}");
    assert!(output.stdout.is_empty());
    assert!(message.starts_with("rara: "), "{message}");
    assert!(message.contains(what), "'{what}' is not in: {message}");
    assert_eq!(message.trim_end().lines().count(), 1, "one line: {message}");
    assert!(!message.contains("panicked"), "{message}");
}

/// A small scene in `folder`.
fn scene(folder: &Path) -> PathBuf {
    done(line(
        folder,
        "generate general -n 2000 --seed 3 -o @/scene.ply",
    ));
    folder.join("scene.ply")
}
