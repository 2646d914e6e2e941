//! Frames that reuse nothing, which is what is measured and compared.

use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

use rara::{Camera, Clip, FrameStats, Headless, Mode, Picture, Result, Settings};

use crate::measure::processor_ms;

/// The modes, the simplest first, as tables call them.
pub(crate) const MODES: [(&str, Mode); 4] = [
    ("none", Mode::None),
    ("hard", Mode::Hard),
    ("rara", Mode::Rara),
    ("exact", Mode::Exact),
];

/// Draws a frame that reuses nothing of the one before.
pub fn fresh(
    headless: &mut Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Result<FrameStats> {
    headless.forget();
    headless.render(camera, clip, settings)
}

pub fn picture(
    headless: &mut Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Result<(Picture, FrameStats)> {
    let stats = fresh(headless, camera, clip, settings)?;
    Ok((headless.picture()?, stats))
}

#[derive(Debug, Clone)]
pub(crate) struct FrameTime {
    pub(crate) stats: FrameStats,
    /// What this process took on all cores, milliseconds; 0 where the system does not count it.
    pub(crate) processor_ms: f64,
}

pub(crate) fn timed(
    headless: &mut Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Result<FrameTime> {
    let before = processor_ms();
    let stats = fresh(headless, camera, clip, settings)?;
    let processor_ms = processor_ms() - before;
    Ok(FrameTime {
        stats,
        processor_ms,
    })
}

/// A stage, frame by frame, or one of what frames have beside: `frame`, from the call to the picture, `processor`, of all cores,
/// and `device`, all stages together. Nothing where no frame went through the stage.
pub(crate) fn times(frames: &[FrameTime], name: &str) -> Vec<f64> {
    let time = |timed: &FrameTime| match name {
        "frame" => Some(timed.stats.wall_ms),
        "processor" => Some(timed.processor_ms),
        "device" => timed.stats.gpu_ms,
        _ => {
            let pass = timed.stats.passes.iter().find(|pass| pass.name == name)?;
            Some(pass.ms)
        }
    };
    frames.iter().filter_map(time).collect()
}

/// After this long the least number of rounds is enough.
const ENOUGH: Duration = Duration::from_secs(30);

/// Measures `count` things in turn, so that other work on the machine disturbs all of them alike: `one(thing, round)`; the
/// results by thing, then by round. A round 0 comes first and its results are dropped: it compiles, allocates and fills
/// caches.
pub fn in_turn<T>(
    rounds: RangeInclusive<u32>,
    count: usize,
    mut one: impl FnMut(usize, u32) -> Result<T>,
) -> Result<Vec<Vec<T>>> {
    let mut results: Vec<Vec<T>> = (0..count).map(|_| Vec::new()).collect();
    let mut begin = Instant::now();
    for round in 0..=*rounds.end() {
        if round > *rounds.start() && begin.elapsed() > ENOUGH {
            break;
        }
        // The order alternates, so that none always follows the same one or always has the same place in a round.
        let mut order: Vec<usize> = (0..count).collect();
        if round % 2 == 1 {
            order.reverse();
        }
        for thing in order {
            let result = one(thing, round)?;
            if round > 0 {
                results[thing].push(result);
            }
        }
        if round == 0 {
            begin = Instant::now();
        }
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_take_turns_in_both_directions_and_the_first_round_does_not_count() {
        let mut order = Vec::new();
        let results = in_turn(2..=2, 2, |thing, round| {
            order.push((round, thing));
            Ok(10 * round + thing as u32)
        });
        assert_eq!(results.expect("none fails"), [[10, 20], [11, 21]]);
        assert_eq!(order, [(0, 0), (0, 1), (1, 1), (1, 0), (2, 0), (2, 1)]);
    }
}
