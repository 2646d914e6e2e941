//! The statistics of frames: counts, times, and what was left out.

use super::Renderer;
use super::frames::{Configured, RecordedFrame};
use super::outcome::{Outcome, Submission};
use crate::gpu::{PassSpan, Timer};
use crate::passes::DRAW;
use crate::settings::Raster;
use crate::stats::{Counts, FrameStats, PassStatistics, PassTime, RasterChoice};
use crate::types::FrameCounts;

impl Renderer {
    /// The stages that the configured frame does not need.
    pub fn skipped(&self) -> Vec<&'static str> {
        let configured = self.configured();
        configured.map(Configured::skipped).unwrap_or_default()
    }

    /// How splats become pixels in the configured frame, or became pixels in the one that [`counts`](Self::counts) is about
    /// where its tiles had no room; and why in that way.
    pub fn raster(&self) -> RasterChoice {
        let configured = self.configured();
        let choice = configured.map(|configured| configured.raster(self.fell_back()));
        choice.unwrap_or_default()
    }

    /// True when the frame that [`counts`](Self::counts) is about had more pairs of tile and splat than there was room
    /// for, so that it was drawn as quads: the same picture, but slower. Of [`Show`](crate::Show)s that only tiles can make,
    /// and in [linear light](crate::ColorSpace::Linear), nothing was drawn. The next [`configure`](Self::configure) makes
    /// the room, up to 1.5 GiB, or 2.2 with the kernels for GPUs.
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

    /// The frame that was prepared last. Before it is waited for, it knows no more than what was configured.
    pub(crate) fn newest(&self) -> Option<&RecordedFrame> {
        self.frames.newest()
    }

    /// The frame that the public functions above are about.
    pub(crate) fn oldest(&self) -> Option<&RecordedFrame> {
        self.frames.oldest()
    }

    /// The outcome of a frame that was waited for.
    pub(crate) fn outcome(&self, frame: &RecordedFrame) -> Outcome {
        let configured = frame.configured.as_ref();
        if configured.is_none_or(Configured::changes_nothing) {
            return Outcome::Unchanged;
        }
        if !frame.fell_back() {
            return Outcome::Drawn;
        }
        let needs_tiles = configured.is_some_and(|configured| configured.needs_tiles);
        let redrawn = configured.is_some_and(|configured| configured.redrawn);
        match self.memory.pairs.can_grow_to(frame.pairs()) {
            true => Outcome::NeedsRoom,
            false if needs_tiles => Outcome::NoRoom,
            false if redrawn => Outcome::NeedsRoom,
            false => Outcome::Drawn,
        }
    }

    /// The statistics of a configured frame that [changes nothing](Self::changes_nothing) and is not even recorded.
    pub(crate) fn unchanged_stats(&self) -> FrameStats {
        let newest = self.newest();
        let fell_back = newest.is_some_and(RecordedFrame::fell_back);
        let raster = self.configured().map(|c| c.raster(fell_back));
        let mut skipped = self.skipped();
        if !skipped.contains(&DRAW) {
            skipped.push(DRAW);
        }
        FrameStats {
            counts: newest.map(RecordedFrame::counts).unwrap_or_default(),
            skipped,
            raster: raster.unwrap_or_default(),
            gpu_ms: self.desc.timing.then_some(0.0),
            ..FrameStats::default()
        }
    }
}

impl Configured {
    fn skipped(&self) -> Vec<&'static str> {
        self.plan.skipped()
    }

    fn raster(&self, fell_back: bool) -> RasterChoice {
        let path = match self.plan.way.raster {
            Raster::Tiles if fell_back && self.needs_tiles => {
                return RasterChoice {
                    path: "tiles",
                    reason: "there is no room for the tiles' lists, so that nothing is drawn",
                };
            }
            Raster::Tiles if fell_back => {
                return RasterChoice {
                    path: "quad",
                    reason: "there is no room for the tiles' lists",
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
    /// True when it was submitted while earlier frames were unfinished.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    pub(crate) fn is_in_flight(&self) -> bool {
        let configured = self.configured.as_ref();
        configured.is_some_and(|configured| configured.submission == Submission::InFlight)
    }

    /// True when it was the first to use a pipeline, which the driver may have compiled within it.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    pub(crate) fn is_first_use(&self) -> bool {
        let configured = self.configured.as_ref();
        configured.is_some_and(|configured| configured.is_first_use)
    }

    /// All that is known of it but the time until it was ready, which only the one who waited knows.
    pub(crate) fn stats(&self) -> FrameStats {
        let passes = self.pass_times();
        let configured = self.configured.as_ref();
        FrameStats {
            counts: self.counts(),
            gpu_ms: self.gpu_ms(&passes),
            passes,
            wall_ms: 0.0,
            skipped: configured.map(Configured::skipped).unwrap_or_default(),
            raster: configured.map_or_else(RasterChoice::default, |configured| {
                configured.raster(self.fell_back())
            }),
            statistics: self.pass_statistics(),
        }
    }

    /// The sum of its times, if they were taken.
    fn gpu_ms(&self, passes: &[PassTime]) -> Option<f64> {
        let was_submitted = self.configured.is_some();
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
        counts.is_some_and(|counts| counts.pairs > 0 && counts.tiled == 0)
    }

    /// Whether its tiles' lists had no room, and the pairs that it had.
    pub(super) fn need(&self) -> (bool, u32) {
        (self.fell_back(), self.pairs())
    }

    /// The pairs of tile and splat that it had, or would have had.
    pub(super) fn pairs(&self) -> u32 {
        self.read_counts().map_or(0, |counts| counts.pairs)
    }

    fn counts(&self) -> Counts {
        let Some(FrameCounts {
            visible,
            cutoff,
            invisible,
            culled,
            ..
        }) = self.read_counts()
        else {
            return Counts::default();
        };
        Counts {
            visible,
            cutoff,
            invisible,
            culled,
            drawn: visible + cutoff,
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
        let configured = self.configured.as_ref();
        configured.is_none_or(|configured| configured.plan.gaussians() == 0)
    }
}
