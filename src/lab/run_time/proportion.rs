//! Cost follows what is seen: frames that show a hundredth of a scene against frames that show all of it.

use glam::DMat3;
use rara::{Camera, Clip, Headless, Result};

use super::numbers::Measurements;
use super::run::{Run, in_mode};
use super::world::World;
use crate::frames::{MODES, fresh, in_turn, timed};

const SHARE: f64 = 0.01;
/// Halvings in the search for the camera that sees the wanted share.
const STEPS: u32 = 12;

pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    let mut headless = run.headless(world)?;
    let camera = world.camera(0, run.options.size())?;
    let mut numbers = numbers.for_pictures([camera.width, camera.height], "auto");
    // The field of view becomes narrower, so that the part fills the picture.
    let nearer = |t: f64| {
        let by = 1000.0_f64.powf(t);
        camera.fx(camera.fx * by).fy(camera.fy * by)
    };
    // The camera turns aside, so that the part lies at the picture's edge.
    let aside = |t: f64| {
        let turn = DMat3::from_rotation_y(t * std::f64::consts::FRAC_PI_2);
        camera.rotation(turn * camera.rotation)
    };
    let (none, exact) = (MODES[0], MODES[3]);
    let mut views = vec![
        ("whole", none, camera, Clip::default()),
        ("clipped", exact, camera, world.keeping(SHARE)?),
        (
            "zoomed in",
            none,
            search(&mut headless, nearer)?,
            Clip::default(),
        ),
        (
            "turned away",
            none,
            search(&mut headless, aside)?,
            Clip::default(),
        ),
    ];
    views.retain(|(_, mode, ..)| run.allows(mode.0, "auto"));
    let frames = in_turn(run.rounds(), views.len(), |index, _| {
        let (_, (_, mode), camera, clip) = &views[index];
        timed(&mut headless, camera, clip, &in_mode(*mode))
    })?;
    for ((name, ..), own) in views.iter().zip(&frames) {
        numbers.add_frames(name, own);
        if views[0].0 == "whole" {
            numbers.add_ratios(name, own, ("whole", &frames[0]));
        }
        let drawn = own.last().map(|timed| f64::from(timed.stats.counts.drawn));
        let share = |drawn: f64| 100.0 * drawn / world.scene.len() as f64;
        numbers.add(name, "drawn", "%", drawn.map(share).into_iter().collect());
    }
    run.finish(&numbers)
}

/// Finds the camera that sees a hundredth, among those from 0, which sees all, to 1, which sees next to nothing.
fn search(headless: &mut Headless, camera: impl Fn(f64) -> Camera) -> Result<Camera> {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..STEPS {
        let middle = f64::midpoint(low, high);
        let settings = in_mode(MODES[0].1);
        let counts = fresh(headless, &camera(middle), &Clip::default(), &settings)?.counts;
        let seen = f64::from(counts.drawn) / f64::from(counts.drawn + counts.culled);
        match seen > SHARE {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(camera(low))
}
