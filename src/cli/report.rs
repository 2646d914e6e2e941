//! The statistics: the `--json` document and the table for people.

use std::fmt;
use std::path::PathBuf;

use rara::gpu::{DeviceShape, NamedBytes};
use rara::{Counts, FrameStats};
use serde::Serialize;

use super::combine::{Combine, combine};
use super::output::{self, grouped, say};
use super::scenes::Loaded;
use super::session::Session;

/// The statistics of a command. Its keys are what scripts rely on.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    device: String,
    driver: String,
    shape: ShapeReport,
    scene: SceneReport,
    size: [u32; 2],
    mode: String,
    #[serde(flatten)]
    stats: FrameStats,
    memory: Memory,
    frames: Vec<FrameStats>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mean: Option<FrameStats>,
}

/// The kind of machine that kernels were chosen for, and the reason.
#[derive(Debug, Serialize)]
struct ShapeReport {
    #[serde(flatten)]
    shape: DeviceShape,
    reason: &'static str,
}

#[derive(Debug, Serialize)]
struct SceneReport {
    gaussians: usize,
    sh_degree: u32,
    repaired: u64,
    dropped: u64,
    /// One for each file, in order.
    layers: Vec<LayerReport>,
}

#[derive(Debug, Serialize)]
struct LayerReport {
    name: String,
    gaussians: usize,
}

#[derive(Debug, Serialize)]
struct Memory {
    device_bytes: u64,
    /// The part of `device_bytes` that the scene takes.
    scene_bytes: u64,
    /// `scene_bytes` for each Gaussian.
    scene_bytes_per_gaussian: f64,
    peak_rss_bytes: u64,
    /// The parts of `device_bytes` by purpose, the largest first.
    purposes: Vec<NamedBytes>,
}

impl Report {
    /// Prints it as JSON to stdout, or for people, with the pictures that were written.
    pub(super) fn print(&self, json: bool, written: &[PathBuf]) -> rara::Result<()> {
        if json {
            return output::json(self);
        }
        say(self);
        say(wrote(written));
        Ok(())
    }

    /// A report whose top level holds the frames' medians.
    pub(super) fn new(
        session: &Session,
        loaded: &Loaded,
        size: (u32, u32),
        mode: String,
        frames: &[FrameStats],
    ) -> Self {
        let (device, driver, device_bytes) = session.about();
        let (shape, reason) = session.shape();
        let scene_bytes = session.scene_bytes();
        let scene = loaded.scene();
        Self {
            device,
            driver,
            shape: ShapeReport { shape, reason },
            scene: SceneReport {
                gaussians: scene.gaussians(),
                sh_degree: scene.sh_degree(),
                repaired: loaded.repaired,
                dropped: loaded.dropped,
                layers: scene
                    .layers()
                    .iter()
                    .map(|layer| LayerReport {
                        name: layer.name().to_owned(),
                        gaussians: layer.gaussians().len(),
                    })
                    .collect(),
            },
            size: [size.0, size.1],
            mode,
            stats: combine(frames, Combine::Median),
            memory: Memory {
                device_bytes,
                scene_bytes,
                scene_bytes_per_gaussian: scene_bytes as f64 / scene.gaussians().max(1) as f64,
                peak_rss_bytes: peak_rss_bytes(),
                purposes: session.memory_by_name(),
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
        writeln!(f, "\ncounts   {}", CountsText(&stats.counts))?;
        write!(f, "passes  ")?;
        for pass in &stats.passes {
            write!(f, " {} {:.2}", pass.name, pass.ms)?;
        }
        if !stats.skipped.is_empty() {
            write!(f, " (skipped: {})", stats.skipped.join(", "))?;
        }
        for pass in &stats.statistics {
            write!(
                f,
                "\n  {:<9} {} compute, {} vertex and {} fragment invocations, {} primitives",
                pass.name,
                grouped(pass.compute_invocations),
                grouped(pass.vertex_invocations),
                grouped(pass.fragment_invocations),
                grouped(pass.primitives)
            )?;
        }
        writeln!(
            f,
            "\ntime     {:.2} ms on the device, {:.2} ms in all",
            stats.gpu_ms.unwrap_or_default(),
            stats.wall_ms
        )?;
        write!(
            f,
            "memory   {:.1} MiB on the device, {:.1} of them the scene's ({:.1} bytes a Gaussian); {:.1} MiB here at most",
            mib(memory.device_bytes),
            mib(memory.scene_bytes),
            memory.scene_bytes_per_gaussian,
            mib(memory.peak_rss_bytes)
        )
    }
}

/// Counts for people.
struct CountsText<'a>(&'a Counts);

impl fmt::Display for CountsText<'_> {
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
fn wrote(paths: &[PathBuf]) -> String {
    match paths {
        [] => "wrote    nothing (no -o)".into(),
        [only] => format!("wrote    {}", only.display()),
        [first, .., last] => format!("wrote    {} to {}", first.display(), last.display()),
    }
}

/// The most memory this process ever had resident; 0 where the system does not report it.
fn peak_rss_bytes() -> u64 {
    if !cfg!(any(target_os = "linux", target_os = "android")) {
        return 0; // other systems have no such file
    }
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
