//! What frames take by stage, size, mode and raster path, how near that is to what they cannot do without, and what happens
//! before the first one. Each file of a section measures one scene.

mod bound;
mod correct;
mod fixed;
mod fragments;
mod full_hd;
mod numbers;
mod passes;
mod proportion;
#[allow(unsafe_code)]
mod rates;
mod run;
mod start;
mod world;

use std::process::id;

use rara::scene::Kind;
use rara::{Error, Headless, Result};
use rara_base::counted::counted;

use crate::table::Table;
use numbers::Measurements;
use run::Run;
pub use run::{Program, RunTimeOptions};
pub use start::start;
use world::World;

type Section = fn(&mut Run<'_>, &World, Measurements) -> Result<()>;

/// The sections in the order in which they run: their names, and the sizes and the measurement of generated scenes.
const SECTIONS: [(&str, &[u32], Section); 7] = [
    (CORRECT, &[5000], correct::measure),
    (
        "passes",
        &[100_000, 500_000, 1_000_000, 2_000_000, 5_000_000],
        passes::measure,
    ),
    ("bound", &[100_000, 1_000_000, 5_000_000], bound::measure),
    ("proportion", &[2_000_000, 5_000_000], proportion::measure),
    ("start", &[500_000], start::measure),
    ("fixed", &[1000], fixed::measure),
    ("full-hd", &[1_000_000, 5_000_000], full_hd::measure),
];
const CORRECT: &str = "correct";

pub fn sections() -> [&'static str; SECTIONS.len()] {
    SECTIONS.map(|(name, ..)| name)
}

/// Measures the sections. Returns which modes and raster paths draw wrong pictures, which are not timed.
///
/// # Errors
/// If something cannot be measured, other than for lack of memory.
pub fn run_time(options: &RunTimeOptions, program: &mut dyn Program) -> Result<Vec<String>> {
    let headless = Headless::new(&options.device)?;
    let device = [headless.device_name(), headless.driver()].map(String::from);
    headless.close()?;
    let folder = std::env::temp_dir().join(format!("rara-measure-{}", id()));
    std::fs::create_dir_all(&folder).map_err(Error::io(folder.clone()))?;
    let mut run = Run {
        options,
        program,
        device,
        all: Table::new("", "", numbers::COLUMNS),
        wrong: Vec::new(),
        folder,
    };
    let measured = sections_of(&mut run);
    let _ = std::fs::remove_dir_all(&run.folder);
    measured.map(|()| run.wrong)
}

fn sections_of(run: &mut Run<'_>) -> Result<()> {
    let options = run.options;
    for (section, usual, measure) in SECTIONS {
        let mut chosen = options.sections.iter();
        let is_chosen = options.sections.is_empty() || chosen.any(|name| name == section);
        if !is_chosen && (section != CORRECT || options.unchecked) {
            continue;
        }
        if !options.scenes.is_empty() {
            for file in &options.scenes {
                // Of degree 3, with 248 bytes a Gaussian; a file of a lower degree holds more of them.
                let gaussians = file.metadata().map_or(0, |about| about.len() / 248);
                let load = || World::load(file, options.cameras.as_deref());
                scene(run, section, gaussians, load, measure)?;
            }
            continue;
        }
        // These scenes stay small: the reference takes its time.
        let counts = match &options.gaussians[..] {
            given if section != CORRECT && !given.is_empty() => given,
            _ if options.quick => &[2000],
            _ => usual,
        };
        let kinds: &[_] = match section {
            CORRECT => &[
                ("general", Kind::General),
                ("strands", Kind::Strands),
                ("layers", Kind::Layers),
            ],
            _ => &[("general", Kind::General)],
        };
        for &count in counts {
            for &(name, kind) in kinds {
                let make = || Ok(World::made(name, kind, count as usize));
                scene(run, section, count.into(), make, measure)?;
            }
        }
    }
    Ok(())
}

/// Measures one scene, unless there is no memory for it.
fn scene(
    run: &mut Run<'_>,
    section: &'static str,
    gaussians: u64,
    world: impl FnOnce() -> Result<World>,
    measure: Section,
) -> Result<()> {
    let measured = run.program.check_room(gaussians).and_then(|()| {
        let world = world()?;
        let numbers = Measurements::new(section, &world, [run.options.size(); 2]);
        let what = counted(world.scene.len(), "Gaussian");
        let scene = &world.name;
        run.program.hear(&format!("{section}: {scene}, {what}"));
        measure(run, &world, numbers)
    });
    match measured {
        Err(error @ Error::Memory(_)) => {
            let what = counted(gaussians, "Gaussian");
            run.program
                .hear(&format!("{section}: {what}: not measured: {error}"));
            Ok(())
        }
        other => other,
    }
}
