//! The paper's experiments, reproduced and extended, on any scenes.

pub mod ablation;
pub mod efficiency;
mod perception;
mod qualities;
mod report;
mod series;
mod store;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use glam::DVec3;
use rara::{Clip, Error, Headless, Picture, Result, Settings};
use serde::{Deserialize, Serialize};

use crate::bench::{self, Options as BenchOptions};
use crate::cases::{Case, Cut, Source, cases};
use crate::charts::Scatter;
use crate::maps;
use crate::table::Table;
use efficiency::Efficiency;
use perception::{Outcome, Pictures, ways};
use series::{Property, Series};
pub use store::Progress;
use store::Store;

/// How much is measured.
#[derive(Debug, Clone, Hash, Serialize)]
pub struct Options {
    /// Width and height of the pictures that are timed, pixels.
    pub size: u32,
    /// Width and height of the pictures of the cases, pixels.
    pub case_size: u32,
    /// Frames of the moving plane, as in the paper.
    pub frames: u32,
    /// Sweeps of each mode, and frames of each choice.
    pub repeats: u32,
    /// Steps of the slow sweep of each case.
    pub steps: u32,
    /// The scenes that are timed, by their numbers.
    pub timed: Vec<usize>,
    /// Gaussians of the scenes in which one property varies.
    pub count: usize,
    /// True for all choices of precision; only the ways of cutting and the presets otherwise.
    pub all_choices: bool,
}

impl Options {
    /// A few minutes on two cores, on generated scenes of 6 000 Gaussians.
    pub fn quick() -> Self {
        Self {
            size: 256,
            case_size: 160,
            frames: 30,
            repeats: 3,
            steps: 120,
            timed: vec![0, 3, 6],
            count: 10_000,
            all_choices: false,
        }
    }

    /// The better part of an hour on two cores, on scans of 100 000 Gaussians.
    pub fn thorough() -> Self {
        Self {
            size: 512,
            case_size: 256,
            repeats: 5,
            count: 100_000,
            all_choices: true,
            ..Self::quick()
        }
    }
}

/// The choices of a scene: cost against error.
#[derive(Debug, Serialize, Deserialize)]
struct Choices {
    tables: Vec<Table>,
    chart: String,
    refused: Vec<String>,
}

/// The pictures of one case, as files below the report's folder.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Maps {
    case: String,
    /// The truth, then each way: its name, picture, map of errors, and the worst piece of both, magnified. The truth has no
    /// map.
    pictures: Vec<(String, [Option<String>; 4])>,
}

/// Everything that was measured.
#[derive(Debug, Serialize)]
struct Results {
    version: &'static str,
    device: String,
    driver: String,
    options: Options,
    scenes: Vec<(String, usize)>,
    seconds: f64,
    efficiency: Vec<Efficiency>,
    ablation: Vec<(String, Vec<ablation::Row>)>,
    outcomes: Vec<Outcome>,
    maps: Vec<Maps>,
    choices: Vec<(String, Choices)>,
    series: Vec<Series>,
}

/// Runs every experiment on the scenes and writes the report into a folder: `index.html`, `report.md`, `results.json`, a
/// `.csv` for each table, and the pictures. What an earlier run into the same folder has measured of the same scenes, with
/// the same options on the same device, is not measured again.
///
/// # Errors
/// If a frame cannot be drawn or a file cannot be written.
pub fn run(
    headless: &mut Headless,
    sources: &[Source],
    options: &Options,
    folder: &Path,
    progress: &mut dyn FnMut(&Progress),
) -> Result<()> {
    let size = (options.case_size, options.case_size);
    let all = cases(sources, DVec3::NEG_Y, size)?;
    let name = |case: &Case| format!("{}, {}", sources[case.scene].name, case.cut.name());
    let timed: Vec<usize> = options
        .timed
        .iter()
        .copied()
        .filter(|&s| s < sources.len())
        .collect();

    // Work in frames of a Gaussian; the truth takes about as long as four frames.
    let work = |source: &Source, frames: f64| frames * (source.gaussians.len() as f64 + 2e4);
    let mut plan: Vec<(String, f64)> = Vec::new();
    for &scene in &timed {
        let frames = f64::from(7 * options.frames * (options.repeats + 1));
        plan.push((
            format!("efficiency: {}", sources[scene].name),
            work(&sources[scene], frames),
        ));
        plan.push((
            format!("ablation: {}", sources[scene].name),
            work(&sources[scene], 10.0),
        ));
        let choices = if options.all_choices { 27.0 } else { 8.0 };
        let frames = choices * (f64::from(options.repeats) + 20.0);
        plan.push((
            format!("choices: {}", sources[scene].name),
            work(&sources[scene], frames),
        ));
    }
    for case in &all {
        let frames = f64::from(options.steps) * 8.0;
        plan.push((
            format!("case: {}", name(case)),
            work(&sources[case.scene], frames),
        ));
    }
    for property in Property::ALL {
        plan.push((
            format!("by {}", property.name()),
            300.0 * (options.count as f64 + 2e4),
        ));
    }

    let mut store = Store::new(folder, origin(headless, sources, options), plan, progress)?;
    let mut results = Results {
        version: env!("CARGO_PKG_VERSION"),
        device: headless.device_name().to_owned(),
        driver: headless.driver().to_owned(),
        options: options.clone(),
        scenes: sources
            .iter()
            .map(|s| (s.name.clone(), s.gaussians.len()))
            .collect(),
        seconds: 0.0,
        efficiency: Vec::new(),
        ablation: Vec::new(),
        outcomes: Vec::new(),
        maps: Vec::new(),
        choices: Vec::new(),
        series: Vec::new(),
    };
    let look = Settings::default();
    let of_timed = cases(sources, DVec3::NEG_Y, (options.size, options.size))?;
    for &number in &timed {
        let (source, scene) = (&sources[number], sources[number].scene());
        let case = of_timed
            .iter()
            .find(|c| c.scene == number && c.cut == Cut::Face);
        let case = case.expect("each scene is cut in each way");
        results
            .efficiency
            .push(store.part(&format!("efficiency: {}", source.name), || {
                headless.load(&scene)?;
                let (frames, repeats) = (options.frames, options.repeats);
                efficiency::efficiency(headless, (&source.name, &scene), case, frames, repeats)
            })?);
        let rows = store.part(&format!("ablation: {}", source.name), || {
            headless.load(&scene)?;
            ablation::ablation(headless, &scene, &case.camera, &look)
        })?;
        results.ablation.push((source.name.clone(), rows));
        let choices = store.part(&format!("choices: {}", source.name), || {
            choices(headless, (&scene, case), options)
        })?;
        results.choices.push((source.name.clone(), choices));
    }
    for case in &all {
        let scene = sources[case.scene].scene();
        let (outcome, maps) = store.part(&format!("case: {}", name(case)), || {
            headless.load(&scene)?;
            let mut maps = None;
            let keep = |pictures: &Pictures| {
                maps = Some(write_maps(folder, &name(case), pictures)?);
                Ok(())
            };
            let case = (&scene, case);
            let outcome = perception::measure(headless, name(case.1), case, options.steps, keep)?;
            Ok((outcome, maps))
        })?;
        results.outcomes.push(outcome);
        results.maps.extend(maps);
    }
    for property in Property::ALL {
        results
            .series
            .push(store.part(&format!("by {}", property.name()), || {
                let (count, size, repeats) = (options.count, options.size, options.repeats);
                series::series(headless, property, (count, size, repeats))
            })?);
    }
    results.seconds = store.seconds;
    report::write(folder, &results)
}

fn choices(
    headless: &mut Headless,
    (scene, case): (&rara::Scene<'_>, &Case),
    options: &Options,
) -> Result<Choices> {
    let only = [
        "none",
        "hard",
        "rara, paper",
        "rara",
        "exact",
        "preset fast",
        "preset exact",
    ];
    let options = BenchOptions {
        frames: options.repeats,
        steps: 6,
        only: if options.all_choices {
            Vec::new()
        } else {
            only.map(String::from).into()
        },
        shapes: case.at(0.5)?.surfaces[0].as_plane(),
    };
    let clip: Clip = case.at(0.5)?;
    let look = Settings::default();
    let frame = (scene, &case.camera, &clip);
    let report = bench::bench(headless, frame, &look, &options, &mut |_, _| ())?;
    let chart: Scatter = report.chart();
    Ok(Choices {
        tables: report.tables(),
        chart: chart.svg(),
        refused: report.refused,
    })
}

/// Pixels of the piece that is magnified, and how much.
const PIECE: (u32, u32) = (40, 4);

/// Writes the pictures of a case and its maps of errors.
fn write_maps(folder: &Path, case: &str, pictures: &Pictures) -> Result<Maps> {
    let plain = |text: &str| text.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let folder_of_maps = folder.join("maps");
    std::fs::create_dir_all(&folder_of_maps)
        .map_err(|error| Error::Invalid(format!("{}: {error}", folder_of_maps.display())))?;
    let save = |picture: &Picture, way: &str, what: &str| {
        let name = format!("maps/{}-{}{what}.png", plain(case), plain(way));
        picture.save(folder.join(&name))?;
        Ok::<_, Error>(Some(name))
    };
    // The worst piece of hard is where all are looked at.
    let at = maps::worst_square(&pictures.ways[0], &pictures.truth, PIECE.0)?;
    let piece = |picture: &Picture| maps::magnified(picture, at, PIECE.0, PIECE.1);
    let truth = &pictures.truth;
    let mut all = vec![(
        "truth".to_owned(),
        [
            save(truth, "truth", "")?,
            None,
            save(&piece(truth), "truth", "-piece")?,
            None,
        ],
    )];
    for ((way, _), picture) in ways().iter().zip(&pictures.ways) {
        let map = maps::error_map(picture, truth)?;
        all.push((
            (*way).to_owned(),
            [
                save(picture, way, "")?,
                save(&map, way, "-map")?,
                save(&piece(picture), way, "-piece")?,
                save(&piece(&map), way, "-map-piece")?,
            ],
        ));
    }
    Ok(Maps {
        case: case.into(),
        pictures: all,
    })
}

/// What every result depends on.
fn origin(headless: &Headless, sources: &[Source], options: &Options) -> String {
    let mut hasher = DefaultHasher::new();
    for source in sources {
        source.name.hash(&mut hasher);
        for (position, scales) in source
            .gaussians
            .positions()
            .iter()
            .zip(source.gaussians.scales())
        {
            position.to_array().map(f32::to_bits).hash(&mut hasher);
            scales.to_array().map(f32::to_bits).hash(&mut hasher);
        }
    }
    options.hash(&mut hasher);
    let (device, driver) = (headless.device_name(), headless.driver());
    format!(
        "{} {device} {driver} {:016x}",
        env!("CARGO_PKG_VERSION"),
        hasher.finish()
    )
}
