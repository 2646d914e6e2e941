//! Output of the program: lines for people on stderr, the table or JSON document that was asked for on stdout, and files.

use std::fmt::Display;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError, RwLock, RwLockReadGuard};

use rara::{Error, OnCompile, Picture, PngCompression, Result};
use serde::Serialize;

use super::progress;
pub(super) use super::progress::{ProgressLine, Spinner, be_quiet, is_quiet};
pub(super) use rara_base::counted::grouped;

/// The name of standard input and standard output in place of a file.
pub(super) const STANDARD: &str = "-";

static PROGRAM: OnceLock<&str> = OnceLock::new();

/// Says which program this is, before anything else is said.
pub(super) fn begin(program: &'static str) {
    let _ = PROGRAM.set(program);
}

/// The program's name.
pub(super) fn program() -> &'static str {
    PROGRAM.get().copied().unwrap_or("rara")
}

/// Prints a line for people, unless they want none.
pub fn say(line: impl Display) {
    if !is_quiet() {
        complain(line);
    }
}

/// Prints a line for people unless the one before it was the same, as of each of many pictures.
pub(super) fn warn_once(line: String) {
    static LAST: Mutex<String> = Mutex::new(String::new());
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if *last != line {
        say(&line);
        *last = line;
    }
}

/// Lines that wait for the end of the work.
static AFTERWARDS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Prints a line for people once the work is done; it is no use where that fails.
pub(super) fn say_afterwards(line: String) {
    let mut lines = AFTERWARDS.lock().unwrap_or_else(PoisonError::into_inner);
    if !lines.contains(&line) {
        lines.push(line);
    }
}

/// The work is done.
pub(super) fn end() {
    let mut lines = AFTERWARDS.lock().unwrap_or_else(PoisonError::into_inner);
    lines.drain(..).for_each(say);
}

/// Prints why something failed. Where nobody listens (stderr closed), nothing is lost by going on.
pub(super) fn complain(line: impl Display) {
    let _ = progress::above_bars(|| writeln!(io::stderr(), "{line}"));
}

/// Tells people what the library warns of.
pub(super) fn tell_warnings() {
    struct Notes;
    impl log::Log for Notes {
        fn enabled(&self, about: &log::Metadata<'_>) -> bool {
            about.level() == log::Level::Warn && about.target().starts_with("rara")
        }

        fn log(&self, record: &log::Record<'_>) {
            if self.enabled(record.metadata()) {
                warn_once(format!("note: {}", record.args()));
            }
        }

        fn flush(&self) {}
    }
    // Nothing else in this program sets a logger.
    if log::set_logger(&Notes).is_ok() {
        log::set_max_level(log::LevelFilter::Warn);
    }
}

/// A sign of life while shaders are compiled, however many parts of the program say so at once.
pub(super) struct Compiling(());

/// How many parts say so, and the sign.
static COMPILING: Mutex<(usize, Option<Spinner>)> = Mutex::new((0, None));

impl Compiling {
    pub(super) fn begin() -> Self {
        let mut shown = COMPILING.lock().unwrap_or_else(PoisonError::into_inner);
        shown.0 += 1;
        shown
            .1
            .get_or_insert_with(|| Spinner::new("compiling shaders"));
        Self(())
    }

    /// The function that a device calls when it compiles.
    pub(super) fn hook() -> OnCompile {
        let shown = Mutex::new(None);
        OnCompile::new(move |is_begun| {
            *shown.lock().unwrap_or_else(PoisonError::into_inner) = is_begun.then(Self::begin);
        })
    }
}

impl Drop for Compiling {
    fn drop(&mut self) {
        let mut shown = COMPILING.lock().unwrap_or_else(PoisonError::into_inner);
        shown.0 -= 1;
        if shown.0 == 0 {
            shown.1 = None;
        }
    }
}

/// The line about the driver's shaders; none where compiling them has hardly taken a moment. An earlier run may have `kept`
/// them.
pub(super) fn compiled(first_use_ms: f64, kept: bool) -> Option<String> {
    let seconds = first_use_ms / 1e3;
    let first = if kept {
        ""
    } else {
        ", first time on this driver"
    };
    (seconds >= 0.25).then(|| format!("compiling shaders{first}: {seconds:.1} s"))
}

/// Prints the document that `--json` promises.
pub fn json(document: &impl Serialize) -> Result<()> {
    answer(&serde_json::to_string_pretty(document).expect("the documents have string keys only"))
}

/// Prints a document of one line; false where nobody reads it.
pub(super) fn json_line(document: &impl Serialize) -> Result<bool> {
    let line = serde_json::to_string(document).expect("the documents have string keys only");
    bytes(format!("{line}\n").as_bytes())
}

/// Prints what a command was asked for, with a line break behind.
pub fn answer(text: &str) -> Result<()> {
    bytes(format!("{}\n", text.trim_end()).as_bytes()).map(drop)
}

/// Each picture holds this from before it gets its name until its line is printed.
static UNSETTLED: RwLock<()> = RwLock::new(());

static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// Keeps this process from being told to end until what is returned goes.
pub(super) fn unsettled() -> RwLockReadGuard<'static, ()> {
    while IS_ENDING.load(Ordering::Relaxed) {
        std::thread::park(); // for ever: nothing is begun any more
    }
    UNSETTLED.read().unwrap_or_else(PoisonError::into_inner)
}

/// Waits until every picture that has its name has its line too, and lets no other get one: for a process that is told to
/// end. It does not wait long, as for a reader that does not read.
#[cfg(unix)]
pub(super) fn settle() {
    use std::sync::TryLockError;
    use std::thread::sleep;
    use std::time::{Duration, Instant};
    const PATIENCE: Duration = Duration::from_secs(2);
    IS_ENDING.store(true, Ordering::Relaxed);
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        match UNSETTLED.try_write() {
            Err(TryLockError::WouldBlock) => sleep(Duration::from_millis(1)),
            settled => return std::mem::forget(settled),
        }
    }
}

/// Writes a picture to a file, or to standard output as PNG.
pub(super) fn picture(picture: &Picture, file: &Path, compression: PngCompression) -> Result<()> {
    let png = || picture.to_png_with(compression);
    match (file == Path::new(STANDARD), ends_in(file, "png")) {
        (true, _) => bytes(&png()?).map(drop),
        (_, true) => {
            let png = png()?;
            rara_base::files::write_atomically(file, |out| out.write_all(&png))
        }
        _ => picture.save(file),
    }
}

/// Writes to standard output; false where a reader has stopped reading, which is no failure.
fn bytes(bytes: &[u8]) -> Result<bool> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Error::io("stdout")(error)),
    }
}

/// Makes the folders of `file` unless they are there, and fails early, and in plain words, where it could not be written.
pub(super) fn check_file(file: &Path) -> Result<()> {
    if file == Path::new(STANDARD) {
        return Ok(());
    }
    if file.is_dir() {
        return Err(Error::format(file, "this is a folder; name a file in it"));
    }
    match file.parent() {
        Some(folder) if folder != Path::new("") => make_folder(folder),
        _ => check_folder(Path::new(".")),
    }
}

/// True where two paths lead to one file that is there.
pub(super) fn is_same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// Writes a text file beside `file` and renames it into place, so that nobody sees half of one.
pub fn text(file: &Path, text: &str) -> Result<()> {
    rara_base::files::write_atomically(file, |out| out.write_all(text.as_bytes()))
}

/// Makes `folder` and those it is in unless they are there, and fails where files could not be written into it.
pub fn make_folder(folder: &Path) -> Result<()> {
    // A file among the folders is the most likely mistake, and systems say different things of it.
    if let Some(file) = folder.ancestors().find(|part| part.is_file()) {
        return Err(Error::format(file, "this is not a folder"));
    }
    fs::create_dir_all(folder).map_err(Error::io(folder))?;
    check_folder(folder)
}

fn check_folder(folder: &Path) -> Result<()> {
    /// Several threads may ask at once.
    static NEXT: AtomicU64 = AtomicU64::new(0);
    loop {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let probe = folder.join(format!(".rara-{}-{number}.probe", std::process::id()));
        match fs::File::options()
            .write(true)
            .create_new(true)
            .open(&probe)
        {
            // A process of the same number, in another container or on another machine, may have such a file here.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(Error::io(folder)(error)),
            Ok(_) => return fs::remove_file(&probe).map_err(Error::io(probe)),
        }
    }
}

/// So many of what is called `one`: "1 picture", "1 234 pictures".
pub fn counted(number: u64, one: &str) -> String {
    rara_base::counted::counted(grouped(number), one)
}

/// The same with a verb: "1 picture is", "1 234 pictures are".
pub(super) fn counted_are(number: u64, one: &str) -> String {
    let verb = if number == 1 { "is" } else { "are" };
    format!("{} {verb}", counted(number, one))
}

/// True for a file whose name has this ending, in whatever case.
pub(super) fn ends_in(file: &Path, ending: &str) -> bool {
    file.extension()
        .is_some_and(|it| it.eq_ignore_ascii_case(ending))
}

#[cfg(test)]
mod tests;
