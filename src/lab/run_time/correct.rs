//! Correctness first: what draws a wrong picture is not timed.

use rara::{Headless, Raster, Result};

use super::numbers::Measurements;
use super::run::{Run, in_mode, rasters};
use super::world::World;
use crate::frames::MODES;
use crate::measure::psnr;

/// The picture is small, since the reference evaluates every splat in double precision, and no multiple of a tile.
const WIDTH: u32 = 123;

/// Compares every mode and raster path with the picture in double precision.
pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    let (camera, clip) = (world.camera(1, WIDTH)?, world.keeping(0.5)?);
    let mut numbers = numbers.for_pictures([camera.width, camera.height], "");
    let mut headless = Headless::new(&run.options.device)?;
    headless.load(&world.scene)?;
    let mut rasters = rasters(&headless);
    rasters.push(("auto", Raster::Auto));
    for (mode_name, mode) in MODES {
        let settings = in_mode(mode);
        let truth = rara_reference::render::<f64>(&world.scene, &camera, &clip, &settings).picture;
        for &(raster_name, raster) in &rasters {
            headless.render(&camera, &clip, &settings.raster(raster))?;
            let decibels = psnr(&headless.picture()?, &truth)?.min(999.0);
            let least = settings.precision.least_psnr();
            if decibels.is_nan() || decibels < least {
                let (name, scene) = (format!("{mode_name} {raster_name}"), &world.name);
                let why = format!("{decibels:.1} dB, at least {least} are right");
                run.program
                    .hear(&format!("{name} is wrong on {scene}: {why}"));
                if !run.wrong.contains(&name) {
                    run.wrong.push(name);
                }
            }
            numbers.add(mode_name, raster_name, "dB", vec![decibels]);
        }
    }
    run.finish(&numbers)
}
