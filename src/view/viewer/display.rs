//! The connection to the display.

use std::panic::{self, AssertUnwindSafe};

use rara::Error;
use winit::event_loop::EventLoop;

use super::failure::Failure;
use super::stage::AppEvent;

/// A connection to the display, on which a viewer opens its window.
pub struct Connection(pub(super) EventLoop<AppEvent>);

impl Connection {
    /// Connects to the display. Do so before anything slow, as there may be none.
    ///
    /// # Errors
    /// [`Device`](rara::Error::Device) where there is no display, or what windows need is missing.
    pub fn open() -> Result<Self, Failure> {
        let remedy = "start the program in a desktop session (DISPLAY names an X server or XWayland), install libx11-6, \
                  libx11-xcb1, libxcursor1, libxi6 and libxkbcommon-x11-0 where one of them is missing, or draw \
                  without a window (rara render)";
        // winit panics where a library is missing, and its message would go to the terminal.
        let hook = panic::take_hook();
        panic::set_hook(Box::new(|_| ()));
        let made = panic::catch_unwind(AssertUnwindSafe(|| EventLoop::with_user_event().build()));
        panic::set_hook(hook);
        match made {
            Ok(Ok(events)) => Ok(Self(events)),
            Ok(Err(error)) => {
                let display = std::env::var("DISPLAY").unwrap_or_default();
                let reason = if cfg!(target_os = "linux") && display.is_empty() {
                    "DISPLAY is not set".to_owned()
                } else {
                    without_place(&error.to_string()).to_owned()
                };
                Err(Error::Device(format!("no window can be opened: {reason}; {remedy}")).into())
            }
            Err(_) => Err(Error::Device(format!(
                "no window can be opened: a library for windows is missing; {remedy}"
            ))
            .into()),
        }
    }
}

/// Removes the place in winit's sources with which winit begins its messages.
pub(super) fn without_place(message: &str) -> &str {
    let place = message.split_once(".rs:");
    let reason = place.and_then(|(_, rest)| rest.split_once(": "));
    reason.map_or(message, |(_, reason)| reason)
}
