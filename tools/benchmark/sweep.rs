//! The paper's dynamic test: the camera stands still and a plane moves across the scene, in 30 frames.

use rara::glam::DVec3;
use rara::scene::extent_along;
use rara::{Clip, Headless, Result, Settings};

use crate::Bench;
use crate::args::Section;
use crate::correct::KEPT;
use crate::frame::{Past, frame};
use crate::memory;
use crate::report::Place;
use crate::statistics::{Summary, ratios};
use crate::table::{Table, spread};
use crate::turns::in_turn;
use crate::variant::{MODES, Variant};
use crate::world::{Source, World, clip_at};

const FRAMES: u32 = 30;

/// A renderer of its own, so that what it keeps of one frame is there in the next.
struct Lane {
    headless: Headless,
    variant: Variant,
    past: Past,
}

impl Lane {
    fn name(&self) -> String {
        let past = if self.past == Past::Kept {
            "swept"
        } else {
            "independent"
        };
        format!("{} {past}", self.variant.mode)
    }
}

/// The times that a frame of one lane takes, a value for each sweep, milliseconds.
struct Times {
    name: String,
    frame: Vec<f64>,
    processor: Vec<f64>,
}

pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    bench.each_source(Section::Sweep, scene)
}

fn scene(bench: &mut Bench, source: &Source, place: &mut Place) -> Result<()> {
    // Each mode is swept and drawn independently; without a clip nothing changes from frame to frame.
    let pasts = |mode| {
        if mode == "none" {
            &[Past::Forgotten][..]
        } else {
            &[Past::Kept, Past::Forgotten]
        }
    };
    let all = MODES
        .into_iter()
        .flat_map(|mode| pasts(mode.0).iter().map(move |&past| (mode, past)));
    let all: Vec<_> = all.collect();
    memory::check(source.expected(), all.len() as u64)?;
    let world = source.world()?;
    place.gaussians = world.scene.len();
    let mut lanes = Vec::new();
    for (mode, past) in all {
        let variant = Variant::auto(mode);
        let kept = format!("{} {KEPT}", mode.0);
        if !bench.wrong.allows(&variant.name()) || past == Past::Kept && !bench.wrong.allows(&kept)
        {
            continue;
        }
        let mut headless = Headless::new(&bench.args.desc())?;
        headless.load_as(&world.scene, Settings::default().precision.sh)?;
        lanes.push(Lane {
            headless,
            variant,
            past,
        });
    }
    let camera = world.camera(0, bench.args.size())?;
    place.size = [camera.width, camera.height];
    let times = sweeps(bench, &world, &mut lanes)?;
    add_rows(bench, place, &times)
}

/// Sweeps all lanes at once, a frame of each in turn.
fn sweeps(bench: &Bench, world: &World, lanes: &mut [Lane]) -> Result<Vec<Times>> {
    let camera = world.camera(0, bench.args.size())?;
    let whole = Clip::default();
    let normal = DVec3::X;
    let (from, to) = extent_along(&world.scene, normal);
    let mut times: Vec<Times> = lanes
        .iter()
        .map(|lane| Times {
            name: lane.name(),
            frame: Vec::new(),
            processor: Vec::new(),
        })
        .collect();
    let sweeps = in_turn(bench.args.rounds(), 1, |_, round| {
        let mut sums = vec![[0.0; 2]; lanes.len()];
        // The round that warms up needs only the first frame, the middle one and the last.
        let frames = if round == 0 { 3 } else { FRAMES };
        for index in 0..frames {
            let clip = clip_at(
                normal,
                from + (to - from) * f64::from(index) / f64::from(frames - 1),
            )?;
            for turn in 0..lanes.len() {
                let at = if index % 2 == 0 {
                    turn
                } else {
                    lanes.len() - 1 - turn
                };
                let lane = &mut lanes[at];
                // A sweep begins with a frame for which nothing was kept.
                let past = if index == 0 {
                    Past::Forgotten
                } else {
                    lane.past
                };
                let view = (&camera, lane.variant.clip(&clip, &whole));
                let timed = frame(&mut lane.headless, view, &lane.variant.settings, past)?;
                sums[at][0] += timed.frame_ms / f64::from(frames);
                sums[at][1] += timed.processor_ms / f64::from(frames);
            }
        }
        Ok(sums)
    })?;
    for sums in sweeps.into_iter().flatten() {
        for (times, [frame, processor]) in times.iter_mut().zip(sums) {
            times.frame.push(frame);
            times.processor.push(processor);
        }
    }
    Ok(times)
}

/// A table of times and one of the processor's; ratios are of frames a second: more is better.
fn add_rows(bench: &mut Bench, place: &Place, all: &[Times]) -> Result<()> {
    let frame: fn(&Times) -> &[f64] = |times| &times.frame;
    let processor: fn(&Times) -> &[f64] = |times| &times.processor;
    for (pass, values) in [("frame", frame), ("processor", processor)] {
        let title = format!(
            "{}, {FRAMES} frames, {pass}: median (least-90 %); ratios are of FPS",
            place.title()
        );
        let mut table = Table::new(
            title,
            &[
                "",
                "ms a frame",
                "FPS",
                "/ unclipped",
                "/ hard",
                "/ independent",
            ],
        );
        for times in all {
            let summary = Summary::of(values(times));
            let row = (&times.name[..], pass, "ms");
            bench.report.row(place, row, &summary)?;
            let mut cells = vec![spread(&summary), format!("{:.1}", 1e3 / summary.median)];
            for other in compared(&times.name) {
                let to = all
                    .iter()
                    .find(|to| to.name == other && other != times.name);
                let Some(to) = to else {
                    cells.push("-".into());
                    continue;
                };
                let summary = Summary::of(&ratios(values(to), values(times)));
                let pass = format!("{pass} FPS / {other}");
                let row = (&times.name[..], &pass[..], "ratio");
                bench.report.row(place, row, &summary)?;
                cells.push(spread(&summary));
            }
            table.line(times.name.clone(), cells);
        }
        table.print();
    }
    Ok(())
}

/// The lanes that a lane is compared with: like with like, except for the unclipped frame, for which a sweep would be no
/// work at all.
fn compared(name: &str) -> [String; 3] {
    let (mode, past) = name.split_once(' ').expect("a mode and a past");
    [
        "none independent".into(),
        format!("hard {past}"),
        format!("{mode} independent"),
    ]
}
