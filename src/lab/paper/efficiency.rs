//! The paper's first table: how many frames a second each mode draws while one plane moves across the whole scene and the
//! camera stands still.

use rara::scene::extent_along;
use rara::{Clip, ClipOp, FrameStats, Headless, Mode, Plane, Result, Scene, Settings};
use serde::{Deserialize, Serialize};

use crate::cases::Case;
use crate::frames::in_turn;
use crate::statistics::{median, quartiles};
use crate::table::{Cell, Table};

/// What the paper has for each mode, frames a second of its own renderer on its own GPU: Original, Hard, RaRa.
const PAPER: [(&str, [f64; 3]); 2] = [
    ("paper: 360garden, 4 M", [77.82, 81.49, 81.47]),
    ("paper: Hair, 3 M", [128.02, 146.88, 145.46]),
];

const MODES: [(&str, Mode); 4] = [
    ("Original", Mode::None),
    ("Hard", Mode::Hard),
    ("RaRa", Mode::Rara),
    ("Exact", Mode::Exact),
];

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct EfficiencyRow {
    /// The paper's name of the mode.
    pub mode: String,
    /// True if frames reuse what a moving plane does not change.
    pub reuse: bool,
    /// The time of a frame from recording to the picture, over all frames of all sweeps, milliseconds: lower quartile, median and
    /// upper quartile.
    pub ms: [f64; 3],
    /// The medians of the stages over the same frames, milliseconds.
    pub passes: Vec<(String, f64)>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Efficiency {
    pub scene: String,
    pub gaussians: usize,
    pub size: [u32; 2],
    pub frames: u32,
    /// Modes computed anew, then those that reuse.
    pub rows: Vec<EfficiencyRow>,
}

impl EfficiencyRow {
    /// The mode's row of the frames of all sweeps.
    fn new(mode: &str, reuse: bool, frames: &[FrameStats]) -> Self {
        let wall: Vec<_> = frames.iter().map(|frame| frame.wall_ms).collect();
        let stages = frames.iter().flat_map(|frame| &frame.passes);
        let mut names: Vec<_> = Vec::new();
        for stage in stages {
            if !names.contains(&stage.name) {
                names.push(stage.name);
            }
        }
        // A stage that a frame did not run took no time there.
        let of_stage = |name: &'static str| {
            let ms = frames.iter().map(|frame| {
                let stage = frame.passes.iter().find(|stage| stage.name == name);
                stage.map_or(0.0, |stage| stage.ms)
            });
            let ms: Vec<_> = ms.collect();
            (name.to_owned(), median(&ms).unwrap_or(0.0))
        };
        Self {
            mode: mode.into(),
            reuse,
            ms: quartiles(&wall).unwrap_or_default(),
            passes: names.into_iter().map(of_stage).collect(),
        }
    }
}

/// Measures `frames` frames in each mode, `repeats` times in turn. The device holds the scene.
pub fn efficiency(
    headless: &mut Headless,
    (name, scene): (&str, &Scene<'_>),
    case: &Case,
    frames: u32,
    repeats: u32,
) -> Result<Efficiency> {
    let normal = case.direction();
    let (low, high) = extent_along(scene, normal);
    let clip = |frame: u32| {
        let along = low + (high - low) * (f64::from(frame) + 0.5) / f64::from(frames);
        Ok(Clip::of([Plane::new(normal, -along)?], ClipOp::And))
    };
    let clips = (0..frames).map(clip).collect::<Result<Vec<_>>>()?;
    let mut rows = Vec::new();
    for reuse in [false, true] {
        let modes = &MODES[usize::from(reuse)..]; // the original has nothing to compute when nothing moves
        let sweeps = in_turn(repeats..=repeats, modes.len(), |index, _| {
            sweep(headless, case, &clips, modes[index].1, reuse)
        })?;
        let of = |((name, _), sweeps): (&(&str, Mode), Vec<Vec<FrameStats>>)| {
            EfficiencyRow::new(name, reuse, &sweeps.concat())
        };
        rows.extend(modes.iter().zip(sweeps).map(of));
    }
    Ok(Efficiency {
        scene: name.into(),
        gaussians: scene.gaussians(),
        size: [case.camera.width, case.camera.height],
        frames,
        rows,
    })
}

fn sweep(
    headless: &mut Headless,
    case: &Case,
    clips: &[Clip],
    mode: Mode,
    reuse: bool,
) -> Result<Vec<FrameStats>> {
    let settings = Settings::default().mode(mode);
    headless.forget();
    let frame = |clip| {
        if !reuse {
            headless.forget();
        }
        headless.render(&case.camera, clip, &settings)
    };
    clips.iter().map(frame).collect()
}

/// The paper's table and ours: frames a second, and their ratio to Original.
pub fn table(all: &[Efficiency]) -> Table {
    let note = "One plane moves across the whole scene while the camera stands still. A frame's time is from \
        recording to the picture; ms: its median over all frames of all sweeps, between the quartiles. Frames per second are a \
        second over that median, and the ratio is to those of Original, computed anew. The paper's figures are of its own \
        renderer on an RTX 4090, averaged over the frames.";
    let columns = [
        "scene",
        "Gaussians",
        "mode",
        "frames",
        "fps",
        "/ Original",
        "lower quartile, ms",
        "median ms",
        "upper quartile, ms",
    ];
    let mut table = Table::new("Render efficiency (the paper's first table)", note, columns);
    for (scene, rates) in PAPER {
        for ((mode, _), rate) in MODES.iter().zip(rates) {
            table.row([
                scene.into(),
                "".into(),
                (*mode).into(),
                "anew".into(),
                rate.into(),
                (rate / rates[0]).into(),
                None.into(),
                None.into(),
                None.into(),
            ]);
        }
    }
    for one in all {
        let fps = |row: &EfficiencyRow| 1e3 / row.ms[1];
        let original = one.rows.first().map_or(f64::NAN, fps);
        for row in &one.rows {
            let [lower, median, upper] = row.ms.map(Cell::from);
            table.row([
                one.scene.as_str().into(),
                one.gaussians.to_string().into(),
                row.mode.as_str().into(),
                if row.reuse { "reuse" } else { "anew" }.into(),
                fps(row).into(),
                (fps(row) / original).into(),
                lower,
                median,
                upper,
            ]);
        }
    }
    table
}

pub fn stages(all: &[Efficiency]) -> Table {
    let columns = ["scene", "mode", "frames"];
    let table = Table::new(
        "Stages of these frames",
        "Medians over the same frames, milliseconds.",
        columns,
    );
    let rows = all
        .iter()
        .flat_map(|one| one.rows.iter().map(move |row| (one, row)));
    table.pivot(rows.map(|(one, row)| {
        let frames = if row.reuse { "reuse" } else { "anew" };
        let first = [one.scene.as_str(), row.mode.as_str(), frames];
        let passes = row.passes.iter().map(|(name, ms)| (name.as_str(), *ms));
        (first.map(Cell::from).into(), passes.collect())
    }))
}

#[cfg(test)]
mod tests;
