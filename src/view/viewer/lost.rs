//! A window that is lost while it is open: its X server ends, or closes the connection.
//!
//! Many calls of winit then panic, as they unwrap results that fail only in this case; this module turns the panic into a
//! failure. Where winit looks for events first, as it does when the window was at rest, Xlib notices: its handler prints
//! a line of its own and ends the process, with exit status 1 as well. winit sets no other handler, and setting one would
//! take unsafe calls of Xlib.

use std::panic::{self, AssertUnwindSafe, Location};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rara::Error;

use super::failure::Failure;

/// Runs `work`; `None` if winit panicked. All other panics go on.
pub(super) fn unless_lost<T>(work: impl FnOnce() -> T) -> Option<T> {
    let lost = Arc::new(AtomicBool::new(false));
    let hook = Arc::new(panic::take_hook());
    panic::set_hook(Box::new({
        let (lost, hook) = (lost.clone(), hook.clone());
        move |info| {
            if info.location().is_some_and(is_in_winit) {
                lost.store(true, Ordering::Relaxed);
            } else {
                hook(info);
            }
        }
    }));
    let done = panic::catch_unwind(AssertUnwindSafe(work));
    panic::set_hook(Box::new(move |info| hook(info)));
    match done {
        Ok(done) => Some(done),
        Err(_) if lost.load(Ordering::Relaxed) => None,
        Err(fault) => panic::resume_unwind(fault),
    }
}

pub(super) fn failure() -> Failure {
    let message = "the window was lost: the connection to its display (the X server) ended; start the program again";
    Error::Device(message.into()).into()
}

fn is_in_winit(location: &Location) -> bool {
    let mut folders = location.file().split(['/', '\\']);
    folders.any(|folder| folder == "winit" || folder.starts_with("winit-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_winit_may_panic_unheard() {
        assert_eq!(unless_lost(|| 7), Some(7));
        let hook = panic::take_hook();
        panic::set_hook(Box::new(|_| ()));
        let fault = panic::catch_unwind(|| unless_lost(|| -> u8 { panic!("a fault of rara") }));
        panic::set_hook(hook);
        let fault = fault.expect_err("it goes on");
        assert_eq!(fault.downcast_ref(), Some(&"a fault of rara"));
    }
}
