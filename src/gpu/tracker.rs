//! Tracks what a recording has done to its buffers, and derives the barriers that follow from it.

use ash::vk;
use smallvec::SmallVec;

use super::access::{Access, DRAW_STAGES, MESH_STAGES, Memory, Stages};

/// A set of [`Access`] names, one bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Set(u16);

impl Set {
    fn with(self, access: Access) -> Self {
        Self(self.0 | 1 << access as u16)
    }

    fn has(self, access: Access) -> bool {
        self.0 & (1 << access as u16) != 0
    }

    fn is_empty(self) -> bool {
        self.0 == 0
    }

    fn iter(self) -> impl Iterator<Item = Access> {
        Access::all().filter(move |access| self.has(*access))
    }

    /// The stages of all members, and the memory that they write.
    fn as_source(self, draw_stages: Stages) -> (Stages, Memory) {
        self.iter()
            .map(|a| a.row(draw_stages))
            .fold((Stages::NONE, Memory::NONE), |(s, m), row| {
                (s | row.0, m | row.2)
            })
    }
}

/// A buffer's accesses since it was last written.
#[derive(Debug, Clone, Copy, Default)]
struct History {
    buffer: vk::Buffer,
    /// The accesses that wrote it last (several only when one pass wrote it in several ways).
    writers: Set,
    /// Accesses that already see that write.
    seen_by: Set,
    /// The accesses that read it since.
    readers: Set,
    /// Accesses that already wait for those reads.
    after_readers: Set,
}

impl History {
    fn new(buffer: vk::Buffer) -> Self {
        Self {
            buffer,
            ..Self::default()
        }
    }
}

/// The draws that the barriers of a recording are between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Draws {
    /// Those before the recording in its queue, and those after it.
    Around,
    /// Those after it: the host has waited for the ones before.
    After,
    /// None: they are in another queue, and the host's semaphores order them. No barrier names their stages, which that of the
    /// recording may lack.
    Elsewhere,
}

/// Remembers what a recording has done to its buffers and derives each pass's barrier.
///
/// A fresh tracker knows nothing of earlier work: the recording starts with [`Tracker::opening`].
#[derive(Debug)]
pub struct Tracker {
    draws: Draws,
    /// The shader stages of draws that barriers may name.
    draw_stages: Stages,
    /// A frame has about forty; recording allocates nothing for them.
    buffers: SmallVec<[History; 64]>,
}

impl Tracker {
    /// A tracker for a device with or without mesh shaders.
    pub fn new(mesh_shader: bool, draws: Draws) -> Self {
        Self {
            draws,
            draw_stages: match (draws, mesh_shader) {
                (Draws::Elsewhere, _) => Stages::NONE,
                (_, true) => DRAW_STAGES,
                (_, false) => DRAW_STAGES & !MESH_STAGES,
            },
            buffers: SmallVec::new(),
        }
    }

    /// The draws that the barriers are between.
    pub fn draws(&self) -> Draws {
        self.draws
    }

    /// The barrier that orders a recording after what the vocabulary can have done before it in the queue, but for draws that
    /// the host has waited for.
    pub fn opening(&self) -> vk::MemoryBarrier2<'static> {
        let everyone = Access::all().filter(|a| *a != Access::HostRead);
        let (mut stages, mut reads, mut writes) = (Stages::NONE, Memory::NONE, Memory::NONE);
        for (s, r, w) in everyone.map(|a| a.row(self.draw_stages)) {
            (stages, reads, writes) = (stages | s, reads | r, writes | w);
        }
        let awaited = match self.draws {
            Draws::Around | Draws::Elsewhere => Stages::NONE,
            Draws::After => DRAW_STAGES,
        };
        vk::MemoryBarrier2::default()
            .src_stage_mask(stages & !awaited)
            .src_access_mask(writes)
            .dst_stage_mask(stages)
            .dst_access_mask(reads | writes)
    }

    /// Notes a pass and returns the barrier it must wait for: one for all of its buffers, or none.
    ///
    /// The barrier covers each read after a write, write after a write and write after a read that no earlier barrier
    /// covers already. A buffer may stand in the list more than once.
    pub fn pass(&mut self, uses: &[(vk::Buffer, Access)]) -> Option<vk::MemoryBarrier2<'static>> {
        let (mut src, mut src_memory) = (Stages::NONE, Memory::NONE);
        let (mut dst, mut dst_memory) = (Stages::NONE, Memory::NONE);
        for (buffer, access) in uses {
            let at = self.index(*buffer);
            let history = self.buffers[at];
            let (stages, memory) = access.masks(self.draw_stages);
            if !history.writers.is_empty() && !history.seen_by.has(*access) {
                let (writer, written) = history.writers.as_source(self.draw_stages);
                (src, src_memory) = (src | writer, src_memory | written);
                (dst, dst_memory) = (dst | stages, dst_memory | memory);
            }
            // A write after a read only has to wait: there is nothing to make visible.
            if access.writes() && !history.readers.is_empty() && !history.after_readers.has(*access)
            {
                src |= history.readers.as_source(self.draw_stages).0;
                dst |= stages;
            }
        }
        let barrier = (!src.is_empty()).then(|| {
            self.note_barrier((src, src_memory), (dst, dst_memory));
            vk::MemoryBarrier2::default()
                .src_stage_mask(src)
                .src_access_mask(src_memory)
                .dst_stage_mask(dst)
                .dst_access_mask(dst_memory)
        });
        self.note_uses(uses);
        barrier
    }

    /// A global barrier covers every buffer, not only those of the pass that needed it.
    fn note_barrier(&mut self, src: (Stages, Memory), dst: (Stages, Memory)) {
        let draw_stages = self.draw_stages;
        // Accesses that wait for the barrier, and those among them that also see what it makes visible.
        let mut waits = Set::default();
        let mut sees = Set::default();
        for access in Access::all() {
            let (stages, memory) = access.masks(draw_stages);
            if dst.0.contains(stages) {
                waits = waits.with(access);
                if dst.1.contains(memory) {
                    sees = sees.with(access);
                }
            }
        }
        for history in &mut self.buffers {
            let (writers, written) = history.writers.as_source(draw_stages);
            if !writers.is_empty() && src.0.contains(writers) && src.1.contains(written) {
                history.seen_by.0 |= sees.0;
            }
            let readers = history.readers.as_source(draw_stages).0;
            if !readers.is_empty() && src.0.contains(readers) {
                history.after_readers.0 |= waits.0;
            }
        }
    }

    /// A write starts a buffer's history anew; a read is added to it. Writes go first, so that what the same pass reads
    /// beside them is kept.
    fn note_uses(&mut self, uses: &[(vk::Buffer, Access)]) {
        for (buffer, _) in uses.iter().filter(|(_, access)| access.writes()) {
            let at = self.index(*buffer);
            self.buffers[at] = History::new(*buffer);
        }
        for (buffer, access) in uses {
            let at = self.index(*buffer);
            let history = &mut self.buffers[at];
            if access.writes() {
                history.writers = history.writers.with(*access);
            } else {
                history.readers = history.readers.with(*access);
                history.after_readers = Set::default();
            }
        }
    }

    /// The place of the buffer's history; a new one begins empty.
    fn index(&mut self, buffer: vk::Buffer) -> usize {
        self.buffers
            .iter()
            .position(|h| h.buffer == buffer)
            .unwrap_or_else(|| {
                self.buffers.push(History::new(buffer));
                self.buffers.len() - 1
            })
    }
}

#[cfg(test)]
mod tests;
