//! The `rara` command as people and scripts use it: texts, exit statuses, documents. Nothing here is timed.

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

use crate::folder::Folder;
use crate::output::{document, done, plurals, refused, stderr, stdout};

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
    let draws = ["render", "sweep", "demo", "bake"].contains(&words[0].as_str());
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

/// A small scene in `folder`.
fn scene(folder: &Path) -> PathBuf {
    done(line(
        folder,
        "generate general -n 2000 --seed 3 -o @/scene.ply",
    ));
    folder.join("scene.ply")
}
