//! Assertions on results of `rara.h`.

use std::ffi::CStr;

use rara_c::boundary::*;

#[track_caller]
pub(crate) fn assert_fails(result: RaraResult, code: RaraResult, part: &str) {
    // SAFETY: a string of this thread, which is used before its next call.
    let message = unsafe { CStr::from_ptr(rara_last_error_message()) };
    let message = message.to_str().expect("UTF-8");
    assert!(!message.contains("::"), "a name of Rust's: {message}");
    assert!(
        result == code && message.contains(part),
        "{result}: {message}"
    );
}

#[track_caller]
pub(crate) fn assert_ok(result: RaraResult) {
    if result != RARA_OK {
        assert_fails(result, RARA_OK, "");
    }
}
