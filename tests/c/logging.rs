//! `rara_set_log`: the log's records reach the host's function, on any thread, until it is replaced.

use std::ffi::{CStr, c_char, c_void};
use std::ptr::null_mut;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread;

use rara_c::boundary::*;
use rara_c::logging::*;

use crate::folder::has_run_alone;

pub(crate) type Lines = Mutex<Vec<(RaraLogLevel, String)>>;

/// # Safety
/// `user` points to `Lines`.
pub(crate) unsafe extern "C" fn keep(level: RaraLogLevel, text: *const c_char, user: *mut c_void) {
    // SAFETY: the caller's promise, and the text ends in NUL.
    let (lines, text) = unsafe { (&*user.cast::<Lines>(), CStr::from_ptr(text)) };
    let text = text.to_str().expect("UTF-8").to_owned();
    lines.lock().expect("no panic").push((level, text));
}

unsafe extern "C" fn misbehave(_: RaraLogLevel, _: *const c_char, user: *mut c_void) {
    // SAFETY: what the test gave.
    let refused = unsafe { &*user.cast::<AtomicU32>() };
    log::error!("a line about a line"); // this line is dropped
    // SAFETY: null stands for nobody.
    let result = unsafe { rara_set_log(None, null_mut()) };
    refused.fetch_add((result == RARA_ERROR_INVALID) as u32, Ordering::Relaxed);
}

struct Unwritable;

impl std::fmt::Display for Unwritable {
    fn fmt(&self, _: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        panic!("a value that cannot be written")
    }
}

#[test]
fn records_reach_the_host() {
    // A process has one log.
    if has_run_alone(records_reach_the_host) {
        return;
    }
    let (mut first, mut second) = (Lines::default(), Lines::default());
    fn address(lines: &mut Lines) -> *mut c_void {
        (&raw mut *lines).cast()
    }
    let taken = |lines: &Lines| std::mem::take(&mut *lines.lock().expect("no panic"));
    log::error!("nobody hears this");
    // SAFETY: the functions take what they are given, which outlives the last call.
    unsafe {
        assert_eq!(rara_set_log(None, null_mut()), RARA_OK);
        assert_eq!(rara_set_log(Some(keep), address(&mut first)), RARA_OK);
        log::error!("one, with a NUL\0");
        log::warn!("two: {}", 2);
        log::trace!("ä");
        log::error!("{Unwritable}");
        let line = |level, text: &str| (level, text.to_owned());
        let expected = [
            line(RARA_LOG_LEVEL_ERROR, "one, with a NUL\u{fffd}"),
            line(RARA_LOG_LEVEL_WARN, "two: 2"),
            line(RARA_LOG_LEVEL_TRACE, "ä"),
        ];
        assert_eq!(taken(&first), expected);

        // The function has been replaced.
        assert_eq!(rara_set_log(Some(keep), address(&mut second)), RARA_OK);
        log::info!("three");
        log::debug!("four");
        let expected = [
            line(RARA_LOG_LEVEL_INFO, "three"),
            line(RARA_LOG_LEVEL_DEBUG, "four"),
        ];
        assert_eq!((taken(&first).len(), taken(&second)), (0, expected.into()));

        // What is beyond the level is not even put together.
        assert_eq!(rara_set_log_level(RARA_LOG_LEVEL_WARN), RARA_OK);
        log::warn!("five");
        log::info!("{Unwritable}");
        assert!(!log::log_enabled!(log::Level::Info));
        assert_eq!(taken(&second), [line(RARA_LOG_LEVEL_WARN, "five")]);
        assert_eq!(rara_set_log(Some(keep), address(&mut first)), RARA_OK);
        log::info!("six");
        log::error!("seven");
        assert_eq!(taken(&first), [line(RARA_LOG_LEVEL_ERROR, "seven")]);
        assert_eq!(rara_set_log_level(0), RARA_OK);
        log::error!("eight");
        assert_eq!(taken(&first).len(), 0);
        assert_eq!(rara_set_log_level(6), RARA_ERROR_INVALID);
        assert_eq!(rara_set_log_level(RARA_LOG_LEVEL_TRACE), RARA_OK);

        let mut refused = AtomicU32::new(0);
        let user = (&raw mut refused).cast();
        assert_eq!(rara_set_log(Some(misbehave), user), RARA_OK);
        log::error!("heard once");
        assert_eq!(refused.load(Ordering::Relaxed), 1);

        assert_eq!(rara_set_log(None, null_mut()), RARA_OK);
        log::error!("nobody hears this either");
        assert_eq!(taken(&first).len() + taken(&second).len(), 0);
    }
}

static INSIDE: AtomicU32 = AtomicU32::new(0);

unsafe extern "C" fn linger(_: RaraLogLevel, _: *const c_char, user: *mut c_void) {
    // SAFETY: what the test gave.
    let alive = unsafe { &*user.cast::<AtomicBool>() };
    INSIDE.fetch_add(1, Ordering::Relaxed);
    for _ in 0..20 {
        thread::yield_now();
        assert!(alive.load(Ordering::Relaxed), "freed while in use");
    }
}

/// Threads log while the function is set and unset: the `user` that it was given is not used afterwards.
#[test]
fn what_the_function_is_given_may_be_freed_once_it_is_replaced() {
    if has_run_alone(what_the_function_is_given_may_be_freed_once_it_is_replaced) {
        return;
    }
    let done = AtomicBool::new(false);
    thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    log::warn!("again");
                }
            });
        }
        for round in 0.. {
            let alive = AtomicBool::new(true);
            let user = (&raw const alive).cast_mut().cast();
            // SAFETY: it lives until the log is unset.
            unsafe { assert_eq!(rara_set_log(Some(linger), user), RARA_OK) };
            thread::yield_now();
            // SAFETY: null stands for nobody.
            unsafe { assert_eq!(rara_set_log(None, null_mut()), RARA_OK) };
            alive.store(false, Ordering::Relaxed);
            if round >= 200 && INSIDE.load(Ordering::Relaxed) > 200 {
                break;
            }
        }
        done.store(true, Ordering::Relaxed);
    });
}
