//! Texts that cross the boundary.

use std::ffi::{CStr, c_char};
use std::path::PathBuf;

use rara::Result;

use crate::boundary::{invalid, shared};

/// The part of a text that fits, in whole characters, and a NUL.
pub(crate) fn fixed<const N: usize>(from: &str) -> [c_char; N] {
    let mut to = [0; N];
    let most = from.len().min(N - 1);
    let end = (0..=most).rev().find(|&end| from.is_char_boundary(end));
    for (to, from) in to.iter_mut().zip(from[..end.unwrap_or(0)].bytes()) {
        *to = from as c_char;
    }
    to
}

/// A string's bytes, without the NUL at its end.
///
/// # Safety
/// `text` is null, or a string that ends in NUL and that nobody changes for `'a`.
unsafe fn string<'a>(text: *const c_char, name: &str) -> Result<&'a CStr> {
    shared(text, name)?;
    Ok(CStr::from_ptr(text))
}

/// A string in UTF-8.
pub(crate) unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str> {
    match string(text, name)?.to_str() {
        Ok(text) => Ok(text),
        Err(_) => invalid(format!("{name} is not UTF-8: give it in UTF-8")),
    }
}

/// A file's name: UTF-8, or on Unix any bytes.
pub(crate) unsafe fn path(text: *const c_char, name: &str) -> Result<PathBuf> {
    path_of(string(text, name)?)
}

#[cfg(unix)]
fn path_of(path: &CStr) -> Result<PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    Ok(std::ffi::OsStr::from_bytes(path.to_bytes()).into())
}

#[cfg(not(unix))]
fn path_of(path: &CStr) -> Result<PathBuf> {
    match path.to_str() {
        Ok(path) => Ok(path.into()),
        Err(_) => invalid("the path is not UTF-8"),
    }
}
