//! Frames at 1920x1080 by stage, whole and cut in half, on each raster path, with the camera that frames the scene.

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Clip, ClipOp, Mode, Plane, Result};

use super::numbers::Measurements;
use super::run::{Run, in_mode, rasters};
use super::world::World;
use crate::frames::{in_turn, timed};

const SIZE: (u32, u32) = (1920, 1080);

pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    let mut headless = run.headless(world)?;
    let camera = Camera::frame(&Bounds::of(&world.scene), -DVec3::Y, 50.0, SIZE)?;
    let mut rasters = rasters(&headless);
    rasters.retain(|(name, _)| run.allows("exact", name));
    let half = Clip::of([Plane::new(DVec3::X, 0.0)?], ClipOp::And);
    for (clip, how) in [(Clip::default(), "whole"), (half, "cut")] {
        let frames = in_turn(run.rounds(), rasters.len(), |index, _| {
            let settings = in_mode(Mode::Exact).raster(rasters[index].1);
            timed(&mut headless, &camera, &clip, &settings)
        })?;
        let mut numbers = numbers.for_pictures(SIZE.into(), how);
        for ((name, _), frames) in rasters.iter().zip(&frames) {
            numbers.add_frames(name, frames);
        }
        run.finish(&numbers)?;
    }
    Ok(())
}
