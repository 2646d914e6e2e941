//! The time of each stage of a frame: by Gaussians, picture size, mode and raster path; the camera moves, and every
//! frame is computed from nothing.

use rara::{Clip, Error, Headless, Result, Settings};

use crate::Bench;
use crate::args::Section;
use crate::frame::{Past, TOTALS, Timed, column, frame, stages, summary};
use crate::memory;
use crate::report::{Place, grouped, say};
use crate::statistics::{Summary, ratios};
use crate::table::{Table, digits, spread};
use crate::turns::in_turn;
use crate::variant::{MODES, Variant, rasters};
use crate::world::{Source, World};

/// The tables at the end, of the frame and of the processor's time, which other work on the machine disturbs less.
const OVERVIEW: [&str; 7] = ["scene", "size", "raster", "none", "hard", "rara", "exact"];
type Overview = [Table; 2];

pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    let table = |total| Table::new(format!("passes: {total}, ms, median (least)"), &OVERVIEW);
    let mut overview = [table(TOTALS[0]), table(TOTALS[1])];
    for source in bench.args.sources(Section::Passes) {
        let place = |size| Place {
            section: Section::Passes,
            scene: source.name(),
            gaussians: source.expected(),
            size: [size, size],
        };
        match scene(bench, &source, &mut overview) {
            Err(Error::Memory(why)) => bench.report.no_memory(&place(0), &why)?,
            result => result?,
        }
    }
    overview.iter().for_each(Table::print);
    Ok(())
}

fn scene(bench: &mut Bench, source: &Source, overview: &mut Overview) -> Result<()> {
    memory::check(source.expected(), 1)?;
    let world = source.world()?;
    let mut headless = Headless::new(&bench.args.desc())?;
    headless.load_as(&world.scene, Settings::default().precision.sh)?;
    for width in bench.args.sizes() {
        let camera = world.camera(0, width)?;
        let place = Place {
            section: Section::Passes,
            scene: world.name.clone(),
            gaussians: world.scene.len(),
            size: [camera.width, camera.height],
        };
        say(place.title());
        match size(bench, &world, &mut headless, &place, overview) {
            Err(Error::Memory(why)) => bench.report.no_memory(&place, &why)?,
            result => result?,
        }
    }
    Ok(())
}

fn size(
    bench: &mut Bench,
    world: &World,
    headless: &mut Headless,
    place: &Place,
    overview: &mut Overview,
) -> Result<()> {
    let mut variants: Vec<Variant> = Vec::new();
    for raster in rasters(headless) {
        // They are of no use on a CPU: three times a quad's vertices.
        if raster.0 == "mesh" && headless.device().info().kind_name() == "cpu" {
            continue;
        }
        variants.extend(MODES.map(|mode| Variant::new(mode, raster)));
    }
    variants.retain(|v| bench.wrong.allows(&v.name()));
    let (halved, whole, width) = (world.halved()?, Clip::default(), place.size[0]);
    let frames = in_turn(bench.args.rounds(), variants.len(), |index, round| {
        let (v, camera) = (&variants[index], world.camera(round, width)?);
        let view = (&camera, v.clip(&halved, &whole));
        frame(headless, view, &v.settings, Past::Forgotten)
    })?;
    let mut names: Vec<&str> = variants.iter().map(|v| v.raster).collect();
    names.dedup();
    for raster in names {
        let of: Vec<usize> = (0..variants.len())
            .filter(|&i| variants[i].raster == raster)
            .collect();
        let modes: Vec<&str> = of.iter().map(|&i| variants[i].mode).collect();
        let frames: Vec<Vec<Timed>> = of.iter().map(|&i| frames[i].clone()).collect();
        one_raster(bench, place, raster, &modes, &frames)?;
        let scene = format!("{}, {}", place.scene, grouped(place.gaussians));
        let [width, height] = place.size;
        for (table, total) in overview.iter_mut().zip(TOTALS) {
            let cell = |(mode, _)| match modes.iter().position(|name| *name == mode) {
                None => "wrong".to_owned(),
                Some(at) => {
                    let s = summary(&frames[at], total);
                    format!("{} ({})", digits(s.median), digits(s.min))
                }
            };
            let cells = [format!("{width}x{height}"), raster.into()];
            table.line(scene.clone(), cells.into_iter().chain(MODES.map(cell)));
        }
    }
    Ok(())
}

/// A table of the stages by mode.
fn one_raster(
    bench: &mut Bench,
    place: &Place,
    raster: &str,
    modes: &[&str],
    frames: &[Vec<Timed>],
) -> Result<()> {
    let title = format!("{}, {raster}: ms, median (least-90 %)", place.title());
    let mut table = Table::new(title, &[&["pass"], modes].concat());
    for pass in stages(frames).into_iter().chain(TOTALS) {
        let mut cells = Vec::new();
        for (mode, frames) in modes.iter().zip(frames) {
            let summary = summary(frames, pass);
            cells.push(spread(&summary));
            if summary.n > 0 {
                let variant = format!("{mode} {raster}");
                bench.report.row(place, (&variant, pass, "ms"), &summary)?;
            }
        }
        table.line(pass, cells);
    }
    if let Some(none) = modes.iter().position(|mode| *mode == "none") {
        for total in &TOTALS[..2] {
            let mut cells = Vec::new();
            for (mode, own) in modes.iter().zip(frames) {
                let ratios = ratios(&column(own, total), &column(&frames[none], total));
                let summary = Summary::of(&ratios);
                cells.push(spread(&summary));
                let (variant, pass) = (format!("{mode} {raster}"), format!("{total} / none"));
                bench
                    .report
                    .row(place, (&variant, &pass, "ratio"), &summary)?;
            }
            table.line(format!("{total} / none"), cells);
        }
    }
    let drawn = frames.iter().map(|frames| {
        let drawn = frames.last().map_or(0, |timed| timed.stats.counts.drawn);
        grouped(drawn as usize)
    });
    table.line("drawn in the last", drawn);
    table.print();
    Ok(())
}
