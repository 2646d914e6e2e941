//! The statistics: the `--json` document and the table for people.

use std::fmt;
use std::path::{Path, PathBuf};

use rara::camera_files::SavedCamera;
use rara::gpu::{DeviceShape, NamedBytes};
use rara::{Counts, FrameStats, Layer, Picture, Plane};
use serde::Serialize;

use super::combine::{Combine, FrameSummary, combine};
use super::near::NearCut;
use super::output::{self, counted, grouped, say};
use super::session::Session;
use super::times;
use super::views::NamedView;
use rara::scene::layers::SceneLayers;
use rara_shots::Seams;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answer {
    Table,
    Document,
    /// A line of JSON for each picture, when it is done.
    Lines,
}

/// The statistics of a command. Its keys are what scripts rely on.
#[derive(Debug, Serialize)]
pub(super) struct RenderReport {
    device: String,
    driver: String,
    shape: ShapeReport,
    scene: SceneReport,
    size: [u32; 2],
    mode: String,
    /// The camera of all pictures, if they have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    camera: Option<SavedCamera>,
    #[serde(flatten)]
    measured: FrameSummary,
    /// What the driver's compilation has added to frames that are not among those measured.
    first_use_ms: f64,
    /// Whether an earlier run has kept it.
    #[serde(skip)]
    has_kept: bool,
    memory: Memory,
    frames: Vec<FrameRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mean: Option<FrameStats>,
    /// Of panoramas, all together.
    #[serde(skip_serializing_if = "Option::is_none")]
    seams: Option<Seams>,
    #[serde(skip)]
    faces: usize,
    #[serde(skip)]
    near: Option<NearCut>,
    /// The pictures of which the clip leaves hardly anything.
    #[serde(skip)]
    faint: Vec<String>,
}

/// One picture, and the frames that measured it.
#[derive(Debug, Clone, Serialize)]
pub(super) struct FrameRecord {
    /// The number of its view or section.
    view: usize,
    name: String,
    /// The path of the picture, if it was written.
    file: Option<String>,
    /// The section's plane, or the one that moves: normal and offset.
    plane: Option<[f64; 4]>,
    camera: SavedCamera,
    /// Of a panorama.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) seams: Option<Seams>,
    #[serde(skip)]
    faces: usize,
    /// True where its clip leaves hardly anything of what is in view.
    #[serde(skip)]
    pub(super) is_faint: bool,
    #[serde(flatten)]
    pub(super) measured: FrameSummary,
}

impl FrameRecord {
    pub(super) fn new(
        view: &NamedView,
        file: Option<&Path>,
        plane: Option<&Plane>,
        measured: FrameSummary,
    ) -> Self {
        let plane = plane.map(|plane| {
            let normal = plane.normal();
            [normal.x, normal.y, normal.z, plane.offset()]
        });
        Self {
            view: view.number,
            name: view.name.clone(),
            file: file.map(|file| file.display().to_string()),
            plane,
            camera: (&view.camera).into(),
            seams: None,
            faces: 1,
            is_faint: false,
            measured,
        }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// One of a picture that is made of several, which took as long as these together.
    pub(super) fn together(view: &NamedView, file: Option<&Path>, faces: &[Self]) -> Self {
        let measured = FrameSummary::together(faces.iter().map(|face| &face.measured));
        Self {
            faces: faces.len(),
            ..Self::new(view, file, None, measured)
        }
    }
}

/// A picture that differs from its background by no more shows hardly anything, of 255.
const FAINT: f32 = 16.0;

/// True for counts of a frame of which the clip leaves hardly any splat whole, so that a look at its picture is worth the time.
pub(super) fn may_be_faint(counts: &Counts) -> bool {
    /// Fewer than this share.
    const FEW: u64 = 100;
    let in_view =
        u64::from(counts.visible) + u64::from(counts.cutoff) + u64::from(counts.invisible);
    counts.drawn > 0 && FEW * u64::from(counts.visible) < in_view
}

/// True for a picture that is its background but for hardly anything.
pub(super) fn is_faint(picture: &Picture, background: Option<[f32; 3]>) -> bool {
    let differs = |[r, g, b, a]: &[f32; 4]| match background {
        None => *a,
        Some(behind) => {
            let channels = [r, g, b].into_iter().zip(behind);
            channels.fold(0.0, |most, (own, behind)| (own - behind).abs().max(most))
        }
    };
    let mut pixels = picture.pixels.iter().map(differs);
    pixels.all(|differs| 255.0 * differs <= FAINT)
}

/// The kind of machine that pipelines were chosen for, and the reason.
#[derive(Debug, Serialize)]
struct ShapeReport {
    #[serde(flatten)]
    shape: DeviceShape,
    reason: &'static str,
}

#[derive(Debug, Serialize)]
pub(super) struct SceneReport {
    gaussians: usize,
    sh_degree: u32,
    repaired: u64,
    dropped: u64,
    /// One for each file, in order.
    layers: Vec<LayerReport>,
    /// True where a layer with Gaussians is shown.
    #[serde(skip)]
    is_shown: bool,
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

impl SceneReport {
    pub(super) fn new(loaded: &SceneLayers) -> Self {
        let scene = loaded.scene();
        let layers = scene.layers().iter();
        let report = |layer: &Layer<'_>| LayerReport {
            name: layer.name().to_owned(),
            gaussians: layer.gaussians().len(),
        };
        Self {
            gaussians: scene.gaussians(),
            sh_degree: scene.sh_degree(),
            repaired: loaded.repaired,
            dropped: loaded.dropped,
            layers: layers.map(report).collect(),
            is_shown: loaded.is_shown(),
        }
    }
}

impl RenderReport {
    /// Warns where nothing is to be seen, or a clip was given that `--mode none` ignores.
    fn warn(&self, clips: bool) {
        if clips && self.mode == "none" {
            say("warning: --mode none clips nothing, whatever --clip says; leave one of them out");
        }
        let counts = self.measured.stats.counts;
        let empty = self.frames.iter().map(|frame| frame.measured.stats.counts);
        let empty = empty.filter(|counts| counts.drawn == 0).count();
        if !self.scene.is_shown {
            return; // which was said when it was read
        }
        // In the middle of several, and in the only one.
        if counts.drawn == 0 && (self.frames.is_empty() || empty == self.frames.len()) {
            let why: String = match (counts.invisible, self.scene.gaussians, &self.near) {
                (_, 0, _) => "the scene has no Gaussians".into(),
                (0, _, Some(near)) => near.why_empty(),
                (0, ..) => "none of the Gaussians is in view; look from elsewhere".into(),
                _ => "the clip leaves nothing of what is in view".into(),
            };
            say(format_args!("warning: the picture is empty: {why}"));
            return;
        }
        if let Some(near) = &self.near {
            say(format_args!("note: {near}"));
        }
        if let Some(first) = self.faint.first() {
            let which = match self.frames.len() {
                0 | 1 => String::new(),
                all => format!(
                    " in {} of {}, as in that of {first}",
                    self.faint.len(),
                    counted(all as u64, "picture")
                ),
            };
            say(format_args!(
                "warning: the clip leaves hardly anything of what is in view{which}: only edges of splats, {FAINT} of 255 at most; \
                 rara info prints the scene's bounds"
            ));
        }
        if empty > 0 && self.mean.is_none() && self.faces == 1 {
            // Behind one who looks at a scene there is nothing, and behind a plane that has crossed it neither.
            let which = self
                .frames
                .iter()
                .find(|f| f.measured.stats.counts.drawn == 0);
            let which = which.map_or("", |frame| &frame.name);
            let are = if empty == 1 { "is" } else { "are" };
            say(format_args!(
                "warning: {empty} of {} {are} empty, as that of {which}",
                counted(self.frames.len() as u64, "picture")
            ));
        }
    }

    /// Prints it, for people with the pictures that were written. `clips` is true where there is a clip.
    pub(super) fn print(
        &self,
        answer: Answer,
        clips: bool,
        written: &[PathBuf],
    ) -> rara::Result<()> {
        self.warn(clips);
        if let Some(seams) = self.seams {
            say(format_args!("note: {seams}"));
        }
        match answer {
            Answer::Document => output::json(self)?,
            Answer::Lines => {}
            Answer::Table => {
                say(self);
                say(wrote(written));
            }
        }
        Ok(())
    }

    /// A report whose top level holds the medians of what each picture took.
    pub(super) fn new(
        session: &Session,
        scene: SceneReport,
        size: (u32, u32),
        mode: String,
        pictures: &[FrameRecord],
    ) -> Self {
        let headless = &session.headless;
        let device = headless.device();
        let scene_bytes = headless.scene_bytes();
        let gaussians = scene.gaussians;
        let measured = FrameSummary::all(pictures.iter().map(|picture| &picture.measured));
        let faces = pictures.first().map_or(1, |picture| picture.faces);
        let seams = pictures.iter().filter_map(|picture| picture.seams);
        let a_frame = measured.stats.wall_ms / faces as f64;
        let faint = pictures.iter().filter(|picture| picture.is_faint);
        let faint = faint.map(|picture| picture.name.clone()).collect();
        Self {
            device: headless.device_name().to_owned(),
            driver: headless.driver().to_owned(),
            shape: ShapeReport {
                shape: device.shape(),
                reason: device.shape_reason(),
            },
            scene,
            size: [size.0, size.1],
            mode,
            camera: pictures
                .first()
                .map(|first| &first.camera)
                .filter(|camera| pictures.iter().all(|picture| picture.camera == **camera))
                .cloned(),
            first_use_ms: session.first_use_ms(a_frame),
            has_kept: session.has_kept(),
            measured,
            memory: Memory {
                device_bytes: headless.device_bytes(),
                scene_bytes,
                scene_bytes_per_gaussian: scene_bytes as f64 / gaussians.max(1) as f64,
                peak_rss_bytes: peak_rss_bytes(),
                purposes: device.memory_by_name(),
            },
            frames: Vec::new(),
            mean: None,
            near: None,
            faint,
            seams: Seams::together(&seams.collect::<Vec<_>>()),
            faces,
        }
    }

    pub(super) fn with_frames(self, frames: Vec<FrameRecord>) -> Self {
        Self { frames, ..self }
    }

    /// With what the near cut takes of the pictures.
    pub(super) fn with_near_cut(self, near: Option<NearCut>) -> Self {
        Self { near, ..self }
    }

    pub(super) fn with_mean(self) -> Self {
        let frames = self.frames.iter().map(|frame| frame.measured.stats.clone());
        Self {
            mean: Some(combine(&frames.collect::<Vec<_>>(), Combine::Mean)),
            ..self
        }
    }
}

impl fmt::Display for RenderReport {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { scene, memory, .. } = self;
        let stats = &self.measured.stats;
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        writeln!(f, "device   {} ({})", self.device, self.driver)?;
        write!(
            f,
            "scene    {}, SH degree {}",
            counted(scene.gaussians as u64, "Gaussian"),
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
        let frames = counted(self.frames.len() as u64, "frame");
        match (self.frames.len(), self.faces) {
            (0, _) => {}
            (_, 1) => write!(f, "; {frames}, medians:")?,
            (all, faces) if all == faces => write!(f, "; {frames} together:")?,
            (_, faces) => write!(f, "; {frames}, medians of {faces} together:")?,
        }
        writeln!(f, "\ncounts   {}", CountsText(&stats.counts))?;
        write!(f, "passes   {}", times::line(stats))?;
        for pass in &stats.statistics {
            write!(
                f,
                "\n  {:<9} {} compute, {} vertex and {} fragment invocations, {}",
                pass.name,
                grouped(pass.compute_invocations),
                grouped(pass.vertex_invocations),
                grouped(pass.fragment_invocations),
                counted(pass.primitives, "primitive")
            )?;
        }
        if let Some(compiled) = output::compiled(self.first_use_ms, self.has_kept) {
            write!(f, "\n{compiled}")?;
        }
        let [device, all] = [stats.gpu_ms, Some(stats.wall_ms)].map(|time| times::ms(time, 2));
        write!(f, "\ntime     {device} ms on the device, {all} ms in all")?;
        match self.measured.samples {
            one if one == self.faces => writeln!(f)?,
            samples => {
                let what = if self.faces == 1 { "frame" } else { "picture" };
                let samples = counted((samples / self.faces) as u64, what);
                writeln!(f, " (the median of {samples})")?;
            }
        }
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

struct CountsText<'a>(&'a Counts);

impl fmt::Display for CountsText<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Counts {
            visible,
            cutoff,
            invisible,
            culled,
            drawn,
            shortened,
        } = *self.0;
        let [visible, cutoff, invisible, culled, drawn] =
            [visible, cutoff, invisible, culled, drawn].map(|count| grouped(count.into()));
        write!(
            f,
            "{visible} visible, {cutoff} cutoff, {invisible} invisible, {culled} culled; {drawn} drawn"
        )?;
        match shortened {
            0 => Ok(()),
            _ => write!(
                f,
                "; {} weighed by fewer surfaces than cut them",
                grouped(shortened.into())
            ),
        }
    }
}

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
