//! Measures of the whole process, in which nothing else may run: its memory, and who allocates.

use std::sync::{Mutex, MutexGuard, PoisonError};

#[path = "../common/mod.rs"]
mod common;

mod recording;
mod soak;

/// `cargo test` runs the tests of an executable side by side in one process; these take turns.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}
