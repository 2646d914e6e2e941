//! Instructions that the CPU side executes, counted by valgrind's callgrind: the same on a busy machine.

use std::path::Path;
use std::process::Command;

use rara::scene::{Kind, generate, save_ply};
use rara::{Error, Result};

use super::callgrind::{InstructionCounts, read};
use super::child::FRAMES;
use super::numbers::Measurements;
use super::run::Run;
use super::world::World;

/// Counts those of one thread; drivers' threads are left out.
pub(super) fn measure(run: &mut Run<'_>, world: &World, mut numbers: Measurements) -> Result<()> {
    let valgrind = Command::new("valgrind").arg("--version").output();
    if !valgrind.is_ok_and(|output| output.status.success()) {
        let why = "there is no valgrind here (Debian's package valgrind)";
        run.program.hear(&format!("instructions: SKIPPED: {why}"));
        return Ok(());
    }
    let (small, large) = (run.folder.join("small.ply"), run.folder.join("large.ply"));
    save_ply(&small, &world.scene)?;
    save_ply(&large, &generate(Kind::General, 2 * world.scene.len(), 1))?;
    // The difference between the two leaves out what any file costs.
    let (a, b) = (count(run, "load", &small)?, count(run, "load", &large)?);
    let each = |all, own, of: f64| [all, own].map(|count: u64| count as f64 / of);
    let more = world.scene.len() as f64;
    let load = each(b.all - a.all, b.own - a.own, more);
    let mut lines = vec![("load, a Gaussian", load)];
    for (work, name) in [
        ("record", "prepare and draw, a frame"),
        ("configure", "configure, a frame"),
    ] {
        let sum = count(run, work, &small)?;
        lines.push((name, each(sum.all, sum.own, FRAMES.into())));
        if run.options.quick {
            break; // Starting a driver in a simulator is slow, and the other process would do the same.
        }
    }
    for (at, column) in ["all", "rara's own"].into_iter().enumerate() {
        for (name, counts) in &lines {
            numbers.add(column, name, "instructions", vec![counts[at]]);
        }
    }
    run.finish(&numbers)
}

fn count(run: &mut Run<'_>, work: &str, file: &Path) -> Result<InstructionCounts> {
    run.program.hear(&format!("instructions: {work}"));
    let out = run.folder.join("callgrind.out");
    let child = run.program.child(work, file, run.options.size())?;
    let mut command = Command::new("valgrind");
    command.args([
        "--quiet",
        "--tool=callgrind",
        "--collect-atstart=no",
        "--toggle-collect=*counted_by_callgrind*",
        "--demangle=no",
    ]);
    command
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(child.get_program())
        .args(child.get_args());
    let output = command.output().map_err(Error::io("valgrind"))?;
    if !output.status.success() {
        return Err(Error::Invalid(format!(
            "valgrind failed: {}",
            String::from_utf8_lossy(&output.stderr).trim()
        )));
    }
    let text = std::fs::read_to_string(&out).map_err(Error::io(out))?;
    let counted = read(&text, Path::new(child.get_program()));
    if counted.all == 0 {
        return Err(Error::Invalid("callgrind has counted nothing".into()));
    }
    Ok(counted)
}
