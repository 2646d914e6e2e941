//! The time of each stage of a frame by picture size, mode and raster path, while the camera moves.

use rara::{Camera, Mode, Raster, Result};

use super::numbers::Measurements;
use super::run::{Run, in_mode, rasters};
use super::world::World;
use crate::frames::{MODES, in_turn, timed};

pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    let (mut headless, clip) = (run.headless(world)?, world.keeping(0.5)?);
    let mut rasters = rasters(&headless);
    // Meshes are of no use on a CPU: three times a quad's vertices.
    let on_cpu = headless.device().info().kind_name() == "cpu";
    rasters.retain(|(_, raster)| !(on_cpu && *raster == Raster::Mesh));
    let sizes: &[u32] = match &run.options.sizes[..] {
        [] if run.options.quick => &[64, 96],
        [] => &[512, 1024, 2048],
        given => given,
    };
    for &width in sizes {
        let variants = rasters
            .iter()
            .flat_map(|&raster| MODES.map(|mode| (raster, mode)));
        let variants: Vec<_> = variants
            .filter(|(raster, mode)| run.allows(mode.0, raster.0))
            .collect();
        let frames = in_turn(run.rounds(), variants.len(), |index, round| {
            let ((_, raster), (_, mode)) = variants[index];
            let camera = world.camera(round, width)?;
            let settings = in_mode(mode).raster(raster);
            timed(&mut headless, &camera, &clip, &settings)
        })?;
        let Camera { width, height, .. } = world.camera(0, width)?;
        let measured: Vec<_> = variants.iter().zip(&frames).collect();
        for of_raster in measured.chunk_by(|a, b| a.0.0 == b.0.0) {
            let mut numbers = numbers.for_pictures([width, height], of_raster[0].0.0.0);
            let none = of_raster.iter().find(|((_, mode), _)| mode.1 == Mode::None);
            for ((_, (mode, _)), frames) in of_raster {
                numbers.add_frames(mode, frames);
                if let Some((_, none)) = none {
                    numbers.add_ratios(mode, frames, ("none", none));
                }
                let drawn = frames.last().map(|timed| timed.stats.counts.drawn.into());
                numbers.add(mode, "drawn in the last", "", drawn.into_iter().collect());
            }
            run.finish(&numbers)?;
        }
    }
    Ok(())
}
