//! Calls every function with null for every pointer, and with a panic inside: both become a code.

use std::cell::Cell;
use std::ptr::{null, null_mut};

use rara::ash::vk;

use crate::arrays::*;
use crate::bake::*;
use crate::boundary::*;
use crate::camera::*;
use crate::camera_files::*;
use crate::channels::*;
use crate::clip::*;
use crate::cut::*;
use crate::depth::*;
use crate::device::*;
use crate::editor::*;
use crate::frame::*;
use crate::gaussians::*;
use crate::layer::*;
use crate::layer_info::*;
use crate::layers::*;
use crate::load::*;
use crate::logging::*;
use crate::matrices::*;
use crate::picker::*;
use crate::placement::*;
use crate::renderer::*;
use crate::renderer_desc::*;
use crate::reserve::*;
use crate::scene::*;
use crate::selection::*;
use crate::settings::*;
use crate::shots::*;
use crate::staging::*;
use crate::stats::*;
use crate::support::*;
use crate::tests::{assert_fails, message};
use crate::upload::*;

thread_local! {
    static PANIC: Cell<bool> = const { Cell::new(false) };
}

/// Panics when a test asks every function to.
pub(crate) fn panic_if_asked() {
    assert!(!PANIC.get(), "injected");
}

/// The outcome of a call with null for every pointer and handle: its result, its name, and the names of its pointers.
type Called = (RaraResult, &'static str, &'static [&'static str]);

include!(concat!(env!("OUT_DIR"), "/lists.rs"));

/// Calls each function; `seen` sees what each has given, while its message is there.
fn call_all(seen: impl Fn(Called)) {
    macro_rules! call {
        ($($function:ident($($argument:expr),*) [$($name:literal),*],)*) => {
            // SAFETY: every function must stand null.
            unsafe { $(seen(($function($($argument),*), stringify!($function), &[$($name),*]));)* }
        };
    }
    results!(call);
}

fn assert_is_nothing<T: Default + PartialEq + std::fmt::Debug>(value: T) {
    assert_eq!(value, T::default());
}

/// Functions without a result neither fail nor report anything.
fn assert_nothing_comes_of_null() {
    macro_rules! call {
        ($($function:ident($($argument:expr),*) [$($name:literal),*],)*) => {
            // SAFETY: every function must stand null.
            unsafe { $(assert_is_nothing($function($($argument),*));)* }
        };
    }
    others!(call);
}

#[test]
fn null_is_named() {
    call_all(|(result, function, names)| {
        // Nobody listens to the log then, and 1 is a level.
        if function.starts_with("rara_set_log") {
            return assert_eq!(result, RARA_OK, "{function}");
        }
        let says = message();
        let is_named = |name: &&str| says.contains(&format!("{name} is null"));
        let is_right = names.iter().any(is_named);
        assert!(
            result == RARA_ERROR_INVALID && is_right && !says.contains("::"),
            "{function}: {result}, {says}"
        );
    });
    assert_fails(
        rara_set_log_level(6),
        RARA_ERROR_INVALID,
        "6 is no RaraLogLevel",
    );
    assert_nothing_comes_of_null();
}

#[test]
fn no_panic_crosses() {
    PANIC.set(true);
    call_all(|(result, function, _)| {
        assert_eq!(result, RARA_ERROR_PANIC, "{function}");
        assert_eq!(message(), "injected");
    });
    assert_nothing_comes_of_null();
    PANIC.set(false);
    let odd = guard(|| std::panic::panic_any(7));
    assert_fails(odd, RARA_ERROR_PANIC, "without a message");
}
