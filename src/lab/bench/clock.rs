//! Times of several choices, taken in turn so that their ratios hold on a machine that does other things too.

use crate::measure::processor_ms;
use rara::{Camera, Clip, Headless, PassTime, Result, Scene, Settings};
use serde::Serialize;

use crate::frames::fresh;

/// The times of one choice, milliseconds.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Times {
    /// On the device, the median frame.
    pub(crate) ms: f64,
    /// On the device, each stage at its quickest, which other work on the machine disturbs least.
    pub(crate) ms_min: f64,
    /// From recording to the picture, the median frame.
    pub(crate) wall_ms: f64,
    /// Of this process on all cores, the median frame; 0 where the system does not count it.
    pub(crate) cpu_ms: f64,
    /// Of this process on all cores, the least frame.
    pub(crate) cpu_ms_min: f64,
    /// The cost of a choice: `ms_min` on the device, or, where the device is this machine's processor and the system
    /// counts its time, `cpu_ms_min`, which other work on the machine hardly disturbs.
    pub(crate) cost: f64,
    /// Each stage's median and minimum.
    pub(crate) passes: Vec<Pass>,
}

/// The times of one stage, milliseconds.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Pass {
    pub(crate) name: String,
    pub(crate) ms: f64,
    pub(crate) ms_min: f64,
}

/// Times each clip with its settings. A round is one frame of each; there are `rounds` of them after a first one that is
/// not counted.
pub(crate) fn time(
    headless: &mut Headless,
    scene: &Scene<'_>,
    camera: &Camera,
    all: &[(&Clip, Settings)],
    rounds: u32,
) -> Result<Vec<Times>> {
    let mut samples = vec![Samples::default(); all.len()];
    let mut loaded = None;
    for round in 0..=rounds {
        // The order alternates, so that none always follows the same one or always has the same place in a round.
        let mut order: Vec<usize> = (0..all.len()).collect();
        if round % 2 == 1 {
            order.reverse();
        }
        for index in order {
            let ((clip, settings), samples) = (&all[index], &mut samples[index]);
            let sh = settings.precision.sh;
            if loaded != Some(sh) {
                headless.load_as(scene, sh)?;
                // The frame after an upload finds other data in the caches, so it is not timed.
                fresh(headless, camera, clip, settings)?;
                loaded = Some(sh);
            }
            let before = processor_ms();
            let frame = fresh(headless, camera, clip, settings)?;
            let after = processor_ms();
            if round > 0 {
                samples.ms.extend(frame.gpu_ms);
                samples.wall.push(frame.wall_ms);
                samples.cpu.push(after - before);
                samples.passes.push(frame.passes);
            }
        }
    }
    let on_cpu = headless.device().info().kind_name() == "cpu";
    Ok(samples.iter().map(|s| s.times(on_cpu)).collect())
}

#[derive(Debug, Clone, Default)]
struct Samples {
    ms: Vec<f64>,
    wall: Vec<f64>,
    cpu: Vec<f64>,
    passes: Vec<Vec<PassTime>>,
}

impl Samples {
    fn times(&self, on_cpu: bool) -> Times {
        let names = self.passes.first().into_iter().flatten();
        let pass = |name: &str| {
            let ms = self.passes.iter().flatten().filter(|p| p.name == name);
            let ms: Vec<f64> = ms.map(|p| p.ms).collect();
            Pass {
                name: name.to_owned(),
                ms: median(&ms),
                ms_min: least(&ms),
            }
        };
        let passes: Vec<Pass> = names.map(|p| pass(p.name)).collect();
        let (ms_min, cpu_ms_min) = (
            passes.iter().fold(0.0, |sum, p| sum + p.ms_min),
            least(&self.cpu),
        );
        let has_cpu_time = on_cpu && cpu_ms_min.is_finite() && cpu_ms_min > 0.0;
        Times {
            ms: median(&self.ms),
            ms_min,
            cpu_ms_min: if has_cpu_time { cpu_ms_min } else { 0.0 },
            cost: if has_cpu_time { cpu_ms_min } else { ms_min },
            wall_ms: median(&self.wall),
            cpu_ms: median(&self.cpu),
            passes,
        }
    }
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn median(values: &[f64]) -> f64 {
    crate::statistics::median(values).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_minima() {
        let pass = |ms| vec![PassTime { name: "sort", ms }];
        let samples = Samples {
            ms: vec![4.0, 1.0, 9.0, 2.0],
            wall: vec![5.0],
            cpu: vec![],
            passes: vec![pass(3.0), pass(1.0), pass(2.0)],
        };
        let times = samples.times(true);
        assert_eq!((times.ms, times.ms_min, times.wall_ms), (3.0, 1.0, 5.0));
        assert_eq!((times.passes[0].ms, times.passes[0].ms_min), (2.0, 1.0));
        assert_eq!(
            (times.cpu_ms, times.cpu_ms_min, times.cost),
            (0.0, 0.0, 1.0)
        );
        let counted = Samples {
            cpu: vec![9.0, 8.0],
            ..samples
        };
        assert_eq!(counted.times(true).cost, 8.0);
        assert_eq!(
            counted.times(false).cost,
            1.0,
            "a processor's time is not a GPU's"
        );
    }
}
