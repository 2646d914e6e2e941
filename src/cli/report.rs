//! The statistics: the `--json` document, medians and means over frames, and the table for people.

use std::fmt;
use std::path::PathBuf;

use rara::{Counts, FrameStats, PassTime};
use serde::Serialize;

use super::output::grouped;
use super::scenes::Scene;
use super::session::Session;

/// The statistics of a command. Its keys are what scripts rely on.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    device: String,
    driver: String,
    scene: SceneReport,
    size: [u32; 2],
    mode: &'static str,
    #[serde(flatten)]
    stats: FrameStats,
    memory: Memory,
    frames: Vec<FrameStats>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mean: Option<FrameStats>,
}

#[derive(Debug, Serialize)]
struct SceneReport {
    gaussians: usize,
    sh_degree: u32,
    repaired: u64,
    dropped: u64,
}

#[derive(Debug, Serialize)]
struct Memory {
    device_bytes: u64,
    peak_rss_bytes: u64,
}

impl Report {
    /// A report whose top level holds the frames' medians.
    pub(super) fn new(
        session: &Session,
        scene: &Scene,
        size: (u32, u32),
        mode: &'static str,
        frames: &[FrameStats],
    ) -> Self {
        let (device, driver, device_bytes) = session.about();
        Self {
            device,
            driver,
            scene: SceneReport {
                gaussians: scene.gaussians.len(),
                sh_degree: scene.gaussians.sh_degree,
                repaired: scene.repaired,
                dropped: scene.dropped,
            },
            size: [size.0, size.1],
            mode,
            stats: combine(frames, Combine::Median),
            memory: Memory {
                device_bytes,
                peak_rss_bytes: peak_rss_bytes(),
            },
            frames: Vec::new(),
            mean: None,
        }
    }

    /// Adds the single frames.
    pub(super) fn with_frames(self, frames: Vec<FrameStats>) -> Self {
        Self { frames, ..self }
    }

    /// Adds the frames' means.
    pub(super) fn with_mean(self) -> Self {
        Self {
            mean: Some(combine(&self.frames, Combine::Mean)),
            ..self
        }
    }
}

/// The table for people.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            scene,
            stats,
            memory,
            ..
        } = self;
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        writeln!(f, "device   {} ({})", self.device, self.driver)?;
        write!(
            f,
            "scene    {} Gaussians, SH degree {}",
            grouped(scene.gaussians as u64),
            scene.sh_degree
        )?;
        if scene.repaired + scene.dropped > 0 {
            write!(
                f,
                " ({} repaired, {} dropped)",
                grouped(scene.repaired),
                grouped(scene.dropped)
            )?;
        }
        write!(
            f,
            "\npicture  {}x{}, mode {}",
            self.size[0], self.size[1], self.mode
        )?;
        if !self.frames.is_empty() {
            write!(f, "; {} frames, medians:", self.frames.len())?;
        }
        writeln!(f, "\ncounts   {}", Shown(&stats.counts))?;
        write!(f, "passes  ")?;
        for pass in &stats.passes {
            write!(f, " {} {:.2}", pass.name, pass.ms)?;
        }
        if !stats.skipped.is_empty() {
            write!(f, " (skipped: {})", stats.skipped.join(", "))?;
        }
        writeln!(
            f,
            "\ntime     {:.2} ms on the device, {:.2} ms in all",
            stats.gpu_ms, stats.wall_ms
        )?;
        write!(
            f,
            "memory   {:.1} MiB on the device, {:.1} MiB here at most",
            mib(memory.device_bytes),
            mib(memory.peak_rss_bytes)
        )
    }
}

/// Counts for people.
struct Shown<'a>(&'a Counts);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Counts {
            visible,
            cutoff,
            invisible,
            culled,
            drawn,
        } = *self.0;
        let [visible, cutoff, invisible, culled, drawn] =
            [visible, cutoff, invisible, culled, drawn].map(|count| grouped(count.into()));
        write!(
            f,
            "{visible} visible, {cutoff} cut, {invisible} clipped away, {culled} culled; {drawn} drawn"
        )
    }
}

/// The line that says where the pictures went.
pub(super) fn wrote(paths: &[PathBuf]) -> String {
    match paths {
        [] => "wrote    nothing (no -o)".into(),
        [only] => format!("wrote    {}", only.display()),
        [first, .., last] => format!("wrote    {} to {}", first.display(), last.display()),
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

/// Each value's median or mean over the frames. A stage that a frame did not run took it 0 ms there, and counts as
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
    FrameStats {
        counts: Counts {
            visible: count(|c| c.visible),
            cutoff: count(|c| c.cutoff),
            invisible: count(|c| c.invisible),
            culled: count(|c| c.culled),
            drawn: count(|c| c.drawn),
        },
        passes: passes
            .into_iter()
            .map(|name| PassTime {
                name,
                ms: value(&|frame| ms(name, frame)),
            })
            .collect(),
        gpu_ms: value(&|frame| frame.gpu_ms),
        wall_ms: value(&|frame| frame.wall_ms),
        skipped,
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

/// The most memory this process ever had resident; 0 where the system does not tell.
fn peak_rss_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|rest| {
        rest.trim()
            .trim_end_matches("kB")
            .trim()
            .parse::<u64>()
            .ok()
    });
    kib.unwrap_or(0) * 1024
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(gpu_ms: f64, visible: u32, sort: Option<f64>) -> FrameStats {
        let mut frame = FrameStats {
            gpu_ms,
            ..FrameStats::default()
        };
        frame.counts.visible = visible;
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
        assert_eq!((median.gpu_ms, median.counts.visible), (2.0, 20));
        assert_eq!(
            median.passes[1],
            PassTime {
                name: "sort",
                ms: 3.0
            }
        );
        assert!(median.skipped.is_empty());
        let mean = combine(&frames, Combine::Mean);
        assert_eq!((mean.gpu_ms, mean.passes[1].ms), (4.0, 3.0));
        assert_eq!(combine(&frames[1..2], Combine::Median), frames[1]);
        assert_eq!(combine(&frames[1..], Combine::Median).gpu_ms, 1.5);
    }
}
