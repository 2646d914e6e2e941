//! The frames that may be unfinished at once, and what is known of each once it was waited for.

use std::sync::Arc;

use super::outcome::Submission;
use crate::passes::{Buffers, CutPlan, EyePlan, Sight, Targets, Work};
use crate::types::FrameCounts;
use rara_base::error::Result;
use rara_gpu::{Buffer, BufferDesc, Device, Location, Timer};
use rara_scene::depth::DepthMap;

/// What [`Renderer::configure`](super::Renderer::configure) has decided about a frame.
#[derive(Debug, Clone)]
pub(super) struct Decision {
    /// The scene's number.
    pub(super) scene: u64,
    pub(super) plan: EyePlan,
    /// Why splats become pixels in the plan's way.
    pub(super) reason: &'static str,
    pub(super) targets: Targets,
    /// The map from a depth in the scene's units to the host's depth buffer.
    pub(super) depth_map: Option<DepthMap>,
    /// World units in one of the scene's.
    pub(super) unit: f64,
    /// Where the layers have the camera, where motion is drawn.
    pub(super) sight: Option<Sight>,
    /// True when it is the first to use a pipeline: drivers may compile that within the frame.
    pub(super) is_first_use: bool,
}

impl Decision {
    /// True when it takes something over from the frame before.
    pub(super) fn takes_over(&self, owns_cut: bool) -> bool {
        let cut = &self.plan.cut;
        self.plan.work != Work::Whole || (owns_cut && cut.clips() && !cut.finds_sides)
    }

    /// True when its pixels are those of the frame before it.
    pub(super) fn changes_nothing(&self) -> bool {
        self.plan.work == Work::Draw || self.plan.gaussians() == 0
    }
}

/// A recorded frame, until its slot's next one is recorded.
#[derive(Debug)]
pub(crate) struct RecordedFrame {
    pub(super) timer: Option<Timer>,
    /// The buffer in which the host reads the frame's [`FrameCounts`].
    pub(super) counts: Buffer,
    /// The recorded frame; `None` before the first one, and for one that was never submitted.
    pub(super) decision: Option<Decision>,
    /// True when a draw of it was recorded.
    pub(super) is_drawn: bool,
    /// What it uses of a cut of the host's.
    pub(super) cut: Option<Arc<Buffers<CutPlan>>>,
}

impl RecordedFrame {
    fn new(device: &Device, timing: bool, statistics: bool) -> Result<Self> {
        let mut counts = device.create_buffer(&BufferDesc {
            name: "counts_readback",
            size: size_of::<FrameCounts>() as u64,
            location: Location::Readback,
        })?;
        // There is room for a frame's stages and several draws; further draws have no times.
        let timer = || match (Timer::new(device, 16), statistics) {
            (Ok(timer), true) => timer.with_statistics(),
            (timer, _) => timer,
        };
        let nothing = [0; size_of::<FrameCounts>()];
        counts.mapped_mut().write(0, &nothing); // these are read for a frame that is never submitted
        Ok(Self {
            timer: timing.then(timer).transpose()?,
            counts,
            decision: None,
            is_drawn: false,
            cut: None,
        })
    }
}

/// A slot for each frame in flight, taken in turn.
#[derive(Debug)]
pub(super) struct FramesInFlight {
    slots: Box<[RecordedFrame]>,
    prepared: u64,
}

impl FramesInFlight {
    pub(super) fn new(device: &Device, count: u32, timing: bool, statistics: bool) -> Result<Self> {
        let slots = (0..count).map(|_| RecordedFrame::new(device, timing, statistics));
        Ok(Self {
            slots: slots.collect::<Result<_>>()?,
            prepared: 0,
        })
    }

    /// Gives back what frames use of hosts' cuts, once all of them are finished.
    pub(super) fn release_cuts(&mut self) {
        for slot in &mut self.slots {
            slot.cut = None;
        }
    }

    /// The slot for one more frame.
    pub(super) fn begin(&mut self, decision: &Decision) -> &mut RecordedFrame {
        let at = self.slot(self.prepared);
        self.prepared += 1;
        let slot = &mut self.slots[at];
        slot.decision = Some(decision.clone());
        slot.is_drawn = false;
        slot
    }

    /// True when a draw of a frame may be unfinished that the host has not waited for before the next one.
    pub(super) fn may_be_drawing(&self) -> bool {
        let finished = self.slot(self.prepared);
        let unfinished = |(at, slot): (usize, &RecordedFrame)| at != finished && slot.is_drawn;
        self.slots.iter().enumerate().any(unfinished)
    }

    pub(super) fn newest(&self) -> Option<&RecordedFrame> {
        let at = self.slot(self.prepared.checked_sub(1)?);
        Some(&self.slots[at])
    }

    pub(super) fn newest_mut(&mut self) -> Option<&mut RecordedFrame> {
        let at = self.slot(self.prepared.checked_sub(1)?);
        Some(&mut self.slots[at])
    }

    /// The frame that the host waits for next: the next one takes its slot. `None` where no frame is that old.
    pub(super) fn oldest(&self) -> Option<&RecordedFrame> {
        let count = self.slots.len() as u64;
        (self.prepared >= count).then(|| &self.slots[self.slot(self.prepared)])
    }

    /// The pairs of tile and splat of the last frame that was waited for before one of this submission.
    pub(super) fn awaited_pairs(&self, submission: Submission) -> u32 {
        let frame = match submission {
            Submission::Awaited => self.newest(),
            Submission::InFlight => self.oldest(),
        };
        frame.map_or(0, RecordedFrame::pairs)
    }

    pub(super) fn slots(&self) -> &[RecordedFrame] {
        &self.slots
    }

    pub(super) fn prepared(&self) -> u64 {
        self.prepared
    }

    /// How many of these, counted from the first, are finished when one of this submission is configured.
    pub(super) fn finished(&self, submission: Submission) -> u64 {
        match submission {
            Submission::Awaited => self.prepared,
            Submission::InFlight => self.finished_at_least() + u64::from(self.oldest().is_some()),
        }
    }

    /// How many of these are finished whenever the host calls, as it has waited for them before the last one.
    pub(super) fn finished_at_least(&self) -> u64 {
        self.prepared.saturating_sub(self.slots.len() as u64)
    }

    fn slot(&self, frame: u64) -> usize {
        (frame % self.slots.len() as u64) as usize
    }
}
