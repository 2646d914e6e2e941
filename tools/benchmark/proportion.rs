//! Cost follows what is seen: frames that show a hundredth of a scene against frames that show all of it.

use rara::glam::{DMat3, DVec3};
use rara::{Camera, Clip, Headless, Result, Settings};

use crate::Bench;
use crate::args::Section;
use crate::frame::{Past, Timed, column, frame, summary};
use crate::memory;
use crate::report::{Place, grouped};
use crate::statistics::{Summary, ratios};
use crate::table::{Table, spread};
use crate::turns::in_turn;
use crate::variant::{MODES, Variant};
use crate::world::Source;

const SHARE: f64 = 0.01;
/// Halvings in the search for the camera that sees the wanted share.
const STEPS: u32 = 12;

/// A way of seeing a part: its name, how it is drawn, how the camera changes, and the clip.
struct View {
    name: &'static str,
    variant: Variant,
    look: Look,
    clip: Clip,
}

/// How a camera is changed.
#[derive(Debug, Clone, Copy)]
enum Look {
    Whole,
    /// The field of view becomes so many times narrower, so that the part fills the picture.
    Nearer(f64),
    /// The camera turns aside by so many radians, so that the part lies at the picture's edge.
    Aside(f64),
}

impl Look {
    fn camera(self, camera: Camera) -> Camera {
        match self {
            Self::Whole => camera,
            Self::Nearer(by) => camera.fx(camera.fx * by).fy(camera.fy * by),
            Self::Aside(by) => camera.rotation(DMat3::from_rotation_y(by) * camera.rotation),
        }
    }
}

pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    bench.each_source(Section::Proportion, scene)
}

fn scene(bench: &mut Bench, source: &Source, place: &mut Place) -> Result<()> {
    memory::check(source.expected(), 1)?;
    let world = source.world()?;
    let mut headless = Headless::new(&bench.args.desc())?;
    headless.load_as(&world.scene, Settings::default().precision.sh)?;
    let width = bench.args.size();
    let camera = world.camera(0, width)?;
    place.gaussians = world.scene.len();
    place.size = [camera.width, camera.height];

    let (none, exact) = (Variant::auto(MODES[0]), Variant::auto(MODES[3]));
    let view = |name, variant, look, clip| View {
        name,
        variant,
        look,
        clip,
    };
    let whole = Clip::default();
    let nearer = |t: f64| Look::Nearer(1000.0_f64.powf(t));
    let aside = |t: f64| Look::Aside(t * std::f64::consts::FRAC_PI_2);
    let nearer = search(&mut headless, &none, camera, nearer)?;
    let aside = search(&mut headless, &none, camera, aside)?;
    let cut = world.keeping(SHARE, DVec3::new(0.9, 0.3, 0.2).normalize())?;
    let mut views = vec![
        view("whole", none, Look::Whole, whole.clone()),
        view("clipped", exact, Look::Whole, cut),
        view("zoomed in", none, nearer, whole.clone()),
        view("turned away", none, aside, whole),
    ];
    views.retain(|view| bench.wrong.allows(&view.variant.name()));
    let frames = in_turn(bench.args.rounds(), views.len(), |index, _| {
        let View {
            variant,
            look,
            clip,
            ..
        } = &views[index];
        let camera = look.camera(camera);
        let view = (&camera, clip);
        frame(&mut headless, view, &variant.settings, Past::Forgotten)
    })?;
    add_rows(bench, place, &views, &frames)
}

/// Finds the change with which the camera sees a hundredth, from 0 for all of it to 1 for next to nothing.
fn search(
    headless: &mut Headless,
    variant: &Variant,
    camera: Camera,
    look: impl Fn(f64) -> Look,
) -> Result<Look> {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..STEPS {
        let middle = (low + high) / 2.0;
        let camera = look(middle).camera(camera);
        let view = (&camera, &Clip::default());
        let counts = frame(headless, view, &variant.settings, Past::Forgotten)?
            .stats
            .counts;
        let seen = f64::from(counts.drawn) / f64::from(counts.drawn + counts.culled);
        if seen > SHARE {
            low = middle
        } else {
            high = middle
        }
    }
    Ok(look(low))
}

fn add_rows(bench: &mut Bench, place: &Place, views: &[View], frames: &[Vec<Timed>]) -> Result<()> {
    let title = format!("{}: ms, median (least-90 %)", place.title());
    let header = [
        "",
        "drawn",
        "share, %",
        "frame",
        "processor",
        "frame / whole",
        "processor / whole",
    ];
    let mut table = Table::new(title, &header);
    for (view, own) in views.iter().zip(frames) {
        let drawn = own.last().map_or(0, |timed| timed.stats.counts.drawn);
        let share = 100.0 * f64::from(drawn) / place.gaussians as f64;
        let count = Summary::of(&[drawn.into()]);
        bench
            .report
            .row(place, (view.name, "drawn", "Gaussians"), &count)?;
        let mut cells = vec![grouped(drawn as usize), format!("{share:.2}")];
        for pass in ["frame", "processor"] {
            let summary = summary(own, pass);
            bench.report.row(place, (view.name, pass, "ms"), &summary)?;
            cells.push(spread(&summary));
        }
        for pass in ["frame", "processor"] {
            let whole = views.iter().position(|view| view.name == "whole");
            let Some(whole) = whole else { continue };
            let ratios = ratios(&column(own, pass), &column(&frames[whole], pass));
            let summary = Summary::of(&ratios);
            let pass = format!("{pass} / whole");
            bench
                .report
                .row(place, (view.name, &pass, "ratio"), &summary)?;
            cells.push(spread(&summary));
        }
        table.line(view.name, cells);
    }
    table.print();
    Ok(())
}
