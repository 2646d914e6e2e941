//! The paper's experiments, reproduced and extended, on any scenes.

pub mod ablation;
pub mod efficiency;
mod perception;
mod qualities;
mod report;
mod results;
mod series;
mod store;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use glam::DVec3;
use rara::{Error, Headless, Picture, Result, Scene, Settings};

use crate::bench::{self, BenchOptions, ways};
use crate::cases::{Case, CaseCut, Source, cases, different, plain};
use perception::Pictures;
use rara_reference::maps;
pub use results::PaperOptions;
use results::{Choices, Maps, Results};
use series::Property;
pub use store::PaperProgress;
use store::Store;

/// A part of the experiments, which is measured in one go and kept.
enum Section<'a> {
    Efficiency(&'a Source, &'a Case),
    Ablation(&'a Source, &'a Case),
    Choices(&'a Source, &'a Case),
    Case(&'a Source, &'a Case),
    Series(Property),
}

impl Section<'_> {
    fn name(&self) -> String {
        match self {
            Self::Efficiency(source, _) => format!("efficiency: {}", source.name),
            Self::Ablation(source, _) => format!("ablation: {}", source.name),
            Self::Choices(source, _) => format!("choices: {}", source.name),
            Self::Case(source, case) => format!("case: {}", case_name(source, case)),
            Self::Series(property) => format!("by {}", property.name()),
        }
    }

    /// An estimate of the work, in frames of a Gaussian; the truth takes about as long as four frames.
    fn work(&self, options: &PaperOptions) -> f64 {
        let repeats = f64::from(options.repeats);
        let (gaussians, frames) = match self {
            Self::Efficiency(source, _) => {
                let frames = 7.0 * f64::from(options.frames) * (repeats + 1.0);
                (source.gaussians.len(), frames)
            }
            Self::Ablation(source, _) => (source.gaussians.len(), 10.0),
            Self::Choices(source, _) => {
                let choices = if options.all_choices { 27.0 } else { 8.0 };
                (source.gaussians.len(), choices * (repeats + 20.0))
            }
            Self::Case(source, _) => (source.gaussians.len(), 8.0 * f64::from(options.steps)),
            Self::Series(_) => (options.count, 300.0),
        };
        frames * (gaussians as f64 + 2e4)
    }
}

fn case_name(source: &Source, case: &Case) -> String {
    format!("{}, {}", source.name, case.cut.name())
}

/// Runs every experiment on the scenes and writes the report into a folder: `index.html`, `report.md`, `results.json`, a
/// `.csv` for each table, and the pictures. What an earlier run into the same folder has measured of the same scenes, with
/// the same options, program and device, is not measured again. Scenes of one name
/// get numbers.
pub fn run(
    headless: &mut Headless,
    mut sources: Vec<Source>,
    options: &PaperOptions,
    folder: &Path,
    progress: &mut dyn FnMut(&PaperProgress),
) -> Result<()> {
    let names = different(sources.iter().map(|source| source.name.clone()));
    (sources.iter_mut().zip(names)).for_each(|(source, name)| source.name = name);
    let sources = &sources[..];
    let of_size = |size: u32| cases(sources, DVec3::NEG_Y, (size, size));
    let (timed, all) = (of_size(options.size)?, of_size(options.case_size)?);
    let mut parts = Vec::new();
    for case in timed
        .iter()
        .filter(|case| case.cut == CaseCut::Face && options.timed.contains(&case.scene))
    {
        let source = &sources[case.scene];
        parts.push(Section::Efficiency(source, case));
        parts.push(Section::Ablation(source, case));
        parts.push(Section::Choices(source, case));
    }
    parts.extend(
        all.iter()
            .map(|case| Section::Case(&sources[case.scene], case)),
    );
    parts.extend(Property::ALL.map(Section::Series));

    let plan = parts.iter().map(|part| (part.name(), part.work(options)));
    let mut store = Store::new(
        folder,
        origin(headless, sources, options),
        plan.collect(),
        progress,
    )?;
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
    let (frames, repeats) = (options.frames, options.repeats);
    for part in &parts {
        match *part {
            Section::Efficiency(source, case) => results.efficiency.push(store.part(|| {
                let scene = loaded(headless, source)?;
                efficiency::efficiency(headless, (&source.name, &scene), case, frames, repeats)
            })?),
            Section::Ablation(source, case) => {
                let rows = store.part(|| {
                    let scene = loaded(headless, source)?;
                    ablation::ablation(headless, &scene, &case.camera, &Settings::default())
                })?;
                results.ablation.push((source.name.clone(), rows));
            }
            Section::Choices(source, case) => {
                let choices = store.part(|| choices(headless, (&source.scene(), case), options))?;
                results.choices.push((source.name.clone(), choices));
            }
            Section::Case(source, case) => {
                let (outcome, maps) = store.part(|| {
                    let scene = loaded(headless, source)?;
                    let name = case_name(source, case);
                    let (outcome, pictures) =
                        perception::measure(headless, name.clone(), (&scene, case), options.steps)?;
                    Ok((outcome, write_maps(folder, &name, &pictures)?))
                })?;
                results.outcomes.push(outcome);
                results.maps.push(maps);
            }
            Section::Series(property) => results.series.push(store.part(|| {
                series::series(headless, property, (options.count, options.size, repeats))
            })?),
        }
    }
    results.seconds = store.seconds;
    report::write(folder, &results)
}

fn loaded<'a>(headless: &mut Headless, source: &'a Source) -> Result<Scene<'a>> {
    let scene = source.scene();
    headless.load(&scene)?;
    Ok(scene)
}

fn choices(
    headless: &mut Headless,
    (scene, case): (&Scene<'_>, &Case),
    options: &PaperOptions,
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
    let clip = case.at(0.5)?;
    let options = BenchOptions {
        frames: options.repeats,
        steps: 6,
        only: if options.all_choices {
            Vec::new()
        } else {
            only.map(String::from).into()
        },
        shapes: clip.surfaces[0].as_plane(),
    };
    let look = Settings::default();
    let frame = (scene, &case.camera, &clip);
    let report = bench::bench(headless, frame, &look, &options, &mut |_, _| ())?;
    Ok(Choices {
        tables: report.tables(),
        chart: report.chart().svg(),
        refused: report.refused,
    })
}

/// Pixels of the piece that is magnified, and how much.
const PIECE: (u32, u32) = (40, 4);

/// Writes the pictures of a case and its maps of errors.
fn write_maps(folder: &Path, case: &str, pictures: &Pictures) -> Result<Maps> {
    let folder_of_maps = folder.join("maps");
    std::fs::create_dir_all(&folder_of_maps).map_err(Error::io(&folder_of_maps))?;
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
    for ((way, _), picture) in ways(Settings::default()).iter().zip(&pictures.ways) {
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

/// What every result depends on: the program, the device, the scenes and the options.
fn origin(headless: &Headless, sources: &[Source], options: &PaperOptions) -> String {
    let mut hasher = DefaultHasher::new();
    for source in sources {
        source.name.hash(&mut hasher);
        let g = &source.gaussians;
        let bits = |value: &f32| value.to_bits();
        let vectors = g
            .positions()
            .iter()
            .chain(g.scales())
            .flat_map(|v| v.to_array());
        let rotations = g.rotations().iter().flat_map(|q| q.to_array());
        let numbers = vectors.chain(rotations);
        numbers.for_each(|value| bits(&value).hash(&mut hasher));
        g.opacities()
            .iter()
            .chain(g.sh())
            .for_each(|value| bits(value).hash(&mut hasher));
    }
    options.hash(&mut hasher);
    // Another build of the program may draw another picture.
    let built = std::env::current_exe().and_then(|program| program.metadata()?.modified());
    built.ok().hash(&mut hasher);
    let (device, driver) = (headless.device_name(), headless.driver());
    format!(
        "{} {device} {driver} {:016x}",
        env!("CARGO_PKG_VERSION"),
        hasher.finish()
    )
}
