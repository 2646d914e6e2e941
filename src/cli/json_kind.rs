//! The errors of reading files of JSON that are of another kind than is wanted.

use std::path::Path;

use super::failure::Failure;
use rara::Error;
pub(super) use rara_scene::json_kind::JsonKind;

fn named(kind: JsonKind) -> &'static str {
    match kind {
        JsonKind::Scene => "this is a list of layers; give it as the scene",
        JsonKind::Clips => "this is a file of clips; give it by --clip-file",
        JsonKind::Cameras => "this is a file of cameras; give it by --cameras, or one by --camera",
    }
}

/// The error of reading a file of this kind, which says what the file is instead if it is of another one.
pub(super) fn wanted(kind: JsonKind, path: &Path, error: Error) -> Failure {
    let is_read = matches!(error, Error::Format { .. });
    match JsonKind::of_file(path).filter(|other| is_read && *other != kind) {
        Some(other) => Error::format(path, named(other)).into(),
        None => error.into(),
    }
}
