//! Meshes from files. A file is known by what is in it; it is read whole, and no count in it is believed before there are bytes
//! for it.

mod gltf;
mod handed;
mod obj;
mod ply;
mod stl;

use std::io::{ErrorKind, Read};
use std::path::Path;

use glam::DVec3;

use super::report::MeshReport;
use crate::failure::Failure;
use rara_base::error::{Error, Result};

/// Vertices and triangles as a file has them.
#[derive(Debug, Default)]
pub(super) struct ReadMesh {
    pub(super) vertices: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) report: MeshReport,
}

/// Reads a file.
pub(super) fn read(path: &Path) -> Result<ReadMesh> {
    let mut file = std::fs::File::open(path).map_err(Error::io(path))?;
    let length = file.metadata().map_err(Error::io(path))?.len();
    let mut bytes = Vec::new();
    let room = usize::try_from(length).is_ok_and(|length| bytes.try_reserve(length).is_ok());
    if !room {
        let error = std::io::Error::from(ErrorKind::OutOfMemory);
        return Err(Error::io(path)(error));
    }
    file.read_to_end(&mut bytes).map_err(Error::io(path))?;
    read_bytes(&bytes, path)
}

/// Reads a file that is in memory; the name stands for it in messages, and its folder has the files that a glTF may name.
pub(super) fn read_bytes(bytes: &[u8], path: &Path) -> Result<ReadMesh> {
    let has_ending = |ending: &str| {
        let own = path.extension().and_then(|own| own.to_str());
        own.is_some_and(|own| own.eq_ignore_ascii_case(ending))
    };
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let made = match bytes {
        [] => Err("the file is empty; get it again".to_owned().into()),
        _ if bytes.starts_with(b"ply") => ply::read(bytes).map_err(Failure::Format),
        _ if bytes.starts_with(b"glTF") => gltf::read(bytes, path.parent()),
        _ if stl::is_binary(bytes) => stl::read_binary(bytes).map_err(Failure::Format),
        _ if stl::is_text(text) => stl::read_text(text).map_err(Failure::Format),
        _ if text.trim_ascii_start().starts_with(b"{") => gltf::read(bytes, path.parent()),
        _ if has_ending("stl") => Err(stl::cut_off(bytes).into()),
        _ if has_ending("obj") || obj::is(text) => obj::read(text).map_err(Failure::Format),
        _ => Err(
            "this is no mesh of a format that is read; convert it to OBJ, STL, PLY or glTF"
                .to_owned()
                .into(),
        ),
    };
    made.map_err(|failure| failure.error_in(path))
}
