//! Other SPIR-V in the place of shaders' own, by which the laboratory compares variants of a shader.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::shader::{Bindings, Shader};

/// The folder that is looked into.
static FOLDER: Mutex<Option<PathBuf>> = Mutex::new(None);

/// From now on pipelines take their modules from a folder, where it has them, named as in `glsl/spirv`. They must declare the same
/// buffers, parameters and constants as those that they replace.
pub fn replace_modules(folder: Option<&Path>) {
    let mut place = FOLDER.lock().unwrap_or_else(PoisonError::into_inner);
    *place = folder.map(Path::to_path_buf);
}

/// The words of a shader's module in that folder.
pub(super) fn replaced(shader: &Shader, bindings: Bindings) -> Option<Vec<u32>> {
    let place = FOLDER.lock().unwrap_or_else(PoisonError::into_inner);
    let way = match bindings {
        Bindings::Address => "address",
        Bindings::Bound => "bound",
        Bindings::Mixed => "mixed",
    };
    let bytes = std::fs::read(place.as_ref()?.join(format!("{}.{way}.spv", shader.file))).ok()?;
    let words = bytes.as_chunks().0.iter();
    Some(words.map(|word| u32::from_le_bytes(*word)).collect())
}
