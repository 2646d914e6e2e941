//! The meshes of a cut, as they lie in device memory one behind the other.

use rara_scene::mesh::Mesh;

/// The bytes of a quad, the unit in which shaders count where a mesh begins.
const QUAD: u64 = 16;

/// The meshes of a cut, each of which is there once.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    /// Each with its first quad.
    list: Vec<(u64, Mesh)>,
    quads: u64,
}

impl Meshes {
    /// The first quad of a mesh, which is added if it is not there.
    pub(super) fn place(&mut self, mesh: &Mesh) -> u64 {
        if let Some((first, _)) = self.list.iter().find(|(_, other)| other == mesh) {
            return *first;
        }
        let first = self.quads;
        self.quads += mesh.packed().quads.len() as u64;
        self.list.push((first, mesh.clone()));
        first
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// How many quads all take.
    pub(crate) fn quads(&self) -> u64 {
        self.quads
    }

    /// How many bytes all take.
    pub(crate) fn bytes(&self) -> u64 {
        QUAD * self.quads
    }

    /// The quads of each, and the byte at which they begin.
    pub(crate) fn placed(&self) -> impl Iterator<Item = (u64, &[[u32; 4]])> {
        let list = self.list.iter();
        list.map(|(first, mesh)| (QUAD * first, mesh.packed().quads.as_slice()))
    }
}
