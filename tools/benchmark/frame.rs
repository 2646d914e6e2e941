//! One frame and what it took.

use std::time::Instant;

use rara::{Camera, Clip, FrameStats, Headless, Result, Settings};
use rara_lab::measure::processor_ms;

use crate::statistics::Summary;

/// The results of earlier frames that a frame may make use of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Past {
    /// Whatever the renderer has kept of the frames before.
    Kept,
    /// Nothing: all of it is computed.
    Forgotten,
}

/// A frame that was timed.
#[derive(Debug, Clone)]
pub(crate) struct Timed {
    /// From the call to the picture being ready on the device, planning included, milliseconds.
    pub(crate) frame_ms: f64,
    /// Of this process on all cores, milliseconds; 0 where the system does not count it.
    pub(crate) processor_ms: f64,
    pub(crate) stats: FrameStats,
}

/// Renders and times a frame.
pub(crate) fn frame(
    headless: &mut Headless,
    (camera, clip): (&Camera, &Clip),
    settings: &Settings,
    past: Past,
) -> Result<Timed> {
    if past == Past::Forgotten {
        forget(headless);
    }
    let (begin, spent) = (Instant::now(), processor_ms());
    let stats = headless.render(camera, clip, settings)?;
    Ok(Timed {
        frame_ms: begin.elapsed().as_secs_f64() * 1e3,
        processor_ms: processor_ms() - spent,
        stats,
    })
}

/// Makes the next frame computed from nothing.
fn forget(headless: &mut Headless) {
    headless.forget();
}

/// The columns of a frame that are not stages: the call, the processor's time, and all stages together.
pub(crate) const TOTALS: [&str; 3] = ["frame", "processor", "device"];

/// The stages that any of these frames went through, in the order in which frames go through them.
pub(crate) fn stages(frames: &[Vec<Timed>]) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = Vec::new();
    for frame in frames.iter().filter_map(|frames| frames.last()) {
        let mut after = 0;
        for pass in &frame.stats.passes {
            match names.iter().position(|name| *name == pass.name) {
                Some(at) => after = at + 1,
                None => {
                    names.insert(after, pass.name);
                    after += 1;
                }
            }
        }
    }
    names
}

/// One of [`TOTALS`] or of the stages, frame by frame; empty where no frame went through the stage.
pub(crate) fn column(frames: &[Timed], name: &str) -> Vec<f64> {
    let value = |timed: &Timed| match name {
        "frame" => Some(timed.frame_ms),
        "processor" => Some(timed.processor_ms),
        "device" => timed.stats.gpu_ms,
        _ => {
            let pass = timed.stats.passes.iter().find(|pass| pass.name == name)?;
            Some(pass.ms)
        }
    };
    frames.iter().filter_map(value).collect()
}

/// The summary of a [`column`].
pub(crate) fn summary(frames: &[Timed], name: &str) -> Summary {
    Summary::of(&column(frames, name))
}
