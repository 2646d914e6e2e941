//! The closed vocabulary of buffer accesses.

use ash::vk;

/// Everything that a pass can do with a buffer. Images stay the host's business.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// A compute shader reads a storage buffer.
    ComputeRead,
    /// A compute shader writes a storage buffer.
    ComputeWrite,
    /// A compute shader reads and writes a storage buffer, atomics included.
    ComputeReadWrite,
    /// A draw's vertex, task, mesh or fragment shader reads a storage buffer.
    DrawRead,
    /// An indirect dispatch or draw reads its arguments.
    IndirectRead,
    /// A copy reads.
    TransferRead,
    /// A copy, fill or update writes.
    TransferWrite,
    /// The host reads mapped memory after the submission's fence.
    HostRead,
}

/// The one table, in the order of the names: stages, the memory that is read there, and the memory that is written.
#[rustfmt::skip]
const TABLE: [(Access, Stages, Memory, Memory); 8] = {
    use Access::*;
    const NONE: Memory = Memory::NONE;
    [
        (ComputeRead,      Stages::COMPUTE_SHADER, Memory::SHADER_STORAGE_READ,   NONE),
        (ComputeWrite,     Stages::COMPUTE_SHADER, NONE,                          Memory::SHADER_STORAGE_WRITE),
        (ComputeReadWrite, Stages::COMPUTE_SHADER, Memory::SHADER_STORAGE_READ,   Memory::SHADER_STORAGE_WRITE),
        (DrawRead,         DRAW_STAGES,            Memory::SHADER_STORAGE_READ,   NONE),
        (IndirectRead,     Stages::DRAW_INDIRECT,  Memory::INDIRECT_COMMAND_READ, NONE),
        (TransferRead,     Stages::ALL_TRANSFER,   Memory::TRANSFER_READ,         NONE),
        (TransferWrite,    Stages::ALL_TRANSFER,   NONE,                          Memory::TRANSFER_WRITE),
        (HostRead,         Stages::HOST,           Memory::HOST_READ,             NONE),
    ]
};

/// Shader stages of a draw. The mesh stages may only be named where the device has them, and all of them only where the queue
/// draws: see [`Access::masks`].
pub(super) const DRAW_STAGES: Stages = Stages::from_raw(
    Stages::VERTEX_SHADER.as_raw() | Stages::FRAGMENT_SHADER.as_raw() | MESH_STAGES.as_raw(),
);
pub(super) const MESH_STAGES: Stages =
    Stages::from_raw(Stages::TASK_SHADER_EXT.as_raw() | Stages::MESH_SHADER_EXT.as_raw());

pub(super) type Stages = vk::PipelineStageFlags2;
pub(super) type Memory = vk::AccessFlags2;

impl Access {
    /// Every name.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.0)
    }

    /// Stages and memory accesses, where draws have these stages.
    pub fn masks(self, draw_stages: Stages) -> (Stages, Memory) {
        let (stages, reads, writes) = self.row(draw_stages);
        (stages, reads | writes)
    }

    /// True when the access writes.
    pub fn writes(self) -> bool {
        !TABLE[self as usize].3.is_empty()
    }

    /// True when the access reads.
    pub fn reads(self) -> bool {
        !TABLE[self as usize].2.is_empty()
    }

    /// The stages, the memory that they read, and the memory that they write.
    pub(super) fn row(self, draw_stages: Stages) -> (Stages, Memory, Memory) {
        let (_, stages, reads, writes) = TABLE[self as usize];
        (stages & !(DRAW_STAGES & !draw_stages), reads, writes)
    }
}

#[cfg(test)]
mod tests {
    use super::Access::*;
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_names() {
        for (row, (access, stages, reads, writes)) in TABLE.iter().enumerate() {
            assert_eq!(*access as usize, row);
            assert!(!stages.is_empty() && !(*reads | *writes).is_empty());
            assert_eq!(access.masks(DRAW_STAGES), (*stages, *reads | *writes));
            assert_eq!(
                (access.reads(), access.writes()),
                (!reads.is_empty(), !writes.is_empty())
            );
        }
    }

    #[test]
    fn draw_stages_are_named_only_where_they_exist() {
        for access in Access::all() {
            let without_mesh = access.masks(DRAW_STAGES & !MESH_STAGES).0;
            assert!(!without_mesh.intersects(MESH_STAGES) && !without_mesh.is_empty());
            let without_draws = access.masks(Stages::NONE).0;
            assert!(!without_draws.intersects(DRAW_STAGES));
            assert_eq!(without_draws.is_empty(), access == DrawRead);
        }
    }
}
