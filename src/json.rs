//! The code that the readers of JSON files share.

#![forbid(unsafe_code)]

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};

/// More than any file of cameras or planes has; it keeps a wrong path (a video, a scene) from filling the memory.
const MAX_BYTES: u64 = 256 << 20;

/// Reads a JSON file's bytes. `what` names its content in the message about a file that is too large.
pub(crate) fn read(path: &Path, what: &str) -> Result<Vec<u8>> {
    let file = File::open(path).map_err(Error::io(path))?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(Error::io(path))?;
    if bytes.len() as u64 > MAX_BYTES {
        let message = format!("this is too large to be a file of {what}; give another one");
        return Err(Error::format(path, message));
    }
    Ok(bytes)
}

/// JSON without byte-order mark and leading blanks.
pub(crate) fn bare(json: &[u8]) -> &[u8] {
    json.strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(json)
        .trim_ascii_start()
}

/// A JSON error in our words; the line is what helps.
pub(crate) fn explain(error: &serde_json::Error) -> String {
    format!(
        "line {} column {}: this is not the JSON expected here ({error})",
        error.line(),
        error.column()
    )
}
