//! Every hazard has a barrier, and no barrier is too many.

use super::Access::*;
use super::*;
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
    let opening = Tracker::new(true, Draws::Around).opening();
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
fn the_opening_waits_for_no_draw_that_has_been_waited_for() {
    let [around, after] =
        [Draws::Around, Draws::After].map(|draws| Tracker::new(true, draws).opening());
    assert_eq!(after.src_stage_mask, around.src_stage_mask & !DRAW_STAGES);
    assert_eq!(after.src_access_mask, around.src_access_mask);
    // Draws see the writes of copies and edits without a barrier of their own.
    assert_eq!(after.dst_stage_mask, around.dst_stage_mask);
    assert_eq!(after.dst_access_mask, around.dst_access_mask);
}

#[test]
fn no_barrier_is_between_draws_in_another_queue() {
    let mut tracker = Tracker::new(true, Draws::Elsewhere);
    let opening = tracker.opening();
    let stages = opening.src_stage_mask | opening.dst_stage_mask;
    assert!(!stages.intersects(DRAW_STAGES));
    assert!(stages.contains(Stages::COMPUTE_SHADER | Stages::DRAW_INDIRECT | Stages::ALL_TRANSFER));
    tracker.pass(&[(buffer(1), ComputeWrite)]);
    let barrier = tracker.pass(&[(buffer(1), IndirectRead)]).unwrap();
    assert_eq!(barrier.dst_stage_mask, Stages::DRAW_INDIRECT);
}

#[test]
fn first_uses_and_reads_after_reads_need_nothing() {
    let mut tracker = Tracker::new(true, Draws::Around);
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
    let mut tracker = Tracker::new(true, Draws::Around);
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
    let mut tracker = Tracker::new(false, Draws::Around);
    tracker.pass(&[(buffer(1), ComputeWrite)]);
    assert!(tracker.pass(&[(buffer(1), ComputeRead)]).is_some());
    let draw = parts(tracker.pass(&[(buffer(1), DrawRead), (buffer(1), IndirectRead)])).unwrap();
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
    let mut tracker = Tracker::new(true, Draws::Around);
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
    let mut tracker = Tracker::new(true, Draws::Around);
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
    let mut tracker = Tracker::new(true, Draws::Around);
    tracker.pass(&[(buffer(1), ComputeWrite), (buffer(2), ComputeWrite)]);
    assert!(tracker.pass(&[(buffer(1), ComputeRead)]).is_some());
    assert!(tracker.pass(&[(buffer(2), ComputeRead)]).is_none());
}

#[test]
fn a_barrier_for_reads_does_not_make_writes_visible() {
    let mut tracker = Tracker::new(true, Draws::Around);
    tracker.pass(&[(buffer(1), ComputeRead), (buffer(2), ComputeWrite)]);
    // Same stages, but the wait for buffer 1's reader carries no memory.
    assert!(tracker.pass(&[(buffer(1), ComputeWrite)]).is_some());
    assert!(tracker.pass(&[(buffer(2), ComputeRead)]).is_some());
}

#[test]
fn a_buffer_read_and_written_by_one_pass_keeps_both() {
    let mut tracker = Tracker::new(true, Draws::Around);
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
    let mut tracker = Tracker::new(true, Draws::Around);
    tracker.pass(&[(buffer(1), ComputeRead), (buffer(2), ComputeRead)]);
    assert!(tracker.pass(&[(buffer(1), ComputeWrite)]).is_some());
    assert!(tracker.pass(&[(buffer(2), ComputeRead)]).is_none());
    assert!(tracker.pass(&[(buffer(2), ComputeWrite)]).is_some());
}

#[test]
fn a_barrier_never_names_mesh_stages_where_there_are_none() {
    let mut tracker = Tracker::new(false, Draws::Around);
    assert!(!tracker.opening().dst_stage_mask.intersects(MESH_STAGES));
    tracker.pass(&[(buffer(1), ComputeWrite)]);
    let barrier = tracker.pass(&[(buffer(1), DrawRead)]).unwrap();
    assert!(!barrier.dst_stage_mask.intersects(MESH_STAGES));
}

/// One access of a pass, and one barrier, by the pass that it stands before.
type Use = (usize, vk::Buffer, Access);
type Barriers = Vec<Option<vk::MemoryBarrier2<'static>>>;

/// True when two uses must not run in any order.
fn conflict(a: &Use, b: &Use) -> bool {
    a.0 < b.0 && a.1 == b.1 && (a.2.writes() || b.2.writes())
}

/// The oracle, straight from the specification: one barrier between two uses covers both, or each covers a use
/// between them.
fn ordered(a: &Use, b: &Use, uses: &[Use], barriers: &Barriers) -> bool {
    let ((from, _, written), (to, seen)) = (a.2.row(DRAW_STAGES), b.2.masks(DRAW_STAGES));
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
            proptest::collection::vec((0_u64..12, 0..Access::all().count()), 1..4), 1..7)
    ) {
        let names: Vec<Access> = Access::all().collect();
        let mut tracker = Tracker::new(true, Draws::Around);
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
