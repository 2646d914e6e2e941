//! Errors of the library as exceptions of the package, and its warnings in Python's `logging`.

use std::fmt::Display;
use std::str::FromStr;

use pyo3::prelude::*;
use rara::{Error, Result};
use serde::Serialize;

/// The exception of an error: that of its kind, with its message.
pub(crate) fn raised(error: Error) -> PyErr {
    let kind = match error {
        Error::Io { .. } => "IoError",
        Error::Format { .. } => "FormatError",
        Error::Invalid(_) => "InvalidError",
        Error::Device(_) => "DeviceError",
        Error::DeviceLost { .. } => "DeviceLostError",
        Error::Vulkan { .. } => "VulkanError",
        Error::Memory(_) => "OutOfMemoryError",
        Error::Budget(_) => "BudgetError",
        Error::Validation(_) => "ValidationError",
        _ => "Error",
    };
    Python::attach(|py| {
        let made = py
            .import("rara.errors")
            .and_then(|errors| errors.getattr(kind));
        let made = made.and_then(|kind| {
            let made = kind.call1((error.to_string(),))?;
            if let Error::Io { path, source } = &error {
                made.setattr("filename", path.as_os_str())?;
                made.setattr("errno", source.raw_os_error())?;
            }
            Ok(made)
        });
        made.map_or_else(|other| other, PyErr::from_value)
    })
}

/// An argument that is wrong.
pub(crate) fn invalid(message: impl Display) -> PyErr {
    raised(Error::Invalid(message.to_string()))
}

/// The exception of an error about an argument, after its name.
pub(crate) fn of_argument(name: &str) -> impl Fn(Error) -> PyErr {
    move |error| invalid(format!("{name}: {error}"))
}

/// The choice of a name.
pub(crate) fn choice<T: FromStr<Err = Error>>(name: &str, text: &str) -> PyResult<T> {
    text.parse().map_err(of_argument(name))
}

/// The place of what an argument calls by its name, or by its number.
pub(crate) fn called<'a>(
    names: impl ExactSizeIterator<Item = &'a str>,
    name: &Bound<'_, PyAny>,
) -> PyResult<Option<usize>> {
    let (count, name) = (names.len(), name.str()?.to_string());
    let named = names.into_iter().position(|one| one == name);
    Ok(named.or_else(|| name.parse().ok().filter(|number| *number < count)))
}

/// Refuses at once what the memory does not hold; a failed allocation later would end the process.
pub(crate) fn check_room(count: u64, bytes_each: u64, what: &str) -> Result<()> {
    let bytes = usize::try_from(count.saturating_mul(bytes_each)).unwrap_or(usize::MAX);
    let room = Vec::<u8>::new().try_reserve_exact(bytes);
    room.map_err(|_| {
        Error::Memory(format!(
            "there is no memory for {count} {what}; ask for fewer"
        ))
    })
}

/// A record as Python's own dictionaries, lists and numbers.
pub(crate) fn plain(py: Python<'_>, record: &impl Serialize) -> PyResult<Py<PyAny>> {
    let text = serde_json::to_string(record).map_err(invalid)?;
    Ok(py.import("json")?.call_method1("loads", (text,))?.unbind())
}

/// Gives the library's warnings to the logger `rara`.
struct Logger;

impl log::Log for Logger {
    fn enabled(&self, about: &log::Metadata<'_>) -> bool {
        about.level() <= log::Level::Warn && about.target().starts_with("rara")
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            // A warning that cannot be given, as while Python ends, is lost.
            let _ = Python::try_attach(|py| -> PyResult<()> {
                let logger = py.import("logging")?.call_method1("getLogger", ("rara",))?;
                logger.call_method1("warning", ("%s", record.args().to_string()))?;
                Ok(())
            });
        }
    }

    fn flush(&self) {}
}

/// Begins to give them.
pub(crate) fn tell_warnings() {
    if log::set_logger(&Logger).is_ok() {
        log::set_max_level(log::LevelFilter::Warn);
    }
}
