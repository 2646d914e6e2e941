//! Frames at 1920x1080 by stage, whole and cut, with the camera that frames the scene: drawn with tiles by the program's own
//! shaders, and by each variant of them that a folder holds.

use std::path::Path;

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Clip, Error, Mode, Picture, Plane, Raster, Result};
use rara_gpu::replace_modules;

use super::numbers::Measurements;
use super::run::{Run, in_mode};
use super::world::World;
use crate::bench::shapes::regions;
use crate::frames::{in_turn, timed};
use crate::measure::differences;

const SIZE: (u32, u32) = (1920, 1080);

/// The regions that cut the scene in half, after the whole one.
const REGIONS: [&str; 3] = ["plane", "sphere", "box and not sphere"];

pub(super) fn measure(run: &mut Run<'_>, world: &World, numbers: Measurements) -> Result<()> {
    if !run.allows("exact", "tiles") {
        return Ok(());
    }
    let bounds = Bounds::of(&world.scene);
    let plane = Plane::new(DVec3::X, -bounds.centre().x)?;
    let mut clips = vec![("whole", Clip::default())];
    for (name, region) in regions(&bounds, plane)? {
        if REGIONS.contains(&name) {
            clips.push((name, region.clip()));
        }
    }
    let folders = run.options.modules.clone();
    for folder in &folders {
        check(folder)?;
    }
    let named = folders.iter().map(|folder| Some(folder.as_path()));
    let variants: Vec<Option<&Path>> = [None].into_iter().chain(named).collect();
    let mut drawn = variants
        .iter()
        .map(|_| run.headless(world))
        .collect::<Result<Vec<_>>>()?;
    let size = match run.options.sizes.first() {
        Some(&width) => (width, width * SIZE.1 / SIZE.0),
        None => SIZE,
    };
    let camera = Camera::frame(&bounds, -DVec3::Y, 50.0, size)?;
    let settings = in_mode(Mode::Exact).raster(Raster::Tiles);
    for (name, clip) in &clips {
        let frames = in_turn(run.rounds(), variants.len(), |index, _| {
            replace_modules(variants[index]);
            timed(&mut drawn[index], &camera, clip, &settings)
        })?;
        let mut numbers = numbers.for_pictures(size.into(), name);
        let pictures = drawn.iter_mut().map(|headless| headless.picture());
        let pictures = pictures.collect::<Result<Vec<Picture>>>()?;
        for ((variant, frames), picture) in variants.iter().zip(&frames).zip(&pictures) {
            let folder = variant.and_then(Path::file_name);
            let name = folder.map_or("exact".into(), |name| name.to_string_lossy());
            numbers.add_frames(&name, frames);
            if variant.is_some() {
                let apart = differences(picture, &pictures[0])?.max;
                numbers.add(&name, "apart from the first", "of 255", vec![apart]);
            }
        }
        run.finish(&numbers)?;
    }
    replace_modules(None);
    Ok(())
}

/// Refuses a folder without modules, which would be measured as the program's own.
fn check(folder: &Path) -> Result<()> {
    let files = std::fs::read_dir(folder).map_err(Error::io(folder))?;
    let mut modules = files
        .flatten()
        .filter(|file| file.path().extension().is_some_and(|end| end == "spv"));
    match modules.next() {
        Some(_) => Ok(()),
        None => Err(Error::Invalid(format!(
            "{} holds no SPIR-V module (*.spv); tools/variants makes such folders",
            folder.display()
        ))),
    }
}
