//! Other SPIR-V in the place of shaders' own, by which the laboratory compares variants of a shader.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use ash::util::read_spv;

use super::shader::{Bindings, Shader};
use rara_base::error::{Error, Result};

/// The folder that is looked into.
static FOLDER: Mutex<Option<PathBuf>> = Mutex::new(None);

/// From now on pipelines take their modules from a folder, where it has them, named as in `glsl/spirv`. They must declare the same
/// buffers, parameters and constants as those that they replace.
pub fn replace_modules(folder: Option<&Path>) {
    let mut place = FOLDER.lock().unwrap_or_else(PoisonError::into_inner);
    *place = folder.map(Path::to_path_buf);
}

/// The words of a shader's module in that folder.
pub(super) fn replaced(shader: &Shader, bindings: Bindings) -> Result<Option<Vec<u32>>> {
    let way = match bindings {
        Bindings::Address => "address",
        Bindings::Bound => "bound",
        Bindings::Mixed => "mixed",
    };
    let place = FOLDER.lock().unwrap_or_else(PoisonError::into_inner);
    let file = |folder: &PathBuf| folder.join(format!("{}.{way}.spv", shader.file));
    let Some(file) = place.as_ref().map(file).filter(|file| file.exists()) else {
        return Ok(None);
    };
    let mut opened = std::fs::File::open(&file).map_err(Error::io(&file))?;
    read_spv(&mut opened).map(Some).map_err(Error::io(file))
}
