//! Instructions that the CPU side executes, counted by valgrind's callgrind: the same on a busy machine.

use std::path::Path;
use std::process::Command;

use rara::scene::Kind;
use rara::{Error, Result};

use crate::Bench;
use crate::args::Section;
use crate::callgrind::{Counted, read};
use crate::child::{self, Child, FRAMES};
use crate::report::{Place, say};
use crate::scratch::Scratch;
use crate::statistics::Summary;
use crate::table::Table;
use crate::world::Source;

/// A line: what is counted, and the instructions for each, all of them and those in our own code.
type Line = (&'static str, [f64; 2]);

pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    let valgrind = Command::new("valgrind").arg("--version").output();
    if !valgrind.is_ok_and(|output| output.status.success()) {
        say("instructions: SKIPPED: there is no valgrind here (Debian's package valgrind)");
        return Ok(());
    }
    let count = if bench.args.quick { 2000 } else { 5000 };
    let scratch = Scratch::new()?;
    let lines = lines(bench, count, &scratch)?;
    let place = Place {
        section: Section::Instructions,
        scene: "general".into(),
        gaussians: count as usize,
        size: [bench.args.size(); 2],
    };
    let title = "instructions: of one thread, drivers' threads left out";
    let mut table = Table::new(title, &["", "all", "in rara and this program"]);
    for (name, counted) in lines {
        for (pass, value) in ["all", "own"].into_iter().zip(counted) {
            let row = (name, pass, "instructions");
            bench.report.row(&place, row, &Summary::of(&[value]))?;
        }
        table.line(name, counted.map(|value| format!("{value:.0}")));
    }
    table.print();
    Ok(())
}

fn lines(bench: &Bench, gaussians: u32, scratch: &Scratch) -> Result<Vec<Line>> {
    say("instructions: load");
    let file = |count| scratch.file(&Source::Made(Kind::General, count));
    let (small, large) = (file(gaussians)?, file(2 * gaussians)?);
    // The difference between the two leaves out what any file costs.
    let (a, b) = (
        count(bench, Child::Load, &small, scratch)?,
        count(bench, Child::Load, &large, scratch)?,
    );
    let each = |more: u64| more as f64 / f64::from(gaussians);
    let mut lines = vec![(
        "load, a Gaussian",
        [each(b.all - a.all), each(b.own - a.own)],
    )];
    for (child, name) in [
        (Child::Record, "prepare and draw, a frame"),
        (Child::Configure, "configure, a frame"),
    ] {
        say(format_args!("instructions: {name}"));
        let sum = count(bench, child, &small, scratch)?;
        let each = [sum.all, sum.own].map(|sum| sum as f64 / f64::from(FRAMES));
        lines.push((name, each));
        if bench.args.quick {
            break; // Starting a driver in a simulator is slow, and the other process would do the same.
        }
    }
    Ok(lines)
}

fn count(bench: &Bench, child: Child, file: &Path, scratch: &Scratch) -> Result<Counted> {
    let out = scratch.path().join("callgrind.out");
    let words = child::command(&bench.args, child, file)?;
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
        .args(&words);
    let output = command.output().map_err(Error::io("valgrind"))?;
    if !output.status.success() {
        return Err(Error::Invalid(format!(
            "valgrind failed: {}",
            String::from_utf8_lossy(&output.stderr).trim()
        )));
    }
    let text = std::fs::read_to_string(&out).map_err(Error::io(out.clone()))?;
    let counted = read(&text, Path::new(&words[0]));
    if counted.all == 0 {
        return Err(Error::Invalid("callgrind has counted nothing".into()));
    }
    Ok(counted)
}
