//! Correctness first: a variant that draws a wrong picture is not timed.

use rara::glam::DVec3;
use rara::{Camera, Clip, Headless, Picture, Raster, Result, reference};
use rara_lab::measure::psnr;

use crate::Bench;
use crate::args::Section;
use crate::frame::{Past, frame};
use crate::report::{Place, say};
use crate::statistics::Summary;
use crate::table::Table;
use crate::variant::{MODES, Variant, rasters};
use crate::world::World;

/// The picture is small, since the reference evaluates every splat in double precision, and no multiple of a tile.
const WIDTH: u32 = 123;
/// Frames that are drawn with and without those before them: the camera's place, and the share that the clip keeps.
/// Nothing moves, the clip does, the camera does, both do, the clip goes back.
const FRAMES: [(u32, f64); 6] = [(0, 0.5), (0, 0.5), (0, 0.4), (1, 0.4), (2, 0.3), (2, 0.6)];

/// Names of variants that were found wrong.
#[derive(Debug, Default)]
pub(crate) struct Wrong(Vec<String>);

/// The word that is added to a mode's name for frames that make use of those before them.
pub(crate) const KEPT: &str = "kept";

impl Wrong {
    /// Says whether a variant may be timed; prints a note if it may not.
    pub(crate) fn allows(&self, name: &str) -> bool {
        let wrong = self.0.iter().any(|wrong| wrong == name);
        if wrong {
            say(format_args!("{name} is not timed: it is wrong"));
        }
        !wrong
    }

    pub(crate) fn none(&self) -> bool {
        self.0.is_empty()
    }

    fn add(&mut self, name: String, why: String) {
        say(format_args!("WRONG: {name}: {why}"));
        if !self.0.contains(&name) {
            self.0.push(name);
        }
    }
}

/// Checks every mode and raster path on every scene.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    let title = "correct: dB against the picture in double precision";
    let mut table = Table::new(title, &["scene", "raster", "none", "hard", "rara", "exact"]);
    for source in bench.args.sources(Section::Correct) {
        say(format_args!("correct: {}", source.name()));
        let world = source.world()?;
        let mut headless = Headless::new(&bench.args.desc())?;
        headless.load(&world.scene)?;
        against_reference(bench, &world, &mut headless, &mut table)?;
        against_forgetting(bench, &world, headless)?;
    }
    table.print();
    Ok(())
}

fn against_reference(
    bench: &mut Bench,
    world: &World,
    headless: &mut Headless,
    table: &mut Table,
) -> Result<()> {
    let (camera, halved, whole) = (world.camera(1, WIDTH)?, world.halved()?, Clip::default());
    let place = place(world, &camera);
    let truths: Vec<Picture> = MODES
        .iter()
        .map(|&mode| {
            let v = Variant::auto(mode);
            let clip = v.clip(&halved, &whole);
            reference::render::<f64>(&world.scene, &camera, clip, &v.settings).picture
        })
        .collect();
    let mut all = rasters(headless);
    all.push(("auto", Raster::Auto));
    for raster in all {
        let mut cells = vec![raster.0.to_owned()];
        for (mode, truth) in MODES.into_iter().zip(&truths) {
            let v = Variant::new(mode, raster);
            headless.render(&camera, v.clip(&halved, &whole), &v.settings)?;
            let decibels = psnr(&headless.picture()?, truth)?.min(999.0);
            let least = v.settings.precision.least_psnr();
            if decibels.is_nan() || decibels < least {
                let why = format!(
                    "{}: {decibels:.1} dB, at least {least} are right",
                    world.name
                );
                bench.wrong.add(v.name(), why);
            }
            let summary = Summary::of(&[decibels]);
            bench
                .report
                .row(&place, (&v.name(), "picture", "dB"), &summary)?;
            cells.push(format!("{decibels:.1}"));
        }
        table.line(world.name.clone(), cells);
    }
    Ok(())
}

/// Asserts that what a frame keeps of those before it does not show: the pictures are the same byte for byte.
fn against_forgetting(bench: &mut Bench, world: &World, mut keeping: Headless) -> Result<()> {
    let mut forgetting = Headless::new(&bench.args.desc())?;
    forgetting.load(&world.scene)?;
    let whole = Clip::default();
    for mode in MODES {
        let v = Variant::auto(mode);
        for (index, (place, share)) in FRAMES.into_iter().enumerate() {
            let camera = world.camera(place, WIDTH)?;
            let moved = world.keeping(share, DVec3::X)?;
            let view = (&camera, v.clip(&moved, &whole));
            let settings = &v.settings;
            frame(&mut keeping, view, settings, Past::Kept)?;
            frame(&mut forgetting, view, settings, Past::Forgotten)?;
            if keeping.picture()? != forgetting.picture()? {
                let why = format!(
                    "{}: frame {index} is another one than computed from nothing",
                    world.name
                );
                bench.wrong.add(format!("{} {KEPT}", v.mode), why);
            }
        }
    }
    Ok(())
}

fn place(world: &World, camera: &Camera) -> Place {
    Place {
        section: Section::Correct,
        scene: world.name.clone(),
        gaussians: world.scene.len(),
        size: [camera.width, camera.height],
    }
}
