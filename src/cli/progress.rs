//! What moves on a terminal while something takes longer than a moment; elsewhere there is nothing to see.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

static QUIET: AtomicBool = AtomicBool::new(false);

pub(super) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

pub(super) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Bars and spinners stay hidden for the first half second, so that quick work leaves no flicker.
const MOMENT: Duration = Duration::from_millis(500);

/// How often what moves moves, also where the work says nothing for long.
const TICK: Duration = Duration::from_millis(100);

/// The bars that are shown at once, a line each.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Prints something above the bars.
pub(super) fn above_bars<T>(print: impl FnOnce() -> T) -> T {
    BARS.suspend(print)
}

/// A thread that shows a bar once the work has taken a moment, and moves it from then on.
struct Sign {
    /// Dropped to end it.
    alive: Option<Sender<()>>,
    shown: Option<JoinHandle<()>>,
}

impl Sign {
    fn new(bar: ProgressBar) -> Self {
        if is_quiet() {
            return Self {
                alive: None,
                shown: None,
            };
        }
        let (alive, ended) = mpsc::channel::<()>();
        let show = move || {
            let waits = |time| ended.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
            if !waits(MOMENT) {
                return;
            }
            let bar = BARS.add(bar);
            while waits(TICK) {
                bar.tick();
            }
            bar.finish_and_clear();
        };
        Self {
            alive: Some(alive),
            // Without a thread there is no sign of life, and the work is done all the same.
            shown: thread::Builder::new().spawn(show).ok(),
        }
    }
}

impl Drop for Sign {
    fn drop(&mut self) {
        self.alive = None;
        if let Some(shown) = self.shown.take() {
            let _ = shown.join();
        }
    }
}

fn hidden(template: &str, what: String) -> ProgressBar {
    let style = ProgressStyle::with_template(template).expect("the template is valid");
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(style);
    bar.set_message(what);
    bar
}

/// A bar on the terminal for work that takes longer than a moment; none elsewhere.
pub struct ProgressLine {
    bar: ProgressBar,
    _sign: Sign,
}

impl ProgressLine {
    pub fn new(what: impl Into<String>) -> Self {
        let bar = hidden("{spinner} {msg} {wide_bar} {percent:>3} %", what.into());
        // Without a length the bar would be full.
        bar.set_length(1);
        Self {
            _sign: Sign::new(bar.clone()),
            bar,
        }
    }

    /// Says what is being done now.
    pub fn describe(&mut self, what: &str) {
        self.bar.set_message(what.to_owned());
    }

    pub fn update(&mut self, done: u64, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(done);
    }
}

/// A sign of life beside work of unknown length.
pub(super) struct Spinner {
    _sign: Sign,
}

impl Spinner {
    pub(super) fn new(what: &'static str) -> Self {
        Self {
            _sign: Sign::new(hidden("{spinner} {msg} ({elapsed})", what.into())),
        }
    }
}
