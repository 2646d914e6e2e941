//! The code that the readers of JSON files share.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result, on_a_line, shortened};

/// More than any file of cameras or planes has; it keeps a wrong path (a video, a scene) from filling the memory.
const MAX_BYTES: u64 = 256 << 20;

/// Reads a JSON file's bytes. `what` names its content in the message about a file that is too large.
pub fn read(path: &Path, what: &str) -> Result<Vec<u8>> {
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

/// The bytes of a file that is short enough to be looked at as a whole.
pub const SHORT: u64 = 16 << 20;

/// The document of a file of JSON that is short; none of others.
pub fn short_document(path: &Path) -> Option<serde_json::Value> {
    let is_short = std::fs::metadata(path).is_ok_and(|facts| facts.len() <= SHORT);
    let text = is_short.then(|| std::fs::read(path).ok()).flatten()?;
    serde_json::from_slice(bare(&text)).ok()
}

/// JSON without byte-order mark and leading blanks.
pub fn bare(json: &[u8]) -> &[u8] {
    json.strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(json)
        .trim_ascii_start()
}

/// What a document holds. The error is in our words: the line and the field are what helps.
pub fn parse<T: serde::de::DeserializeOwned>(json: &[u8]) -> std::result::Result<T, String> {
    let mut deserializer = serde_json::Deserializer::from_slice(json);
    let parsed = serde_path_to_error::deserialize(&mut deserializer);
    let parsed = parsed.map_err(|error| {
        let field = match error.path().to_string() {
            path if path == "." || path.is_empty() => String::new(),
            path => format!(", field `{}`", shortened(&path)),
        };
        explain(error.inner(), &field)
    })?;
    deserializer.end().map_err(|error| explain(&error, ""))?;
    Ok(parsed)
}

fn explain(error: &serde_json::Error, field: &str) -> String {
    // The library ends its texts with the place, which we say first.
    let (line, column) = (error.line(), error.column());
    let text = error.to_string();
    let place = format!(" at line {line} column {column}");
    let text = on_a_line(text.strip_suffix(&place).unwrap_or(&text), 240);
    let what = match error.is_data() {
        true => "this is not the JSON expected here",
        false => "this is not valid JSON",
    };
    format!("line {line} column {column}{field}: {what} ({text})")
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_field_is_named() {
        let parse = super::parse::<Vec<std::collections::BTreeMap<String, [f64; 2]>>>;
        for (json, words) in [
            (
                "[{\"fx\": [1, \"a\"]}]",
                "line 1 column 15, field `[0].fx[1]`: ",
            ),
            ("[{}, {\"fx\": 3}]", "field `[1].fx`"),
            ("[{}", "line 1 column 3"),
            (
                "[{}] x",
                "line 1 column 6: this is not valid JSON (trailing characters)",
            ),
        ] {
            let message = parse(json.as_bytes()).unwrap_err();
            assert!(message.contains(words), "{message}");
        }
    }
}
