//! Medians, means and sums over frames.

use rara::{Counts, FrameStats, PassTime};
use rara_base::stats::median;
use serde::Serialize;

use super::times;

/// Frames of one picture that were measured.
#[derive(Debug, Clone, Serialize)]
pub(super) struct FrameSummary {
    #[serde(flatten)]
    pub(super) stats: FrameStats,
    pub(super) samples: usize,
    pub(super) least: Times,
    pub(super) greatest: Times,
}

/// Times of a frame, milliseconds, as in [`FrameStats`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Times {
    /// The time on the device; none where it took no times.
    gpu_ms: Option<f64>,
    wall_ms: f64,
}

impl Times {
    /// All of these as one, each time combined by `join`.
    fn join(all: impl Iterator<Item = Self>, join: fn(f64, f64) -> f64) -> Self {
        let joined = all.reduce(|a, b| Self {
            gpu_ms: a.gpu_ms.zip(b.gpu_ms).map(|(a, b)| join(a, b)),
            wall_ms: join(a.wall_ms, b.wall_ms),
        });
        joined.unwrap_or(Self {
            gpu_ms: None,
            wall_ms: 0.0,
        })
    }
}

impl FrameSummary {
    pub(super) fn from_frames(frames: &[FrameStats]) -> Self {
        let times = || {
            frames.iter().map(|frame| Times {
                gpu_ms: frame.gpu_ms,
                wall_ms: frame.wall_ms,
            })
        };
        Self {
            stats: combine(frames, Combine::Median),
            samples: frames.len(),
            least: Times::join(times(), f64::min),
            greatest: Times::join(times(), f64::max),
        }
    }

    /// The sums of what the parts of one picture took.
    pub(super) fn together<'a>(parts: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let stats: Vec<_> = parts.clone().map(|one| one.stats.clone()).collect();
        let add = |a, b| a + b;
        Self {
            stats: combine(&stats, Combine::Sum),
            samples: parts.clone().map(|one| one.samples).sum(),
            least: Times::join(parts.clone().map(|one| one.least), add),
            greatest: Times::join(parts.map(|one| one.greatest), add),
        }
    }

    /// The medians of several pictures' medians.
    pub(super) fn all<'a>(pictures: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let stats: Vec<_> = pictures.clone().map(|one| one.stats.clone()).collect();
        Self {
            stats: combine(&stats, Combine::Median),
            samples: pictures.clone().map(|one| one.samples).sum(),
            least: Times::join(pictures.clone().map(|one| one.least), f64::min),
            greatest: Times::join(pictures.map(|one| one.greatest), f64::max),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Combine {
    Median,
    Mean,
    Sum,
}

impl Combine {
    /// The values combined; 0 without any.
    pub(super) fn apply(self, values: Vec<f64>) -> f64 {
        let count = values.len().max(1) as f64;
        match self {
            Self::Sum => times::sum(values),
            Self::Mean => times::sum(values) / count,
            Self::Median => median(&values).unwrap_or(0.0),
        }
    }
}

/// The counts of the frame that draws a middling number of splats. Medians of each count by itself would not add up to
/// the scene.
fn middle(frames: &[FrameStats]) -> Counts {
    let mut counts: Vec<Counts> = frames.iter().map(|frame| frame.counts).collect();
    counts.sort_by_key(|counts| counts.drawn);
    counts.get(frames.len() / 2).copied().unwrap_or_default()
}

/// Each value's median, mean or sum over the frames. A stage that some of them did not run took 0 ms there. It is among the
/// stages that were skipped, and has no time, where no frame ran it, and of medians where most frames did not.
pub(super) fn combine(frames: &[FrameStats], how: Combine) -> FrameStats {
    let value = |get: &dyn Fn(&FrameStats) -> f64| how.apply(frames.iter().map(get).collect());
    let count = |get: fn(&Counts) -> u32| value(&|frame| get(&frame.counts).into()).round() as u32;
    let ran = |name: &str| {
        let count = frames.iter().filter(|frame| ran(frame, name)).count();
        match how {
            Combine::Median => 2 * count >= frames.len(),
            Combine::Mean | Combine::Sum => count > 0,
        }
    };
    let timed = frames.iter().flat_map(|f| f.passes.iter().map(|p| p.name));
    let skipped = frames.iter().flat_map(|f| f.skipped.iter().copied());
    let passes = distinct(timed.clone()).into_iter().filter(|name| ran(name));
    let mut skipped = distinct(skipped.chain(timed));
    skipped.retain(|name| !ran(name));
    let mut combined = FrameStats::default();
    combined.counts = match how {
        Combine::Median | Combine::Sum => middle(frames),
        Combine::Mean => Counts {
            visible: count(|c| c.visible),
            cutoff: count(|c| c.cutoff),
            invisible: count(|c| c.invisible),
            culled: count(|c| c.culled),
            drawn: count(|c| c.drawn),
            shortened: count(|c| c.shortened),
        },
    };
    let passes = passes.map(|name| PassTime {
        name,
        ms: value(&|frame| times::of_stage(frame, name).unwrap_or_default()),
    });
    combined.passes = passes.collect();
    let is_timed = frames.iter().any(|frame| frame.gpu_ms.is_some());
    combined.gpu_ms = is_timed.then(|| value(&|frame| frame.gpu_ms.unwrap_or_default()));
    combined.wall_ms = value(&|frame| frame.wall_ms);
    combined.skipped = skipped;
    if let Some(last) = frames.last() {
        combined.raster = last.raster;
        // The last frame's statistics: they show what is in one frame, and are no measure of many.
        combined.statistics = last.statistics.clone();
    }
    combined
}

/// True where a frame ran a stage that others ran or skipped.
fn ran(frame: &FrameStats, stage: &str) -> bool {
    match frame.gpu_ms {
        Some(_) => times::of_stage(frame, stage).is_some(),
        // Nothing was timed, so that what it skipped is all that is known.
        None => !frame.skipped.contains(&stage),
    }
}

/// The names in the order of their first appearance.
fn distinct(names: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

#[cfg(test)]
mod tests;
