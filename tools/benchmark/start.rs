//! From nothing to the first picture, in a process of its own, which is how long somebody who starts a viewer waits.

use std::fs::{create_dir_all, read, remove_dir_all};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Instant;

use rara::{Error, Result};

use crate::Bench;
use crate::args::Section;
use crate::child::{self, Child};
use crate::memory;
use crate::report::Place;
use crate::scratch::Scratch;
use crate::statistics::Summary;
use crate::table::{Table, spread};
use crate::turns::in_turn;
use crate::world::Source;

/// The two kinds of a start: the driver finds shaders that it has compiled before, or it finds none.
const VARIANTS: [&str; 2] = ["known shaders", "new shaders"];
/// The step that ends with the picture.
const LAST: &str = "first picture";

/// Steps and what they took, milliseconds.
type Steps = Vec<(String, f64)>;

pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    bench.each_source(Section::Start, scene)
}

fn scene(bench: &mut Bench, source: &Source, place: &mut Place) -> Result<()> {
    memory::check(source.expected(), 1)?;
    let scratch = Scratch::new()?;
    let file = scratch.file(source)?;
    let runs = in_turn(bench.args.rounds(), VARIANTS.len(), |index, _| {
        let cache = scratch.path().join(VARIANTS[index]);
        if index == 1 && cache.exists() {
            remove_dir_all(&cache).map_err(Error::io(cache.clone()))?;
        }
        one(bench, &file, &cache)
    })?;
    let names: Vec<String> = runs[0][0].iter().map(|(name, _)| name.clone()).collect();
    let title = format!("{}: ms, median (least-90 %)", place.title());
    let mut table = Table::new(title, &[&["step"], &VARIANTS[..]].concat());
    for (step, name) in names.iter().enumerate() {
        let mut cells = Vec::new();
        for (variant, runs) in VARIANTS.iter().zip(&runs) {
            let values: Vec<f64> = runs.iter().map(|steps| steps[step].1).collect();
            let summary = Summary::of(&values);
            bench.report.row(place, (variant, name, "ms"), &summary)?;
            cells.push(spread(&summary));
        }
        table.line(name, cells);
    }
    table.print();
    Ok(())
}

/// A process from its start to its first picture.
fn one(bench: &Bench, file: &Path, cache: &PathBuf) -> Result<Steps> {
    create_dir_all(cache).map_err(Error::io(cache))?;
    // Reading the file is not the renderer's work: its time is subtracted, so that no disk counts.
    let begin = Instant::now();
    drop(std::hint::black_box(read(file).map_err(Error::io(file))?));
    let reading = begin.elapsed().as_secs_f64() * 1e3;

    let words = child::command(&bench.args, Child::Start, file)?;
    let mut command = child::process(&words);
    // The folders in which drivers keep compiled shaders, Mesa's under either name.
    command
        .env("XDG_CACHE_HOME", cache)
        .env_remove("MESA_SHADER_CACHE_DIR");
    let failed = |what: &str| Error::Invalid(format!("a process that was measured {what}"));
    let begin = Instant::now();
    let mut process = command
        .stdout(Stdio::piped())
        .spawn()
        .map_err(Error::io(&words[0]))?;
    let mut steps: Steps = Vec::new();
    let mut whole = f64::NAN;
    let output = process
        .stdout
        .take()
        .ok_or_else(|| failed("says nothing"))?;
    for line in BufReader::new(output).lines() {
        let line = line.map_err(Error::io(&words[0]))?;
        let (name, ms) = line
            .rsplit_once(' ')
            .ok_or_else(|| failed("says something else"))?;
        if name == LAST {
            whole = begin.elapsed().as_secs_f64() * 1e3;
        }
        steps.push((
            name.into(),
            ms.parse().map_err(|_| failed("says no number"))?,
        ));
    }
    let status = process.wait().map_err(Error::io(&words[0]))?;
    if !status.success() || whole.is_nan() {
        return Err(failed("failed; it says why above"));
    }
    steps.push(("process to first picture".into(), whole));
    steps.push(("reading the file".into(), reading));
    steps.push(("beyond reading the file".into(), whole - reading));
    Ok(steps)
}
