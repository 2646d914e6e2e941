//! The statistics of frames: counts, times, and what was left out.

use super::frames::{Decision, RecordedFrame};
use super::outcome::Outcome;
use super::{ConfiguredFrame, Renderer};
use crate::passes::DRAW;
use crate::stats::{FrameStats, PassTime, RasterChoice};
use crate::types::FrameCounts;
use rara_base::stats::{Counts, PassStatistics};
use rara_gpu::{PassSpan, Timer};
use rara_scene::settings::Raster;

impl Renderer {
    /// How splats became pixels in the frame that [`counts`](Self::counts) is about, and why in that way.
    pub fn raster(&self) -> RasterChoice {
        self.oldest().map(RecordedFrame::raster).unwrap_or_default()
    }

    /// The stages that the same frame did not need.
    pub fn skipped(&self) -> Vec<&'static str> {
        let decision = self.oldest().and_then(|frame| frame.decision.as_ref());
        decision.map(Decision::skipped).unwrap_or_default()
    }

    /// True when the frame that [`counts`](Self::counts) is about had more pairs of tile and splat than there was room
    /// for, so that its tiles looked for their splats in coarse lists: the same picture, but slower. The next
    /// [`configure`](Self::configure) makes the room, up to 1.5 GiB, or 2.2 with the pipelines for GPUs.
    pub fn fell_back(&self) -> bool {
        self.oldest().is_some_and(RecordedFrame::fell_back)
    }

    /// The pairs of tile and splat of the same frame.
    pub(super) fn pairs(&self) -> u32 {
        self.oldest().map_or(0, RecordedFrame::pairs)
    }

    /// How many Gaussians ended where in the oldest frame that is kept: the last one, with one frame in flight. Ask
    /// after waiting for it, before the next [`prepare`](Self::prepare). The counts are zero where no frame is that old.
    pub fn counts(&self) -> Counts {
        self.oldest().map(RecordedFrame::counts).unwrap_or_default()
    }

    /// GPU time of each stage of the same frame as [`counts`](Self::counts); empty without timing.
    pub fn pass_times(&self) -> Vec<PassTime> {
        let oldest = self.oldest();
        oldest.map(RecordedFrame::pass_times).unwrap_or_default()
    }

    /// When each of these stages began and ended, in ticks of the device's clock.
    pub fn pass_spans(&self) -> Vec<PassSpan> {
        let oldest = self.oldest();
        oldest.map(RecordedFrame::pass_spans).unwrap_or_default()
    }

    /// The statistics of each of these stages; empty without statistics.
    pub fn pass_statistics(&self) -> Vec<PassStatistics> {
        let oldest = self.oldest();
        oldest
            .map(RecordedFrame::pass_statistics)
            .unwrap_or_default()
    }

    /// All of these statistics of the same frame; `None` where no frame is that old. `wall_ms` is 0, as only the host knows when a
    /// frame is ready.
    pub fn stats(&self) -> Option<FrameStats> {
        self.oldest().map(RecordedFrame::stats)
    }

    /// The outcome of the same frame, for hosts that draw only what has changed. `None` where no frame is that old.
    pub fn outcome(&self) -> Option<Outcome> {
        self.oldest().map(|frame| self.outcome_of(frame))
    }

    /// True when the same frame was the first to use a pipeline, which the driver may have compiled within it: then its times are
    /// longer than those of the next.
    pub fn is_first_use(&self) -> bool {
        let decision = self.oldest().and_then(|frame| frame.decision.as_ref());
        decision.is_some_and(|decision| decision.is_first_use)
    }

    /// The frame that was prepared last. Before it is waited for, it knows no more than what was configured.
    pub(crate) fn newest(&self) -> Option<&RecordedFrame> {
        self.frames.newest()
    }

    /// The frame that the public functions above are about.
    pub(crate) fn oldest(&self) -> Option<&RecordedFrame> {
        self.frames.oldest()
    }

    /// The outcome of a frame that was waited for.
    pub(crate) fn outcome_of(&self, frame: &RecordedFrame) -> Outcome {
        let Some(decision) = &frame.decision else {
            return Outcome::Unchanged;
        };
        if decision.changes_nothing() {
            return Outcome::Unchanged;
        }
        Outcome::Drawn
    }

    /// The statistics of a frame that changes nothing and is not even recorded.
    pub(crate) fn unchanged_stats(&self, frame: &ConfiguredFrame) -> FrameStats {
        let newest = self.newest();
        let fell_back = newest.is_some_and(RecordedFrame::fell_back);
        let mut skipped = frame.skipped();
        if !skipped.contains(&DRAW) {
            skipped.push(DRAW);
        }
        FrameStats {
            counts: newest.map(RecordedFrame::counts).unwrap_or_default(),
            skipped,
            raster: frame.state.decision.raster(fell_back),
            gpu_ms: self.desc.timing.then_some(0.0),
            ..FrameStats::default()
        }
    }
}

impl Decision {
    pub(super) fn skipped(&self) -> Vec<&'static str> {
        self.plan.skipped()
    }

    /// How splats become pixels, and why in that way.
    pub(super) fn raster(&self, fell_back: bool) -> RasterChoice {
        let path = match self.plan.way.raster {
            Raster::Tiles if fell_back => {
                return RasterChoice {
                    path: "tiles",
                    reason: "there is no room for a list of each tile, so that they have coarse ones",
                };
            }
            Raster::Mesh => "mesh",
            Raster::Quad => "quad",
            Raster::Tiles => "tiles",
            Raster::Auto => "",
        };
        let reason = self.reason;
        RasterChoice { path, reason }
    }
}

impl RecordedFrame {
    /// All that is known of it but the time until it was ready, which only the one who waited knows.
    pub(crate) fn stats(&self) -> FrameStats {
        let passes = self.pass_times();
        let decision = self.decision.as_ref();
        FrameStats {
            counts: self.counts(),
            gpu_ms: self.gpu_ms(&passes),
            passes,
            wall_ms: 0.0,
            skipped: decision.map(Decision::skipped).unwrap_or_default(),
            raster: self.raster(),
            statistics: self.pass_statistics(),
        }
    }

    fn raster(&self) -> RasterChoice {
        let decision = self.decision.as_ref();
        decision.map_or_else(RasterChoice::default, |decision| {
            decision.raster(self.fell_back())
        })
    }

    /// The sum of its times, if they were taken.
    fn gpu_ms(&self, passes: &[PassTime]) -> Option<f64> {
        let was_submitted = self.decision.is_some();
        let has_times = self.timer.is_some()
            && was_submitted
            && (self.recorded_nothing() || !passes.is_empty());
        has_times.then(|| passes.iter().fold(0.0, |sum, pass| sum + pass.ms)) // `sum` of nothing is -0
    }

    pub(crate) fn pass_spans(&self) -> Vec<PassSpan> {
        self.timer().and_then(Timer::spans).unwrap_or_default()
    }

    pub(crate) fn pass_statistics(&self) -> Vec<PassStatistics> {
        self.timer().map(Timer::statistics).unwrap_or_default()
    }

    /// True when its tiles' lists had no room.
    pub(super) fn fell_back(&self) -> bool {
        let counts = self.read_counts();
        counts.is_some_and(|counts| counts.pairs > 0 && counts.has_room == 0)
    }

    /// The pairs of tile and splat that it had, or would have had.
    pub(super) fn pairs(&self) -> u32 {
        self.read_counts().map_or(0, |counts| counts.pairs)
    }

    fn counts(&self) -> Counts {
        let (Some(counts), Some(decision)) = (self.read_counts(), &self.decision) else {
            return Counts::default();
        };
        let FrameCounts {
            visible,
            cutoff,
            invisible,
            culled,
            ..
        } = counts;
        let has_room = counts.long_strides <= decision.plan.data.weight.long_strides;
        Counts {
            visible,
            cutoff,
            invisible,
            culled,
            drawn: visible + cutoff,
            shortened: if has_room { 0 } else { counts.long_records },
        }
    }

    fn pass_times(&self) -> Vec<PassTime> {
        let times = self.timer().and_then(Timer::read).unwrap_or_default();
        times
            .into_iter()
            .map(|(name, ms)| PassTime { name, ms })
            .collect()
    }

    fn read_counts(&self) -> Option<FrameCounts> {
        if self.recorded_nothing() {
            return None;
        }
        let bytes = &self.counts.mapped()[..size_of::<FrameCounts>()];
        Some(bytemuck::pod_read_unaligned(bytes))
    }

    fn timer(&self) -> Option<&Timer> {
        self.timer.as_ref().filter(|_| !self.recorded_nothing())
    }

    /// True when nothing was recorded, so that nothing was counted.
    fn recorded_nothing(&self) -> bool {
        let decision = self.decision.as_ref();
        decision.is_none_or(|decision| decision.plan.gaussians() == 0)
    }
}
