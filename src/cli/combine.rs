//! Medians and means over frames.

use rara::{Counts, FrameStats, PassTime};
use serde::Serialize;

/// Frames of one picture that were measured.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Measured {
    /// Their medians.
    #[serde(flatten)]
    pub(super) stats: FrameStats,
    /// The number of the frames.
    pub(super) samples: usize,
    pub(super) least: Times,
    pub(super) greatest: Times,
}

/// Times of a frame, milliseconds, as in [`FrameStats`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Times {
    /// None where the device took no times.
    gpu_ms: Option<f64>,
    wall_ms: f64,
}

impl Times {
    /// Of all of these the one that `better` chooses, each time by itself.
    fn of(all: impl Iterator<Item = Self>, better: fn(f64, f64) -> f64) -> Self {
        let both = all.reduce(|a, b| Self {
            gpu_ms: a.gpu_ms.zip(b.gpu_ms).map(|(a, b)| better(a, b)),
            wall_ms: better(a.wall_ms, b.wall_ms),
        });
        both.unwrap_or(Self {
            gpu_ms: None,
            wall_ms: 0.0,
        })
    }
}

impl Measured {
    pub(super) fn of(frames: &[FrameStats]) -> Self {
        let times = || {
            frames.iter().map(|frame| Times {
                gpu_ms: frame.gpu_ms,
                wall_ms: frame.wall_ms,
            })
        };
        Self {
            stats: combine(frames, Combine::Median),
            samples: frames.len(),
            least: Times::of(times(), f64::min),
            greatest: Times::of(times(), f64::max),
        }
    }

    /// The medians of several pictures' medians.
    pub(super) fn all<'a>(pictures: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let stats: Vec<_> = pictures.clone().map(|one| one.stats.clone()).collect();
        Self {
            stats: combine(&stats, Combine::Median),
            samples: pictures.clone().map(|one| one.samples).sum(),
            least: Times::of(pictures.clone().map(|one| one.least), f64::min),
            greatest: Times::of(pictures.map(|one| one.greatest), f64::max),
        }
    }
}

/// How the values of several frames become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Combine {
    Median,
    Mean,
}

impl Combine {
    fn of(self, mut values: Vec<f64>) -> f64 {
        let count = values.len();
        match self {
            _ if count == 0 => 0.0,
            Self::Mean => values.iter().sum::<f64>() / count as f64,
            Self::Median => {
                values.sort_unstable_by(f64::total_cmp);
                (values[(count - 1) / 2] + values[count / 2]) / 2.0
            }
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

/// Each value's median or mean over the frames. A stage that a frame did not run counts as 0 ms there, and is listed as
/// skipped when most frames skipped it.
pub(super) fn combine(frames: &[FrameStats], how: Combine) -> FrameStats {
    let value = |get: &dyn Fn(&FrameStats) -> f64| how.of(frames.iter().map(get).collect());
    let count = |get: fn(&Counts) -> u32| value(&|frame| get(&frame.counts).into()).round() as u32;
    let ms = |name: &str, frame: &FrameStats| {
        frame
            .passes
            .iter()
            .filter(|p| p.name == name)
            .map(|p| p.ms)
            .sum()
    };
    let passes = distinct(frames.iter().flat_map(|f| f.passes.iter().map(|p| p.name)));
    let mut skipped = distinct(frames.iter().flat_map(|f| f.skipped.iter().copied()));
    skipped.retain(|name| {
        2 * frames.iter().filter(|f| f.skipped.contains(name)).count() > frames.len()
    });
    let mut combined = FrameStats::default();
    combined.counts = match how {
        Combine::Median => middle(frames),
        Combine::Mean => Counts {
            visible: count(|c| c.visible),
            cutoff: count(|c| c.cutoff),
            invisible: count(|c| c.invisible),
            culled: count(|c| c.culled),
            drawn: count(|c| c.drawn),
        },
    };
    let passes = passes.into_iter().map(|name| PassTime {
        name,
        ms: value(&|frame| ms(name, frame)),
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
mod tests {
    use super::*;

    fn frame(gpu_ms: f64, visible: u32, sort: Option<f64>) -> FrameStats {
        let mut frame = FrameStats::default();
        frame.gpu_ms = Some(gpu_ms);
        frame.counts.visible = visible;
        frame.counts.drawn = visible;
        frame.passes.push(PassTime {
            name: "classify",
            ms: 1.0,
        });
        match sort {
            Some(ms) => frame.passes.push(PassTime { name: "sort", ms }),
            None => frame.skipped.push("sort"),
        }
        frame
    }

    #[test]
    fn medians_and_means() {
        let frames = [
            frame(9.0, 10, Some(3.0)),
            frame(1.0, 30, None),
            frame(2.0, 20, Some(6.0)),
        ];
        let median = combine(&frames, Combine::Median);
        assert_eq!((median.gpu_ms, median.counts.visible), (Some(2.0), 20));
        assert_eq!(
            median.passes[1],
            PassTime {
                name: "sort",
                ms: 3.0
            }
        );
        assert!(median.skipped.is_empty());
        let parts = [Measured::of(&frames[..1]), Measured::of(&frames[1..])];
        let all = Measured::all(parts.iter());
        assert_eq!((all.samples, all.stats.gpu_ms), (3, Some(5.25)));
        assert_eq!(
            (all.least.gpu_ms, all.greatest.gpu_ms),
            (Some(1.0), Some(9.0))
        );
        let mean = combine(&frames, Combine::Mean);
        assert_eq!((mean.gpu_ms, mean.passes[1].ms), (Some(4.0), 3.0));
        assert_eq!(combine(&frames[1..2], Combine::Median), frames[1]);
        assert_eq!(combine(&frames[1..], Combine::Median).gpu_ms, Some(1.5));
        assert_eq!(
            combine(&[FrameStats::default()], Combine::Mean).gpu_ms,
            None
        );
    }
}
