//! The log: passes records of the `log` crate to a function of the host's.

use std::cell::Cell;
use std::ffi::{c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{OnceLock, PoisonError, RwLock};

use log::{LevelFilter, Log, Metadata, Record};

use crate::boundary::{RaraResult, c_string, guard, invalid};
use crate::names::in_c;

/// How much a line of the log matters.
pub type RaraLogLevel = u32;
/// Something is wrong that no function could return.
pub const RARA_LOG_LEVEL_ERROR: RaraLogLevel = 1;
/// Something may be wrong.
pub const RARA_LOG_LEVEL_WARN: RaraLogLevel = 2;
/// Messages that a user may want to read.
pub const RARA_LOG_LEVEL_INFO: RaraLogLevel = 3;
/// Messages that a developer may want to read.
pub const RARA_LOG_LEVEL_DEBUG: RaraLogLevel = 4;
/// Every step.
pub const RARA_LOG_LEVEL_TRACE: RaraLogLevel = 5;

/// Takes a line of the log of rara and of the crates that it is built on: `text` is UTF-8, ends in NUL and is gone after
/// the call.
///
/// Any thread that is inside a function of rara's may call it, several at once. Locks may be held meanwhile, so it must
/// call nothing of rara's and throw nothing.
pub type RaraLog =
    Option<unsafe extern "C" fn(level: RaraLogLevel, text: *const c_char, user: *mut c_void)>;

/// The host's function for log records, and the pointer that it is given.
struct Host {
    log: unsafe extern "C" fn(RaraLogLevel, *const c_char, *mut c_void),
    user: *mut c_void,
}

// SAFETY: whoever calls rara_set_log promises that any thread may call the function with this pointer.
unsafe impl Send for Host {}
// SAFETY: as above, several at once.
unsafe impl Sync for Host {}

/// The level up to which the host wants lines, RARA_LOG_LEVEL_TRACE in the beginning.
static LEVEL: AtomicUsize = AtomicUsize::new(LevelFilter::Trace as usize);

/// Locked for reading while the host's function runs, so that rara_set_log returns only when nobody is in the old
/// function.
static HOST: RwLock<Option<Host>> = RwLock::new(None);

/// True when this process's records come to us; decided once.
static OURS: OnceLock<bool> = OnceLock::new();

thread_local! {
    /// True when this thread is in the host's function and has locked HOST.
    static TELLING: Cell<bool> = const { Cell::new(false) };
}

struct Sink;

impl Log for Sink {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true // the greatest level is the crate's own, log::max_level
    }

    fn log(&self, record: &Record<'_>) {
        // A record that cannot be written is lost, and its writer goes on. Dropping a payload may panic once more.
        if let Err(payload) = catch_unwind(AssertUnwindSafe(|| forward(record))) {
            std::mem::forget(payload);
        }
    }

    fn flush(&self) {}
}

fn forward(record: &Record<'_>) {
    if TELLING.get() {
        return; // the host's function has called rara, which it must not
    }
    let text = c_string(&in_c(&record.args().to_string()));
    let host = HOST.read().unwrap_or_else(PoisonError::into_inner);
    if let Some(Host { log, user }) = &*host {
        TELLING.set(true);
        // SAFETY: as rara_set_log was promised; the text outlives the call.
        unsafe { log(record.level() as RaraLogLevel, text.as_ptr(), *user) };
        TELLING.set(false);
    }
}

/// Sends the log of the whole process, up to the level of rara_set_log_level, to a function of the host's; with null, as in
/// the beginning, nobody gets it. `user` is what the function is given.
///
/// RARA_LOG_LEVEL_INFO tells of devices that were adopted and for which pipelines, of scenes, and of how splats become pixels
/// and why, where that changes. RARA_LOG_LEVEL_DEBUG tells of each pipeline that is compiled and how long that took, and of
/// each buffer: a frame that is like one before has neither. RARA_LOG_LEVEL_TRACE tells of each frame.
///
/// May be called at any time and by any thread, as long as it holds no lock that the function waits for. The previous
/// function is then not called any more, and no thread is inside it when this returns: what its `user` points to may be
/// freed. RARA_ERROR_INVALID if the function itself calls this, and where rara is linked into a Rust program that already
/// has a logger, which then gets these records.
///
/// # Safety
/// `log` is null, or is as RaraLog says and may be called with `user` by any thread until it is replaced.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_set_log(log: RaraLog, user: *mut c_void) -> RaraResult {
    guard(|| {
        if TELLING.get() {
            return invalid("rara_set_log was called by the function that takes the log");
        }
        if log.is_some() && !OURS.get_or_init(|| log::set_logger(&Sink).is_ok()) {
            return invalid(
                "this process has a logger already, which rara's records go to: rara_set_log cannot take them",
            );
        }
        // The level is changed under the lock, so that it belongs to the function that is set.
        let mut host = HOST.write().unwrap_or_else(PoisonError::into_inner);
        *host = log.map(|log| Host { log, user });
        if OURS.get() == Some(&true) {
            filter(&host);
        }
        Ok(())
    })
}

/// Sets up to which level rara_set_log's function gets lines, now and after another rara_set_log: RARA_LOG_LEVEL_WARN for
/// errors and warnings, say; in the beginning RARA_LOG_LEVEL_TRACE, for all. What nobody gets is not put together either, so
/// that a host without use for RARA_LOG_LEVEL_TRACE does not pay for it in each frame. 0 stands for none.
///
/// May be called as rara_set_log may. RARA_ERROR_INVALID for what is no level, and if the log's function itself calls this.
#[unsafe(no_mangle)]
pub extern "C" fn rara_set_log_level(most: RaraLogLevel) -> RaraResult {
    guard(|| {
        if TELLING.get() {
            return invalid("rara_set_log_level was called by the function that takes the log");
        }
        if most > RARA_LOG_LEVEL_TRACE {
            return invalid(format!("most {most} is no RaraLogLevel"));
        }
        let host = HOST.write().unwrap_or_else(PoisonError::into_inner);
        LEVEL.store(most as usize, Ordering::Relaxed);
        if OURS.get() == Some(&true) {
            filter(&host);
        }
        Ok(())
    })
}

/// Lets lines through as the host wants them.
fn filter(host: &Option<Host>) {
    let levels = LevelFilter::iter().take(1 + LEVEL.load(Ordering::Relaxed));
    let wanted = levels.last().filter(|_| host.is_some());
    log::set_max_level(wanted.unwrap_or(LevelFilter::Off));
}
