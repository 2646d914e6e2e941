//! What moves on a terminal while something takes longer than a moment; elsewhere there is nothing to see.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::output;

/// Bars and spinners stay hidden for the first half second, so that quick work leaves no flicker.
const MOMENT: Duration = Duration::from_millis(500);

/// A bar on the terminal for work that takes longer than a moment; none elsewhere.
pub(super) struct Progress {
    bar: ProgressBar,
    shown_at: Option<Instant>,
}

impl Progress {
    pub(super) fn new(what: impl Into<String>) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %")
            .expect("the template is valid");
        let bar =
            ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(style);
        bar.set_message(what.into());
        Self {
            bar,
            shown_at: Some(Instant::now() + MOMENT),
        }
    }

    pub(super) fn update(&mut self, done: u64, total: u64) {
        if output::is_quiet() {
            return;
        }
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

/// A sign of life beside work of unknown length.
pub(super) struct Spinner {
    /// Dropped to end it.
    alive: Option<Sender<()>>,
    shown: Option<JoinHandle<()>>,
}

impl Spinner {
    pub(super) fn new(what: &'static str) -> Self {
        if output::is_quiet() {
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
            let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})")
                .expect("the template is valid");
            let bar = ProgressBar::new_spinner().with_style(style);
            bar.set_message(what);
            while waits(Duration::from_millis(100)) {
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

impl Drop for Spinner {
    fn drop(&mut self) {
        self.alive = None;
        if let Some(shown) = self.shown.take() {
            let _ = shown.join();
        }
    }
}
