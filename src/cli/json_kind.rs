//! JSON files: how they are read, and what one is, so that one of another kind than is wanted is named for what it is.

use std::path::Path;

use rara::{Error, Result};
use rara_base::json::bare;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::failure::Failure;

/// The longest list of layers that is read.
pub(super) const MOST_BYTES: u64 = 16 << 20;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum JsonKind {
    /// A list of layers, or anything else.
    Scene,
    Clips,
    Cameras,
}

impl JsonKind {
    /// What a document describes.
    pub(super) fn from_document(document: &Value) -> Self {
        let has = |value: &Value, keys: &[&str]| keys.iter().any(|key| value.get(key).is_some());
        match document {
            Value::Array(all) => match all.first() {
                Some(first) if has(first, &["position", "fx", "img_name"]) => Self::Cameras,
                _ => Self::Clips,
            },
            document if has(document, &["frames", "world_to_camera"]) => Self::Cameras,
            _ => Self::Scene,
        }
    }

    /// Returns the kind of a JSON file if it is certain; none for long files, other files and unknown kinds.
    fn of_file(path: &Path) -> Option<Self> {
        let document = document(path)?;
        let first = document.get(0);
        let is_sure = match Self::from_document(&document) {
            Self::Scene => document.get("layers").is_some(),
            Self::Clips => first
                .is_none_or(|first| first.get("clip").is_some() || first.get("normal").is_some()),
            Self::Cameras => true,
        };
        is_sure.then(|| Self::from_document(&document))
    }

    fn named(self) -> &'static str {
        match self {
            Self::Scene => "this is a list of layers; give it as the scene",
            Self::Clips => "this is a file of clips; give it by --clip-file",
            Self::Cameras => "this is a file of cameras; give it by --cameras, or one by --camera",
        }
    }

    /// The error of reading a file of this kind, which says what the file is instead if it is of another one.
    pub(super) fn wanted(self, path: &Path, error: Error) -> Failure {
        let is_read = matches!(error, Error::Format { .. });
        match Self::of_file(path).filter(|kind| is_read && *kind != self) {
            Some(other) => Error::format(path, other.named()).into(),
            None => error.into(),
        }
    }
}

/// True for files that are short enough to be looked at as a whole.
pub(super) fn is_short(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|facts| facts.len() <= MOST_BYTES)
}

pub(super) fn document(path: &Path) -> Option<Value> {
    let text = is_short(path).then(|| std::fs::read(path).ok()).flatten()?;
    serde_json::from_slice(bare(&text)).ok()
}

/// The document that the text of a file is; an error names the field.
pub(super) fn parsed<T: DeserializeOwned>(path: &Path, text: &[u8]) -> Result<T> {
    let mut json = serde_json::Deserializer::from_slice(bare(text));
    let document = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        Error::format(path, format!("field `{}`: {}", error.path(), error.inner()))
    })?;
    json.end()
        .map_err(|error| Error::format(path, error.to_string()))?;
    Ok(document)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_json_file_is_what_it_says() {
        for (text, is) in [
            (r#"[{"normal":[1,0,0],"d":0}]"#, JsonKind::Clips),
            (
                r#"[{"name":"a","clip":{"sphere":{"centre":[0,0,0],"radius":1}}}]"#,
                JsonKind::Clips,
            ),
            ("[]", JsonKind::Clips),
            (
                r#"[{"id":0,"img_name":"a","width":8,"height":8,"position":[0,0,0]}]"#,
                JsonKind::Cameras,
            ),
            (r#"{"frames":[]}"#, JsonKind::Cameras),
            (r#"{"width":8,"world_to_camera":[]}"#, JsonKind::Cameras),
            (
                r#"[{"name":"a","world_to_camera":[],"fx":1}]"#,
                JsonKind::Cameras,
            ),
            (r#"{"layers":[]}"#, JsonKind::Scene),
            ("{}", JsonKind::Scene),
            ("7", JsonKind::Scene),
        ] {
            let document = serde_json::from_str(text).expect("JSON");
            assert_eq!(JsonKind::from_document(&document), is, "{text}");
        }
    }
}
