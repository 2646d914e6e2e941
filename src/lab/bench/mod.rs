//! What each mode and each choice of precision costs and how far its picture is from the exact cut.

mod clock;
mod judge;
mod shapes;
mod tables;
mod variants;
mod ways;

use rara::{Camera, Clip, Headless, Plane, Result, Scene, Settings};
use serde::Serialize;

use crate::charts::{Axis, Scatter, Series};
use crate::measure::undominated;
use crate::table::Table;
use clock::Times;
pub(crate) use clock::time;
pub(crate) use judge::truth_settings;
use judge::{Judge, Measures};
pub use variants::names;

/// How much is measured.
#[derive(Debug, Clone)]
pub struct Options {
    /// Frames of each choice, one of each in turn.
    pub frames: u32,
    /// Steps of the slow sweep that popping is measured over, each a 300th of the scene.
    pub steps: u32,
    /// The names of the choices; all if empty.
    pub only: Vec<String>,
    /// A plane beside which shapes through the same point are measured.
    pub shapes: Option<Plane>,
}

/// Everything that was measured.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The names of the layers.
    pub(crate) scene: String,
    /// How many Gaussians the scene has.
    pub(crate) gaussians: usize,
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    /// What drew.
    pub(crate) device: String,
    /// And its driver.
    pub(crate) driver: String,
    /// As in [`Options::frames`].
    pub(crate) frames: u32,
    /// As in [`Options::steps`].
    pub(crate) steps: u32,
    /// Share of the picture in which the way of cutting makes a difference: where the hard and the exact truth differ,
    /// and 5 px around.
    pub(crate) band_share: f64,
    /// A row for each choice.
    pub(crate) rows: Vec<Row>,
    /// The ways of cutting at two sizes.
    pub(crate) ways: Vec<ways::Line>,
    /// Shapes, if they were asked for.
    pub(crate) shapes: Vec<shapes::Line>,
    /// Choices whose pictures are wrong, and why.
    pub refused: Vec<String>,
}

/// The measurements of one choice.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    /// Its name.
    pub(crate) name: &'static str,
    /// The flags that choose it.
    pub(crate) flags: &'static str,
    /// Its errors.
    #[serde(flatten)]
    pub(crate) measures: Measures,
    /// Its times.
    #[serde(flatten)]
    pub(crate) times: Times,
    /// True when no other choice is both faster and nearer to the truth.
    pub(crate) undominated: bool,
}

/// Measures the choices on a scene. What is not within its own bound of its own picture in double precision is not timed.
/// `progress` hears how many of how many steps are done.
///
/// # Errors
/// If a frame cannot be drawn.
pub fn bench(
    headless: &mut Headless,
    (scene, camera, clip): (&Scene<'_>, &Camera, &Clip),
    look: &Settings,
    options: &Options,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Report> {
    let mut all = variants::variants(*look);
    all.retain(|v| options.only.is_empty() || options.only.iter().any(|name| name == v.name));
    let total = all.len() as u64 + 2;

    // First which pictures are right and how far each is from the truth; then what they cost.
    let judge = Judge::new(scene, camera, clip, look, options.steps)?;
    let (mut right, mut measured, mut refused) = (Vec::new(), Vec::new(), Vec::new());
    for (done, variant) in all.into_iter().enumerate() {
        progress(done as u64, total);
        headless.load_as(scene, variant.settings.precision.sh)?;
        let measures = judge.measure(headless, &variant.settings)?;
        let least = variant.settings.precision.least_psnr();
        if measures.twin_psnr >= least {
            right.push(variant);
            measured.push(measures);
        } else {
            refused.push(format!(
                "{} ({}): {:.1} dB against its own picture in double precision, where {least} is the least",
                variant.name, variant.flags, measures.twin_psnr
            ));
        }
    }
    progress(total - 1, total);
    let named: Vec<_> = right.iter().map(|v| v.name).zip(&measured).collect();
    let ways = ways::lines(headless, scene, (camera, clip), look, options.steps, &named)?;
    let settings: Vec<_> = right.iter().map(|v| (clip, v.settings)).collect();
    let times = clock::time(headless, scene, camera, &settings, options.frames)?;
    let shapes = match options.shapes {
        Some(plane) => shapes::lines(headless, scene, camera, plane, look, options.frames)?,
        None => Vec::new(),
    };

    let rows = right.iter().zip(measured).zip(times);
    let mut rows: Vec<Row> = rows
        .map(|((variant, measures), times)| Row {
            name: variant.name,
            flags: variant.flags,
            measures,
            times,
            undominated: false,
        })
        .collect();
    // Mode `none` is left out, since it is no way of cutting.
    let point = |row: &Row| match row.name {
        "none" => [f64::NAN; 2],
        _ => [row.times.cost, row.measures.l1],
    };
    let points: Vec<_> = rows.iter().map(point).collect();
    for index in undominated(&points) {
        rows[index].undominated = true;
    }
    let names: Vec<_> = scene.layers().iter().map(|layer| layer.name()).collect();
    Ok(Report {
        scene: names.join(" + "),
        gaussians: scene.gaussians(),
        size: [camera.width, camera.height],
        device: headless.device_name().to_owned(),
        driver: headless.driver().to_owned(),
        frames: options.frames,
        steps: options.steps,
        band_share: judge.band_share(),
        rows,
        ways,
        shapes,
        refused,
    })
}

impl Report {
    /// As tables, that of the choices first.
    pub fn tables(&self) -> Vec<Table> {
        tables::tables(self)
    }

    /// Cost against error, with the front of what nothing beats.
    pub fn chart(&self) -> Scatter {
        let of = |kind: Kind| {
            let rows = self.rows.iter();
            let rows = rows.filter(move |row| row.name != "none" && Kind::of(row.name) == kind);
            rows.map(|row| (row.times.cost, row.measures.l1, row.name))
        };
        let kinds = [Kind::Way, Kind::Law, Kind::Precision];
        let series = kinds.map(|kind| Series::labelled(kind.name(), of(kind)));
        let front = self.rows.iter().filter(|row| row.undominated);
        Scatter {
            title: format!("{}: run time against error", self.scene),
            x: Axis::log("Cost (ms per frame)"),
            y: Axis::log("L1 against the truth (of 255)"),
            series: series.into(),
            front: front.map(|row| [row.times.cost, row.measures.l1]).collect(),
        }
    }

    /// The tables, and what was not timed.
    pub fn markdown(&self) -> String {
        let tables: Vec<_> = self.tables().iter().map(Table::markdown).collect();
        let refused = self.refused.iter();
        let refused =
            refused.map(|why| format!("\nNot timed, because its picture is wrong: {why}\n"));
        tables.join("\n") + &refused.collect::<String>()
    }
}

/// What a choice chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// How splats are cut.
    Way,
    /// How a weight changes opacity, and in which form it is computed.
    Law,
    /// How precisely everything is computed.
    Precision,
}

impl Kind {
    fn of(name: &str) -> Self {
        match name {
            "hard" | "rara, paper" | "rara, released" | "rara" | "exact" => Self::Way,
            _ if name.contains("law") || name.contains("affine") => Self::Law,
            _ => Self::Precision,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Way => "ways of cutting",
            Self::Law => "laws and forms",
            Self::Precision => "precision",
        }
    }
}
