//! The memory that frames compute in, and the memory that they have outgrown.

use super::frames::FramesInFlight;
use super::outcome::Submission;
use super::pair_room::PairRoom;
use crate::error::{Error, Result};
use crate::gpu::Device;
use crate::passes::{Buffers, Plan};

/// The buffers that all frames share, one after the other.
#[derive(Debug, Default)]
pub(super) struct WorkingMemory {
    buffers: Option<Buffers>,
    /// Buffers that frames in flight may still use, with the number of frames prepared when they were replaced.
    retired: Vec<(u64, Buffers)>,
    /// The room for pairs of tile and splat.
    pub(super) pairs: PairRoom,
}

impl WorkingMemory {
    /// True when a plan fits into the present buffers.
    pub(super) fn fits(&self, plan: &Plan) -> bool {
        self.buffers
            .as_ref()
            .is_some_and(|buffers| buffers.fit(plan))
    }

    /// Replaces the buffers that a plan does not fit into, and keeps the others; after an error there are none.
    pub(super) fn replace(
        &mut self,
        device: &Device,
        plan: &Plan,
        frames: &FramesInFlight,
        submission: Submission,
    ) -> Result<()> {
        // Free first: both together may not fit.
        let outgrown = self.buffers.take();
        let spare = outgrown.as_ref().map(|buffers| buffers.spare_for(plan));
        let had_spare = spare.is_some();
        let prepared = frames.prepared();
        // What is used again lives on in the new buffers too.
        self.retired
            .extend(outgrown.map(|buffers| (prepared, buffers)));
        self.free_finished(frames.finished(submission));
        let made = match (
            Buffers::new(device, plan, spare.unwrap_or_default()),
            had_spare,
        ) {
            // What was kept may be larger than this plan needs.
            (Err(Error::Memory(_)), true) => Buffers::new(device, plan, Default::default()),
            (made, _) => made,
        };
        self.buffers = Some(made?);
        Ok(())
    }

    /// Frees buffers that only the first `finished` frames have used.
    pub(super) fn free_finished(&mut self, finished: u64) {
        self.retired.retain(|(prepared, _)| *prepared > finished);
    }

    /// Adds the further buffers of a reclipped frame.
    pub(super) fn ensure_reclip(&mut self, device: &Device) -> Result<()> {
        let buffers = self.buffers.as_mut().expect("replace() allocates them");
        buffers.ensure_reclip(device)
    }

    /// The buffers, if a frame has been configured.
    pub(super) fn allocated(&self) -> Option<&Buffers> {
        self.buffers.as_ref()
    }

    /// The buffers of a frame that is configured.
    pub(super) fn buffers(&self) -> &Buffers {
        self.buffers.as_ref().expect("replace() allocates them")
    }
}
