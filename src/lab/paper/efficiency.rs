//! The paper's first table: how many frames a second each mode draws while one plane moves across the whole scene and the
//! camera stands still.

use std::time::Instant;

use rara::scene::extent_along;
use rara::{Clip, ClipOp, Headless, Mode, Plane, Result, Scene, Settings};
use serde::{Deserialize, Serialize};

use crate::cases::Case;
use crate::frames::in_turn;
use crate::statistics::{least, mean, median, standard_deviation};
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
    /// Frames a second: the number of frames over their time from recording to the picture, the median of the sweeps.
    pub fps: f64,
    /// Each frame's least time of the sweeps, milliseconds: their mean over the frames, their median and their standard
    /// deviation.
    pub ms: [f64; 3],
    /// The stages, milliseconds a frame.
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

/// The times of the frames of one sweep, and of their stages.
#[derive(Default, Clone)]
struct SweepTimes {
    wall: Vec<f64>,
    passes: Vec<(String, f64)>,
    seconds: f64,
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
        let of = |((name, _), sweeps): (&(&str, Mode), Vec<SweepTimes>)| row(name, reuse, &sweeps);
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
) -> Result<SweepTimes> {
    let settings = Settings::default().mode(mode);
    let mut sweep = SweepTimes::default();
    headless.forget();
    let begin = Instant::now();
    for clip in clips {
        if !reuse {
            headless.forget();
        }
        let stats = headless.render(&case.camera, clip, &settings)?;
        sweep.wall.push(stats.wall_ms);
        for pass in &stats.passes {
            match sweep.passes.iter_mut().find(|(name, _)| name == pass.name) {
                Some((_, ms)) => *ms += pass.ms,
                None => sweep.passes.push((pass.name.into(), pass.ms)),
            }
        }
    }
    sweep.seconds = begin.elapsed().as_secs_f64();
    Ok(sweep)
}

fn row(mode: &str, reuse: bool, sweeps: &[SweepTimes]) -> EfficiencyRow {
    let frames = sweeps.first().map_or(0, |sweep| sweep.wall.len());
    let of_frame = |frame: usize| sweeps.iter().map(|s| s.wall[frame]).collect::<Vec<_>>();
    let least: Vec<f64> = (0..frames).map(|frame| least(&of_frame(frame))).collect();
    let rates: Vec<f64> = sweeps.iter().map(|s| frames as f64 / s.seconds).collect();
    let nothing = |value: Option<f64>| value.unwrap_or(0.0);
    let names = sweeps.first().into_iter().flat_map(|sweep| &sweep.passes);
    let of_all = |name: &String| -> Vec<f64> {
        let passes = sweeps.iter().flat_map(|sweep| &sweep.passes);
        passes
            .filter(|(n, _)| n == name)
            .map(|(_, ms)| ms / frames as f64)
            .collect()
    };
    EfficiencyRow {
        mode: mode.into(),
        reuse,
        fps: nothing(median(&rates)),
        ms: [mean(&least), median(&least), standard_deviation(&least)].map(nothing),
        passes: names
            .map(|(name, _)| (name.clone(), nothing(median(&of_all(name)))))
            .collect(),
    }
}

/// The paper's table and ours: frames a second, and their ratio to Original.
pub fn table(all: &[Efficiency]) -> Table {
    let note = "One plane moves across the whole scene while the camera stands still. Frames per second are averaged over the \
        frames, from recording to the picture; ms: each frame's least time of the sweeps, mean, median and standard deviation \
        over the frames. The ratio is that of the frames per second to those of Original, computed anew. The paper's figures \
        are of its own renderer on an RTX 4090.";
    let columns = [
        "scene",
        "Gaussians",
        "mode",
        "frames",
        "fps",
        "/ Original",
        "mean ms",
        "median ms",
        "deviation",
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
        let original = one.rows.first().map_or(f64::NAN, |row| row.fps);
        for row in &one.rows {
            let [mean, median, deviation] = row.ms.map(Cell::from);
            table.row([
                one.scene.as_str().into(),
                one.gaussians.to_string().into(),
                row.mode.as_str().into(),
                if row.reuse { "reuse" } else { "anew" }.into(),
                row.fps.into(),
                (row.fps / original).into(),
                mean,
                median,
                deviation,
            ]);
        }
    }
    table
}

pub fn stages(all: &[Efficiency]) -> Table {
    let columns = ["scene", "mode", "frames"];
    let table = Table::new("Stages of these frames", "Milliseconds per frame.", columns);
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
