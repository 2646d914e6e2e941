//! Tells what a JSON file is.

use std::path::Path;

use rara_base::json::short_document;
use serde_json::Value;

/// The kind of a document.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JsonKind {
    /// A list of layers, or anything else.
    Scene,
    /// A list of clips.
    Clips,
    /// A camera, or several.
    Cameras,
}

impl JsonKind {
    /// What a document describes.
    pub fn from_document(document: &Value) -> Self {
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
    pub fn of_file(path: &Path) -> Option<Self> {
        let document = short_document(path)?;
        let first = document.get(0);
        let is_sure = match Self::from_document(&document) {
            Self::Scene => document.get("layers").is_some(),
            Self::Clips => first
                .is_some_and(|first| first.get("clip").is_some() || first.get("normal").is_some()),
            Self::Cameras => true,
        };
        is_sure.then(|| Self::from_document(&document))
    }
}

#[cfg(test)]
mod tests;
