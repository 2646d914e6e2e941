//! Measures what rara's frames take: the program behind `tools/bench`. Each file is a section, which measures and prints.

mod args;
mod bound;
mod callgrind;
mod child;
mod correct;
mod fragments;
mod frame;
mod instructions;
mod memory;
mod passes;
mod proportion;
mod rates;
mod report;
mod scratch;
mod start;
mod statistics;
mod sweep;
mod table;
mod turns;
mod variant;
mod world;

use std::process::ExitCode;

use args::{Args, Section};
use clap::Parser as _;
use correct::Wrong;
use rara::{Error, Headless, Result};
use report::{Place, Report, say};
use world::Source;

/// The state that every section needs.
struct Bench {
    args: Args,
    report: Report,
    wrong: Wrong,
}

impl Bench {
    /// Measures each scene of a section, and prints which ones there is no memory for.
    fn each_source(
        &mut self,
        section: Section,
        scene: fn(&mut Self, &Source, &mut Place) -> Result<()>,
    ) -> Result<()> {
        for source in self.args.sources(section) {
            let size = self.args.size();
            let mut place = Place {
                section,
                scene: source.name(),
                gaussians: source.expected(),
                size: [size, size],
            };
            say(place.title());
            match scene(self, &source, &mut place) {
                Err(Error::Memory(why)) => self.report.no_memory(&place, &why)?,
                result => result?,
            }
        }
        Ok(())
    }
}

/// A section.
type Run = fn(&mut Bench) -> Result<()>;

fn main() -> ExitCode {
    let args = Args::parse();
    let result = match args.child {
        Some(child) => child::run(child, &args).map(|()| true),
        None => measure(args),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            say(format_args!("error: {error}"));
            ExitCode::FAILURE
        }
    }
}

/// Runs the sections; returns whether every picture was right.
fn measure(args: Args) -> Result<bool> {
    let report = Report::new(args.output.as_deref(), &Headless::new(&args.desc())?)?;
    let mut bench = Bench {
        args,
        report,
        wrong: Wrong::default(),
    };
    correct::run(&mut bench)?;
    let sections: [(Section, Run); 6] = [
        (Section::Passes, passes::run),
        (Section::Bound, bound::run),
        (Section::Sweep, sweep::run),
        (Section::Proportion, proportion::run),
        (Section::Start, start::run),
        (Section::Instructions, instructions::run),
    ];
    for (section, run) in sections {
        if bench.args.wants(section) {
            run(&mut bench)?;
        }
    }
    Ok(bench.wrong.none())
}
