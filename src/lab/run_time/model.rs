//! The frames that the model of GPUs predicts, drawn on this device, beside what it predicts for the GPU that the device is,
//! or for all of its GPUs.

use rara::{Mode, Result};

use super::numbers::Measurements;
use super::run::{Run, in_mode, rasters};
use super::world::World;
use crate::frames::{in_turn, timed};
use crate::measure::gpu_model::{self, GPUS, PassPrediction, SIZE};

/// How many Gaussians the model's scenes have.
pub(super) const GAUSSIANS: [u32; 2] = [1_000_000, 5_000_000];

pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    let mut headless = run.headless(world)?;
    let camera = gpu_model::camera(&world.scene)?;
    let mut rasters = rasters(&headless);
    rasters.retain(|(name, _)| run.allows("exact", name));
    let known = gpu_model::named(headless.device_name());
    let name = |pass: &PassPrediction| match rara_gpu::measures_dispatches() {
        true => pass.pass,
        false => pass.stage,
    };
    let mut predicted = gpu_model::frames();
    predicted.retain(|frame| world.file.is_none() && frame.gaussians == world.scene.len());
    for (is_cut, how) in [(false, "whole"), (true, "cut")] {
        let clip = gpu_model::clip(is_cut)?;
        let frames = in_turn(run.rounds(), rasters.len(), |index, _| {
            let settings = in_mode(Mode::Exact).raster(rasters[index].1);
            timed(&mut headless, &camera, &clip, &settings)
        })?;
        let mut numbers = numbers.for_pictures(SIZE.into(), how);
        for ((name, _), frames) in rasters.iter().zip(&frames) {
            numbers.add_frames(name, frames);
        }
        for frame in predicted.iter().filter(|frame| frame.is_cut == is_cut) {
            for gpu in GPUS
                .iter()
                .filter(|gpu| known.is_none_or(|own| own == *gpu))
            {
                let column = format!("predicted, {}", gpu.name);
                let passes = gpu_model::predict(gpu, frame);
                for (name, ms) in gpu_model::sums(&passes, name) {
                    numbers.add(&column, name, "ms", vec![ms]);
                }
                let all = passes.iter().map(|pass| pass.ms).sum();
                numbers.add(&column, "device", "ms", vec![all]);
            }
        }
        run.finish(&numbers)?;
    }
    Ok(())
}
