//! How far a frame is from what it cannot do without, each at the best rate that the device shows in the same round:
//! bytes moved (each splat's Gaussian read, its splat written and read, the picture written), fragments blended, keys
//! sorted. Nothing else counts as needed: not the arithmetic of a projection, no lists of tiles, no fragment without
//! effect.

use glam::Vec3;
use rara::types::Splat;
use rara::{Clip, Headless, Result};

use super::fragments;
use super::numbers::Measurements;
use super::rates::Rates;
use super::run::{Run, in_mode};
use super::world::World;
use crate::frames::{FrameTime, MODES, in_turn, timed, times};

/// Bytes that are copied in a measurement, and in a run that only shows that everything runs.
const MOVED: [u64; 2] = [128 << 20, 1 << 20];

pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    let (name, mode) = MODES[0];
    if !run.allows(name, "auto") {
        return Ok(());
    }
    let (camera, settings) = (world.camera(0, run.options.size())?, in_mode(mode));
    let mut numbers = numbers.for_pictures([camera.width, camera.height], "auto");
    let (mut whole, mut sorts) = (run.headless(world)?, Headless::new(&run.options.device)?);
    // The same centres with Gaussians that nobody sees: all that is left of a frame is its sort.
    let mut keys = world.scene.clone();
    keys.set_sh_degree(0);
    keys.scales_mut().fill(Vec3::ZERO);
    sorts.load_as(&keys, settings.precision.sh)?;
    let device = Rates::new(whole.device(), MOVED[usize::from(run.options.quick)])?;

    let frame = |headless: &mut Headless| timed(headless, &camera, &Clip::default(), &settings);
    let rounds: Vec<([f64; 2], FrameTime, FrameTime)> = in_turn(run.rounds(), 1, |_, _| {
        let rates = [device.moved()?, device.blended()?];
        Ok((rates, frame(&mut sorts)?, frame(&mut whole)?))
    })?
    .remove(0);

    let frames: Vec<FrameTime> = rounds.iter().map(|round| round.2.clone()).collect();
    let drawn = f64::from(frames.last().map_or(0, |timed| timed.stats.counts.drawn));
    let record = whole.scene_bytes() as f64 / world.scene.len() as f64;
    let pixels = f64::from(camera.width) * f64::from(camera.height);
    let pixel_bytes = 16.0; // of the tiles' picture and of the target
    let splats = drawn * (record + 2.0 * size_of::<Splat>() as f64);
    let blended = fragments::count(&world.scene, &camera, &settings) as f64;
    // The faster of the two sorts counts: a bound that the frame itself beats would be none.
    let sorted = |(_, keys, whole): &([f64; 2], FrameTime, FrameTime)| {
        let rate = |timed: &FrameTime| {
            let ms = times(std::slice::from_ref(timed), "sort");
            ms.first()
                .map(|ms| 1e3 * f64::from(timed.stats.counts.drawn) / ms)
        };
        rate(keys)
            .into_iter()
            .chain(rate(whole))
            .fold(0.0, f64::max)
    };
    let needs: [(&str, f64, Vec<f64>); 3] = [
        (
            "bytes moved",
            splats + pixels * pixel_bytes,
            rounds.iter().map(|round| round.0[0]).collect(),
        ),
        (
            "fragments blended",
            blended,
            rounds.iter().map(|round| round.0[1]).collect(),
        ),
        ("keys sorted", drawn, rounds.iter().map(sorted).collect()),
    ];
    let mut bound = vec![0.0; rounds.len()];
    for (what, need, rates) in needs {
        let ms: Vec<f64> = rates.iter().map(|rate| 1e3 * need / rate).collect();
        bound.iter_mut().zip(&ms).for_each(|(sum, ms)| *sum += ms);
        numbers.add(name, what, "M", vec![need / 1e6]);
        let rates = rates.iter().map(|rate| rate / 1e6).collect();
        numbers.add(name, what, "M/s", rates);
        numbers.add(name, what, "ms", ms);
    }
    let ratios = times(&frames, "frame").into_iter().zip(&bound);
    let ratios = ratios.map(|(ms, bound)| ms / bound).collect();
    numbers.add_frames(name, &frames);
    numbers.add(name, "bound", "ms", bound);
    numbers.add(name, "frame / bound", "ratio", ratios);
    run.finish(&numbers)
}
