//! From nothing to the first picture, in a process of its own, which is how long somebody who starts a viewer waits.

use std::fs::{create_dir_all, read, remove_dir_all};
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::Stdio;
use std::time::Instant;

use rara::scene::save_ply;
use rara::{Clip, Error, Headless, Result, Settings};

use super::numbers::Measurements;
use super::run::{Run, RunTimeOptions, in_mode};
use super::world::World;
use crate::frames::{MODES, in_turn};

/// The two kinds of a start: the driver finds shaders that it has compiled before, or it finds none.
const VARIANTS: [&str; 2] = ["known shaders", "new shaders"];

/// The step that ends with the first picture.
const FIRST: &str = "first picture";

type Steps = Vec<(String, f64)>;

pub(super) fn measure(run: &mut Run<'_>, world: &World, mut numbers: Measurements) -> Result<()> {
    let file = world.file.clone().unwrap_or(run.folder.join("start.ply"));
    if world.file.is_none() {
        save_ply(&file, &world.scene)?;
    }
    let starts = in_turn(run.rounds(), VARIANTS.len(), |index, _| {
        let cache = run.folder.join(VARIANTS[index]);
        if index == 1 && cache.exists() {
            remove_dir_all(&cache).map_err(Error::io(cache.clone()))?;
        }
        create_dir_all(&cache).map_err(Error::io(cache.clone()))?;
        one(run, &file, &cache)
    })?;
    for (variant, starts) in VARIANTS.iter().zip(&starts) {
        for (step, (name, _)) in starts[0].iter().enumerate() {
            let values = starts.iter().map(|steps| steps[step].1).collect();
            numbers.add(variant, name, "ms", values);
        }
    }
    run.finish(&numbers)
}

/// A process from its start to its first picture.
fn one(run: &Run<'_>, file: &Path, cache: &Path) -> Result<Steps> {
    // Reading the file is not the renderer's work: its time is subtracted, so that no disk counts.
    let begin = Instant::now();
    drop(std::hint::black_box(read(file).map_err(Error::io(file))?));
    let reading = begin.elapsed().as_secs_f64() * 1e3;

    let failed = |what: &str| Error::Invalid(format!("a process that was measured {what}"));
    let mut command = run.program.start(file, run.options.size())?;
    // Where rara keeps what it compiles, and so do drivers unless they are told otherwise.
    command
        .env("RARA_CACHE", cache)
        .env_remove("MESA_SHADER_CACHE_DIR")
        .env_remove("MESA_GLSL_CACHE_DIR")
        .env_remove("__GL_SHADER_DISK_CACHE_PATH")
        .stdout(Stdio::piped());
    let begin = Instant::now();
    let mut process = command.spawn().map_err(Error::io("a process"))?;
    let output = process.stdout.take();
    let output = output.ok_or_else(|| failed("says nothing"))?;
    let (mut steps, mut whole) = (Steps::new(), None);
    for line in BufReader::new(output).lines() {
        let line = line.map_err(Error::io("a process"))?;
        let (name, ms) = line.rsplit_once(' ').unwrap_or_default();
        let ms = ms.parse().map_err(|_| failed("says something else"))?;
        steps.push((name.into(), ms));
        if name == FIRST {
            whole = Some(begin.elapsed().as_secs_f64() * 1e3);
        }
    }
    let status = process.wait().map_err(Error::io("a process"))?;
    let whole = whole.filter(|_| status.success());
    let whole = whole.ok_or_else(|| failed("failed; it says why above"))?;
    steps.push(("process to first picture".into(), whole));
    steps.push(("reading the file".into(), reading));
    steps.push(("beyond reading the file".into(), whole - reading));
    Ok(steps)
}

/// Goes from nothing to the first pictures of the first scene file. `say` takes the steps, each with its milliseconds.
pub fn start(options: &RunTimeOptions, say: &mut dyn FnMut(&str) -> Result<()>) -> Result<()> {
    let mut clock = Instant::now();
    let mut step = |name| {
        let said = say(&format!(
            "{name} {:.3}",
            clock.elapsed().as_secs_f64() * 1e3
        ));
        clock = Instant::now();
        said
    };
    let world = World::load(&options.scenes[0], options.cameras.as_deref())?;
    step("load")?;
    let mut headless = Headless::new(&options.device)?;
    step("device")?;
    headless.load_as(&world.scene, Settings::default().precision.sh)?;
    step("upload")?;
    let (camera, settings) = (world.camera(0, options.size())?, in_mode(MODES[0].1));
    headless.render(&camera, &Clip::default(), &settings)?;
    step(FIRST)?;
    headless.render(&camera, &Clip::default(), &settings)?;
    step("second picture")
}
