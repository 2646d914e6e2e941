//! Times of several choices, taken in turn so that their ratios hold on a machine that does other things too.

use rara::{Camera, Clip, Headless, Result, Scene, Settings};
use serde::Serialize;

use crate::frames::{FrameTime, fresh, in_turn, timed, times};
use crate::statistics::least;

/// The times of one choice, milliseconds.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Times {
    /// The median frame on the device.
    pub(crate) ms: f64,
    /// Each stage at its quickest on the device, which other work on the machine disturbs least.
    pub(crate) ms_min: f64,
    /// The median frame from recording to the picture.
    pub(crate) wall_ms: f64,
    /// The median frame of this process on all cores; 0 where the system does not count it.
    pub(crate) cpu_ms: f64,
    /// The least frame of this process on all cores.
    pub(crate) cpu_ms_min: f64,
    /// The cost of a choice: `ms_min` on the device, or, where the device is this machine's processor and the system
    /// counts its time, `cpu_ms_min`, which other work on the machine hardly disturbs.
    pub(crate) cost: f64,
    pub(crate) passes: Vec<Pass>,
}

/// The times of one stage, milliseconds.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Pass {
    pub(crate) name: String,
    pub(crate) ms: f64,
    pub(crate) ms_min: f64,
}

/// Times each clip with its settings. A round is one frame of each; there are `rounds` of them after a first one that is
/// not counted.
pub(crate) fn time(
    headless: &mut Headless,
    scene: &Scene<'_>,
    camera: &Camera,
    all: &[(&Clip, Settings)],
    rounds: u32,
) -> Result<Vec<Times>> {
    let mut loaded = None;
    let frames = in_turn(rounds..=rounds, all.len(), |index, _| {
        let (clip, settings) = &all[index];
        let sh = settings.precision.sh;
        if loaded != Some(sh) {
            headless.load_as(scene, sh)?;
            // The frame after an upload finds other data in the caches, so it is not timed.
            fresh(headless, camera, clip, settings)?;
            loaded = Some(sh);
        }
        timed(headless, camera, clip, settings)
    })?;
    let on_cpu = headless.device().info().kind_name() == "cpu";
    Ok(frames
        .iter()
        .map(|frames| summary(frames, on_cpu))
        .collect())
}

fn summary(frames: &[FrameTime], on_cpu: bool) -> Times {
    let [device, wall, cpu] = ["device", "frame", "processor"].map(|name| times(frames, name));
    let stages = frames.first().into_iter();
    let stages = stages.flat_map(|frame| &frame.stats.passes).map(|pass| {
        let ms = times(frames, pass.name);
        Pass {
            name: pass.name.to_owned(),
            ms: median(&ms),
            ms_min: least(&ms),
        }
    });
    let passes: Vec<Pass> = stages.collect();
    let ms_min = passes.iter().fold(0.0, |sum, p| sum + p.ms_min);
    let cpu_ms_min = Some(least(&cpu)).filter(|&ms| on_cpu && ms > 0.0 && ms.is_finite());
    Times {
        ms: median(&device),
        ms_min,
        cpu_ms_min: cpu_ms_min.unwrap_or(0.0),
        cost: cpu_ms_min.unwrap_or(ms_min),
        wall_ms: median(&wall),
        cpu_ms: median(&cpu),
        passes,
    }
}

fn median(values: &[f64]) -> f64 {
    crate::statistics::median(values).unwrap_or(0.0)
}

#[cfg(test)]
mod tests;
