//! The log's lines about frames, for whoever embeds the renderer: how splats become pixels and why, where that changes, and
//! at trace level each frame and the outcome of the oldest one.

use super::{ConfiguredFrame, Renderer, choose};
use rara_base::counted::counted;

impl Renderer {
    /// Writes what is new about a frame that has been configured.
    pub(super) fn note_frame(&mut self, frame: &ConfiguredFrame) {
        let raster = frame.state.decision.raster(self.fell_back());
        if raster != self.noted {
            let how = format_args!("splats become pixels by {}: {}", raster.path, raster.reason);
            match raster.reason {
                // 911 ms for 150 on a CPU driver, 23 to 110 for .8 to 2.6 on an H200.
                choose::HIDDEN => log::warn!(
                    "{how}. Tiles take a fraction of the time: draw what is opaque in an earlier scope, and give Renderer::prepare \
                     the depth image"
                ),
                _ => log::info!("{how}"),
            }
            self.noted = raster;
        }
        // Nothing is put together where no logger asks for lines; C's function is one that asks for all.
        if log::log_enabled!(log::Level::Trace) {
            self.trace_frame(frame);
        }
    }

    fn trace_frame(&self, frame: &ConfiguredFrame) {
        let number = self.frames.prepared();
        if self.oldest().is_some() {
            let (counts, times) = (self.counts(), self.pass_times());
            let took = times.iter().map(|pass| pass.ms).sum::<f64>();
            let took = match times.is_empty() {
                true => String::from("untimed"),
                false => format!("{took:.3} ms on the device"),
            };
            log::trace!(
                "the oldest frame drew {}, {} of them cut, of {} of tile and splat: {took}",
                counted(counts.drawn, "splat"),
                counts.cutoff,
                counted(self.pairs(), "pair"),
            );
        }
        let plan = &frame.state.decision.plan;
        let [width, height] = plan.size();
        log::trace!(
            "frame {number} shows {} in {width}x{height} px with {}, room for {}, and without {}",
            counted(plan.gaussians(), "Gaussian"),
            counted(plan.cut.layers.most_surfaces(), "surface"),
            counted(plan.data.room.pair_capacity, "pair"),
            match frame.skipped() {
                skipped if skipped.is_empty() => "skipping a stage".into(),
                skipped => skipped.join(", "),
            }
        );
    }
}
