//! How far a frame is from what it cannot do without, each at the best rate that the device shows in the same round:
//! bytes moved (each survivor's Gaussian read, its splat written and read, the picture written), fragments blended, keys
//! sorted. Nothing else counts as needed: not the arithmetic of a projection, no lists of tiles, no fragment without
//! effect.

use rara::types::Splat;
use rara::{Clip, Gaussians, Headless, Result, glam};

use crate::Bench;
use crate::args::Section;
use crate::fragments;
use crate::frame::{Past, TOTALS, Timed, column, frame, stages, summary};
use crate::memory;
use crate::rates::Rates;
use crate::report::Place;
use crate::statistics::{Summary, ratios};
use crate::table::{Table, digits, spread};
use crate::turns::in_turn;
use crate::variant::{MODES, Variant};
use crate::world::Source;

/// Bytes that are copied in a measurement, and in a run that only shows that everything runs.
const MOVED: [u64; 2] = [128 << 20, 1 << 20];

/// The work that a frame cannot do without.
const NEEDS: [&str; 3] = ["bytes moved", "fragments blended", "keys sorted"];

pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    bench.each_source(Section::Bound, scene)
}

fn scene(bench: &mut Bench, source: &Source, place: &mut Place) -> Result<()> {
    memory::check(source.expected(), 2)?;
    let variant = Variant::auto(MODES[0]);
    if !bench.wrong.allows(&variant.name()) {
        return Ok(());
    }
    let world = source.world()?;
    let camera = world.camera(0, bench.args.size())?;
    place.gaussians = world.scene.len();
    place.size = [camera.width, camera.height];
    let settings = &variant.settings;
    let headless = |scene: &Gaussians| {
        let mut headless = Headless::new(&bench.args.desc())?;
        headless.load_as(scene, settings.precision.sh)?;
        Ok::<_, rara::Error>(headless)
    };
    let (mut whole, mut sorts) = (
        headless(&world.scene)?,
        headless(&nothing_but_keys(&world.scene))?,
    );
    let rates = Rates::new(whole.device(), MOVED[usize::from(bench.args.quick)])?;
    let view = (&camera, &Clip::default());

    let mut frames: Vec<Timed> = Vec::new();
    let mut measured = in_turn(bench.args.rounds(), 4, |thing, round| match thing {
        0 => rates.moved(),
        1 => rates.blended(),
        2 => {
            let timed = frame(&mut sorts, view, settings, Past::Forgotten)?;
            let ms = column(std::slice::from_ref(&timed), "sort")
                .first()
                .copied();
            Ok(f64::from(timed.stats.counts.drawn) / ms.unwrap_or(f64::NAN) * 1e3)
        }
        _ => {
            let timed = frame(&mut whole, view, settings, Past::Forgotten)?;
            let ms = timed.frame_ms;
            if round > 0 {
                frames.push(timed);
            }
            Ok(ms)
        }
    })?;

    let survivors = f64::from(frames.last().map_or(0, |timed| timed.stats.counts.drawn));
    // The faster of the two sorts counts: a bound that the frame itself beats would be none.
    for (rate, ms) in measured[2].iter_mut().zip(column(&frames, "sort")) {
        *rate = rate.max(survivors / ms * 1e3);
    }
    let record = whole.scene_bytes() as f64 / world.scene.len() as f64;
    let pixels = f64::from(camera.width) * f64::from(camera.height);
    let pixel_bytes = 16.0; // of the tiles' picture and of the target
    let needs = [
        survivors * (record + 2.0 * size_of::<Splat>() as f64) + pixels * pixel_bytes,
        fragments::count(&world.scene, &camera, settings) as f64,
        survivors,
    ];
    add_rows(bench, place, &variant, (needs, &measured, &frames))
}

/// The same centres with Gaussians that nobody sees: all that is left of a frame is its sort.
fn nothing_but_keys(scene: &Gaussians) -> Gaussians {
    let mut keys = scene.clone();
    keys.set_sh_degree(0);
    keys.scales_mut().fill(glam::Vec3::ZERO);
    keys
}

fn add_rows(
    bench: &mut Bench,
    place: &Place,
    variant: &Variant,
    (needs, measured, frames): ([f64; 3], &[Vec<f64>], &[Timed]),
) -> Result<()> {
    let title = format!("{}: ms, median (least-90 %)", place.title());
    let mut table = Table::new(title, &["", "millions", "millions a second", "ms"]);
    let name = variant.name();
    let mut bound = vec![0.0; frames.len()];
    for (at, need) in NEEDS.into_iter().enumerate() {
        let rates: Vec<f64> = measured[at].iter().map(|rate| rate / 1e6).collect();
        let millions = needs[at] / 1e6;
        let ms: Vec<f64> = rates.iter().map(|rate| 1e3 * millions / rate).collect();
        bound.iter_mut().zip(&ms).for_each(|(sum, ms)| *sum += ms);
        for (unit, values) in [("M", &vec![millions]), ("M/s", &rates), ("ms", &ms)] {
            let row = (&name[..], need, unit);
            bench.report.row(place, row, &Summary::of(values))?;
        }
        let cells = [
            digits(millions),
            spread(&Summary::of(&rates)),
            spread(&Summary::of(&ms)),
        ];
        table.line(need, cells);
    }
    let (own, none) = (&measured[NEEDS.len()], || [String::new(), String::new()]);
    let mut line = |name_of, unit, summary: &Summary| {
        let row = (&name[..], name_of, unit);
        bench.report.row(place, row, summary)?;
        table.line(name_of, none().into_iter().chain([spread(summary)]));
        Ok::<_, rara::Error>(())
    };
    line("bound", "ms", &Summary::of(&bound))?;
    for pass in stages(&[frames.to_vec()]).into_iter().chain([TOTALS[0]]) {
        line(pass, "ms", &summary(frames, pass))?;
    }
    line("frame / bound", "ratio", &Summary::of(&ratios(own, &bound)))?;
    table.print();
    Ok(())
}
