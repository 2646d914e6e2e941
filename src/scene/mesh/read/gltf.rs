//! glTF, by what reads scenes of it: its triangles, each where the nodes of the document's scene have it.

use std::path::Path;

use super::ReadMesh;
use crate::failure::Failure;
use crate::formats::{Files, triangles};

/// Reads a document, or a `.glb`; the folder has the buffers that it may name.
pub(super) fn read(bytes: &[u8], folder: Option<&Path>) -> Result<ReadMesh, Failure> {
    let read = triangles(bytes, Files::of_folder(folder))?;
    let mut made = ReadMesh {
        vertices: read.vertices,
        faces: read.faces,
        ..ReadMesh::default()
    };
    made.report.notes = read.notes;
    Ok(made)
}
