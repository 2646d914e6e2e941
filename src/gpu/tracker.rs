//! Tracks what a recording has done to its buffers, and derives the barriers that follow from it.

use ash::vk;
use smallvec::SmallVec;

use super::Access;
use super::access::{Memory, Stages};

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
    fn as_source(self, mesh: bool) -> (Stages, Memory) {
        self.iter()
            .map(|a| a.row(mesh))
            .fold((Stages::NONE, Memory::NONE), |(s, m), row| {
                (s | row.0, m | row.2)
            })
    }
}

/// A buffer's accesses since it was last written.
#[derive(Debug, Clone, Copy)]
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
    fn of(buffer: vk::Buffer) -> Self {
        Self {
            buffer,
            writers: Set::default(),
            seen_by: Set::default(),
            readers: Set::default(),
            after_readers: Set::default(),
        }
    }
}

/// Remembers what a recording has done to its buffers and derives each pass's barrier.
///
/// A fresh tracker knows nothing of earlier work: the recording starts with [`Tracker::opening`].
#[derive(Debug)]
pub struct Tracker {
    mesh: bool,
    /// A frame has about forty; recording allocates nothing for them.
    buffers: SmallVec<[History; 64]>,
}

impl Tracker {
    /// A tracker for a device with or without mesh shaders.
    pub fn new(mesh_shader: bool) -> Self {
        Self {
            mesh: mesh_shader,
            buffers: SmallVec::new(),
        }
    }

    /// The barrier that orders a recording after everything the vocabulary can have done before it in the queue.
    pub fn opening(&self) -> vk::MemoryBarrier2<'static> {
        let everyone = Access::all().filter(|a| *a != Access::HostRead);
        let (mut stages, mut reads, mut writes) = (Stages::NONE, Memory::NONE, Memory::NONE);
        for (s, r, w) in everyone.map(|a| a.row(self.mesh)) {
            (stages, reads, writes) = (stages | s, reads | r, writes | w);
        }
        vk::MemoryBarrier2::default()
            .src_stage_mask(stages)
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
            let (stages, memory) = access.masks(self.mesh);
            if !history.writers.is_empty() && !history.seen_by.has(*access) {
                let (writer, written) = history.writers.as_source(self.mesh);
                (src, src_memory) = (src | writer, src_memory | written);
                (dst, dst_memory) = (dst | stages, dst_memory | memory);
            }
            // A write after a read only has to wait: there is nothing to make visible.
            if access.writes() && !history.readers.is_empty() && !history.after_readers.has(*access)
            {
                src |= history.readers.as_source(self.mesh).0;
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
        let mesh = self.mesh;
        // Accesses that wait for the barrier, and those among them that also see what it makes visible.
        let mut waits = Set::default();
        let mut sees = Set::default();
        for access in Access::all() {
            let (stages, memory) = access.masks(mesh);
            if dst.0.contains(stages) {
                waits = waits.with(access);
                if dst.1.contains(memory) {
                    sees = sees.with(access);
                }
            }
        }
        for history in &mut self.buffers {
            let (writers, written) = history.writers.as_source(mesh);
            if !writers.is_empty() && src.0.contains(writers) && src.1.contains(written) {
                history.seen_by.0 |= sees.0;
            }
            let readers = history.readers.as_source(mesh).0;
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
            self.buffers[at] = History::of(*buffer);
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
                self.buffers.push(History::of(buffer));
                self.buffers.len() - 1
            })
    }
}

#[cfg(test)]
mod tests {
    use super::Access::*;
    use super::*;
    use crate::gpu::access::{DRAW_STAGES, MESH_STAGES};
    use ash::vk::Handle;

    fn buffer(number: u64) -> vk::Buffer {
        vk::Buffer::from_raw(number)
    }

    /// Source stages and accesses, then those of the destination.
    fn parts(barrier: Option<vk::MemoryBarrier2<'_>>) -> Option<(Stages, Memory, Stages, Memory)> {
        barrier.map(|b| {
            (
                b.src_stage_mask,
                b.src_access_mask,
                b.dst_stage_mask,
                b.dst_access_mask,
            )
        })
    }

    #[test]
    fn the_opening_waits_for_draws_that_read_and_passes_that_wrote() {
        let opening = Tracker::new(true).opening();
        assert!(
            opening
                .src_stage_mask
                .contains(DRAW_STAGES | Stages::COMPUTE_SHADER | Stages::ALL_TRANSFER)
        );
        assert_eq!(
            opening.src_access_mask,
            Memory::SHADER_STORAGE_WRITE | Memory::TRANSFER_WRITE
        );
        assert!(
            opening
                .dst_access_mask
                .contains(opening.src_access_mask | Memory::SHADER_STORAGE_READ)
        );
    }

    #[test]
    fn first_uses_and_reads_after_reads_need_nothing() {
        let mut tracker = Tracker::new(true);
        assert!(
            tracker
                .pass(&[(buffer(1), ComputeRead), (buffer(2), ComputeWrite)])
                .is_none()
        );
        assert!(
            tracker
                .pass(&[(buffer(1), ComputeRead), (buffer(1), DrawRead)])
                .is_none()
        );
    }

    #[test]
    fn read_after_write() {
        let mut tracker = Tracker::new(true);
        tracker.pass(&[(buffer(1), TransferWrite)]);
        let expected = (
            Stages::ALL_TRANSFER,
            Memory::TRANSFER_WRITE,
            Stages::COMPUTE_SHADER,
            Memory::SHADER_STORAGE_READ,
        );
        assert_eq!(
            parts(tracker.pass(&[(buffer(1), ComputeRead)])),
            Some(expected)
        );
        assert!(
            tracker.pass(&[(buffer(1), ComputeRead)]).is_none(),
            "the write is visible by now"
        );
    }

    #[test]
    fn each_kind_of_reader_waits_once() {
        let mut tracker = Tracker::new(false);
        tracker.pass(&[(buffer(1), ComputeWrite)]);
        assert!(tracker.pass(&[(buffer(1), ComputeRead)]).is_some());
        let draw =
            parts(tracker.pass(&[(buffer(1), DrawRead), (buffer(1), IndirectRead)])).unwrap();
        assert_eq!(draw.0, Stages::COMPUTE_SHADER);
        assert_eq!(
            draw.2,
            Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER | Stages::DRAW_INDIRECT
        );
        assert_eq!(
            draw.3,
            Memory::SHADER_STORAGE_READ | Memory::INDIRECT_COMMAND_READ
        );
        assert!(
            tracker
                .pass(&[(buffer(1), DrawRead), (buffer(1), ComputeRead)])
                .is_none()
        );
    }

    #[test]
    fn write_after_read_waits_without_memory() {
        let mut tracker = Tracker::new(true);
        tracker.pass(&[(buffer(1), TransferRead)]);
        let expected = (
            Stages::ALL_TRANSFER,
            Memory::NONE,
            Stages::COMPUTE_SHADER,
            Memory::NONE,
        );
        assert_eq!(
            parts(tracker.pass(&[(buffer(1), ComputeWrite)])),
            Some(expected)
        );
    }

    #[test]
    fn write_after_write() {
        let mut tracker = Tracker::new(true);
        tracker.pass(&[(buffer(1), ComputeReadWrite)]);
        let again = parts(tracker.pass(&[(buffer(1), ComputeReadWrite)])).unwrap();
        assert_eq!(again.1, Memory::SHADER_STORAGE_WRITE);
        assert_eq!(
            again.3,
            Memory::SHADER_STORAGE_READ | Memory::SHADER_STORAGE_WRITE
        );
        assert!(
            tracker.pass(&[(buffer(1), ComputeReadWrite)]).is_some(),
            "each pass writes anew"
        );
    }

    #[test]
    fn one_barrier_serves_all_buffers() {
        let mut tracker = Tracker::new(true);
        tracker.pass(&[(buffer(1), ComputeWrite), (buffer(2), ComputeWrite)]);
        assert!(tracker.pass(&[(buffer(1), ComputeRead)]).is_some());
        assert!(tracker.pass(&[(buffer(2), ComputeRead)]).is_none());
    }

    #[test]
    fn a_barrier_for_reads_does_not_make_writes_visible() {
        let mut tracker = Tracker::new(true);
        tracker.pass(&[(buffer(1), ComputeRead), (buffer(2), ComputeWrite)]);
        // Same stages, but the wait for buffer 1's reader carries no memory.
        assert!(tracker.pass(&[(buffer(1), ComputeWrite)]).is_some());
        assert!(tracker.pass(&[(buffer(2), ComputeRead)]).is_some());
    }

    #[test]
    fn a_buffer_read_and_written_by_one_pass_keeps_both() {
        let mut tracker = Tracker::new(true);
        assert!(
            tracker
                .pass(&[(buffer(1), ComputeWrite), (buffer(1), IndirectRead)])
                .is_none()
        );
        let next = parts(tracker.pass(&[(buffer(1), TransferWrite)])).unwrap();
        assert_eq!(next.0, Stages::COMPUTE_SHADER | Stages::DRAW_INDIRECT);
        assert_eq!(next.1, Memory::SHADER_STORAGE_WRITE);
    }

    #[test]
    fn a_reader_after_the_barrier_is_waited_for_again() {
        let mut tracker = Tracker::new(true);
        tracker.pass(&[(buffer(1), ComputeRead), (buffer(2), ComputeRead)]);
        assert!(tracker.pass(&[(buffer(1), ComputeWrite)]).is_some());
        assert!(tracker.pass(&[(buffer(2), ComputeRead)]).is_none());
        assert!(tracker.pass(&[(buffer(2), ComputeWrite)]).is_some());
    }

    #[test]
    fn a_barrier_never_names_mesh_stages_where_there_are_none() {
        let mut tracker = Tracker::new(false);
        assert!(!tracker.opening().dst_stage_mask.intersects(MESH_STAGES));
        tracker.pass(&[(buffer(1), ComputeWrite)]);
        let barrier = tracker.pass(&[(buffer(1), DrawRead)]).unwrap();
        assert!(!barrier.dst_stage_mask.intersects(MESH_STAGES));
    }

    /// One access of a pass, and one barrier, by the pass that it stands before.
    type Use = (usize, vk::Buffer, Access);
    type Barriers = Vec<Option<vk::MemoryBarrier2<'static>>>;

    /// Whether two uses must not run in any order.
    fn conflict(a: &Use, b: &Use) -> bool {
        a.0 < b.0 && a.1 == b.1 && (a.2.writes() || b.2.writes())
    }

    /// The oracle, straight from the specification: one barrier between two uses covers both, or each covers a use
    /// between them.
    fn ordered(a: &Use, b: &Use, uses: &[Use], barriers: &Barriers) -> bool {
        let ((from, _, written), (to, seen)) = (a.2.row(true), b.2.masks(true));
        let direct = barriers[a.0 + 1..=b.0].iter().flatten().any(|barrier| {
            barrier.src_stage_mask.contains(from)
                && barrier.src_access_mask.contains(written)
                && barrier.dst_stage_mask.contains(to)
                && (!a.2.writes() || barrier.dst_access_mask.contains(seen))
        });
        direct
            || uses.iter().any(|c| {
                (conflict(a, c) && conflict(c, b))
                    && ordered(a, c, uses, barriers)
                    && ordered(c, b, uses, barriers)
            })
    }

    fn unordered(uses: &[Use], barriers: &Barriers) -> usize {
        let pairs = uses.iter().flat_map(|a| uses.iter().map(move |b| (a, b)));
        pairs
            .filter(|(a, b)| conflict(a, b) && !ordered(a, b, uses, barriers))
            .count()
    }

    proptest::proptest! {
        /// Every hazard of a random recording is covered, and no barrier on a single buffer could be left out. (On
        /// several, one buffer's barrier may happen to order another's uses too, which the tracker does not look for.)
        #[test]
        fn barriers_are_enough_and_needed(
            buffers in 1_u64..4,
            passes in proptest::collection::vec(
                proptest::collection::vec((0_u64..12, 0_usize..9), 1..4), 1..7)
        ) {
            let names: Vec<Access> = Access::all().collect();
            let mut tracker = Tracker::new(true);
            let mut uses: Vec<Use> = Vec::new();
            let mut barriers = Barriers::new();
            for (at, pass) in passes.iter().enumerate() {
                let pass: Vec<_> = pass.iter().map(|(b, a)| (buffer(1 + b % buffers), names[*a])).collect();
                barriers.push(tracker.pass(&pass));
                uses.extend(pass.iter().map(|(buffer, access)| (at, *buffer, *access)));
            }
            proptest::prop_assert_eq!(unordered(&uses, &barriers), 0);
            for at in (0..barriers.len()).filter(|_| buffers == 1) {
                let mut fewer = barriers.clone();
                if fewer[at].take().is_some() {
                    proptest::prop_assert!(unordered(&uses, &fewer) > 0, "barrier {} is idle", at);
                }
            }
        }
    }
}
