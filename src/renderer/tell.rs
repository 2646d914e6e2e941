//! What a renderer tells about its frames: counts, times, and what was left out.

use super::{Renderer, Slot};
use crate::gpu::{PassSpan, Timer};
use crate::passes::Plan;
use crate::settings::Raster;
use crate::stats::{Counts, PassStatistics, PassTime, RasterChoice};
use crate::types::FrameCounts;

impl Renderer {
    /// The stages that the configured frame does not need.
    pub fn skipped(&self) -> Vec<&'static str> {
        self.plan.as_ref().map(Plan::skipped).unwrap_or_default()
    }

    /// How splats become pixels in the configured frame, or became in the one that [`counts`](Self::counts) is about where
    /// its tiles had no room; and why in that way.
    pub fn raster(&self) -> RasterChoice {
        let raster = self.plan.as_ref().map(|plan| plan.way.raster);
        if raster == Some(Raster::Tiles) && self.fell_back() {
            return RasterChoice {
                path: "quad",
                reason: "there is no room for the tiles' lists",
            };
        }
        let path = match raster {
            Some(Raster::Mesh) => "mesh",
            Some(Raster::Quad) => "quad",
            Some(Raster::Tiles) => "tiles",
            Some(Raster::Auto) | None => "",
        };
        let reason = self.reason;
        RasterChoice { path, reason }
    }

    /// Whether the frame that [`counts`](Self::counts) is about had more pairs of tile and splat than there was room for,
    /// so that it was drawn as quads: the same picture, but slower. The next [`configure`](Self::configure) makes the
    /// room, up to 1.5 GiB.
    pub fn fell_back(&self) -> bool {
        let counts = self.frame_counts();
        counts.is_some_and(|counts| counts.pairs > 0 && counts.tiled == 0)
    }

    /// How many Gaussians ended where in the oldest frame that is kept: the last one, with one frame in flight. Ask
    /// after waiting for it, before the next [`prepare`](Self::prepare). All zero where no frame is that old.
    pub fn counts(&self) -> Counts {
        let Some(FrameCounts {
            visible,
            cutoff,
            invisible,
            culled,
            ..
        }) = self.frame_counts()
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

    pub(super) fn frame_counts(&self) -> Option<FrameCounts> {
        let slot = self.oldest().filter(|slot| !slot.empty)?;
        let bytes = &slot.counts.mapped()[..size_of::<FrameCounts>()];
        Some(bytemuck::pod_read_unaligned(bytes))
    }

    /// GPU time of each stage of the same frame as [`counts`](Self::counts); empty without timing.
    pub fn pass_times(&self) -> Vec<PassTime> {
        let times = self.timer().and_then(Timer::read).unwrap_or_default();
        times
            .into_iter()
            .map(|(name, ms)| PassTime { name, ms })
            .collect()
    }

    /// When each of these stages began and ended, in ticks of the device's clock.
    pub fn pass_spans(&self) -> Vec<PassSpan> {
        self.timer().and_then(Timer::spans).unwrap_or_default()
    }

    /// What each of these stages did; empty without statistics.
    pub fn pass_statistics(&self) -> Vec<PassStatistics> {
        self.timer().map(Timer::statistics).unwrap_or_default()
    }

    fn timer(&self) -> Option<&Timer> {
        self.oldest()
            .filter(|slot| !slot.empty)
            .and_then(|slot| slot.timer.as_ref())
    }

    /// The slot of the frame before which the host waits next: the one that the next frame will take over.
    fn oldest(&self) -> Option<&Slot> {
        let count = self.slots.len() as u64;
        (self.prepared >= count).then(|| &self.slots[(self.prepared % count) as usize])
    }
}
