//! Output of the program: lines for people on stderr, the table or JSON document that was asked for on stdout, pictures, and a
//! progress bar.

use std::fmt::Display;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rara::{Error, Result};
use serde::Serialize;

/// Prints a line for people. Where nobody listens (stderr closed), nothing is lost by going on.
pub(super) fn say(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Prints the document that `--json` promises.
pub(super) fn json(document: &impl Serialize) -> Result<()> {
    answer(&serde_json::to_string_pretty(document).expect("the documents have string keys only"))
}

/// Prints what a command was asked for, with a line break behind. A reader that stops reading is no failure.
pub(super) fn answer(text: &str) -> Result<()> {
    let text = format!("{}\n", text.trim_end());
    let mut stdout = io::stdout().lock();
    match stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
    {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::io("stdout")(error)),
        _ => Ok(()),
    }
}

/// Fails early, and in plain words, where `file` could not be written.
pub(super) fn check_file(file: &Path) -> Result<()> {
    if file.is_dir() {
        return Err(Error::format(file, "this is a folder; name a file in it"));
    }
    match file.parent() {
        Some(folder) if folder != Path::new("") => check_folder(folder),
        _ => check_folder(Path::new(".")),
    }
}

/// Writes a text file beside `file` and renames it into place, so that nobody sees half of one.
pub(super) fn text(file: &Path, text: &str) -> Result<()> {
    rara::files::write_atomically(file, |out| out.write_all(text.as_bytes()))
}

/// Makes `folder` unless it is there, and fails where files could not be written into it.
pub(super) fn make_folder(folder: &Path) -> Result<()> {
    if !folder.exists() {
        fs::create_dir(folder).map_err(Error::io(folder))?;
    }
    check_folder(folder)
}

fn check_folder(folder: &Path) -> Result<()> {
    if !folder.is_dir() {
        let problem = if folder.exists() {
            "this is not a folder"
        } else {
            "this folder does not exist; make it first"
        };
        return Err(Error::format(folder, problem));
    }
    let probe = folder.join(format!(".rara-{}.probe", std::process::id()));
    fs::File::create(&probe).map_err(Error::io(folder))?;
    fs::remove_file(&probe).map_err(Error::io(probe))
}

/// A bar on the terminal for work that takes longer than a moment; none elsewhere.
pub(super) struct Progress {
    bar: ProgressBar,
    shown_at: Option<Instant>,
}

impl Progress {
    /// The bar stays hidden for the first half second, so that quick work leaves no flicker.
    const MOMENT: Duration = Duration::from_millis(500);

    pub(super) fn new(what: impl Into<String>) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %")
            .expect("the template is valid");
        let bar =
            ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(style);
        bar.set_message(what.into());
        Self {
            bar,
            shown_at: Some(Instant::now() + Self::MOMENT),
        }
    }

    pub(super) fn update(&mut self, done: u64, total: u64) {
        if self.shown_at.is_some_and(|at| Instant::now() >= at) {
            self.shown_at = None;
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_length(total);
        self.bar.set_position(done);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// 1234567 as "1 234 567".
pub(super) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn digits_stand_in_groups_of_three() {
        let shown = [0, 999, 1000, 1_234_567].map(grouped);
        assert_eq!(shown, ["0", "999", "1 000", "1 234 567"]);
    }
}
