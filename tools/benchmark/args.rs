//! The command line, and what each section measures by it.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Parser, ValueEnum};
use rara::HeadlessDesc;
use rara::scene::Kind;

use crate::child::Child;
use crate::turns::Rounds;
use crate::world::Source;

/// Measure what rara's frames take
#[derive(Debug, Parser)]
#[command(
    name = "tools/bench",
    bin_name = "tools/bench",
    after_help = "\
Examples:
  tools/bench -o bench                 # everything: the better part of an hour on two cores
  tools/bench --quick                  # that everything runs: seconds
  tools/bench passes --gaussians 500000 --sizes 1024
  tools/bench passes sweep --scene scene.ply --cameras cameras.json -o bench

What is compared is measured in turn, round by round; ratios are of the same round, and their
median counts. Tables go to the terminal as Markdown; the folder of -o gets bench.csv, a line for
each number, and grows with each run. What draws a wrong picture is not timed, and the exit
status is 1."
)]
pub(crate) struct Args {
    /// The sections to measure [default: all]; `correct` comes first in any case
    #[arg(value_name = "SECTION", value_enum)]
    sections: Vec<Section>,
    /// Tiny scenes and one round: only whether everything runs
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder for bench.csv; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// A scene file to measure instead of generated ones (repeatable)
    #[arg(long = "scene", value_name = "FILE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// The cameras that frames of these scenes take in turn [default: an orbit, 4 degrees a frame]
    #[arg(long, value_name = "FILE", requires = "scenes")]
    pub(crate) cameras: Option<PathBuf>,
    /// Gaussians of the generated scenes [default: each section's own]
    #[arg(long, value_name = "N,N...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    gaussians: Vec<u32>,
    /// Picture widths, px; sections other than `passes` take the first [default: 512,1024,2048 and 1024]
    #[arg(long, value_name = "N,N...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=16384))]
    sizes: Vec<u32>,
    /// Rounds at most; at least three, as many as half a minute gives [default: 9]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    rounds: Option<u32>,
    /// Device number or part of its name [default: the best]
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
    /// A process that another one measures
    #[arg(long, value_enum, hide = true, requires = "scenes")]
    pub(crate) child: Option<Child>,
}

/// A part of the benchmark, in the order in which they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum Section {
    /// Every raster path and mode against the picture in double precision
    Correct,
    /// Each stage, by Gaussians, picture size, mode and raster path
    Passes,
    /// A frame against what it cannot do without: bytes, fragments and keys at the device's own rates
    Bound,
    /// 30 frames of a moving plane, the camera fixed
    Sweep,
    /// Frames that show a hundredth of a scene
    Proportion,
    /// From nothing to the first picture, in a process of its own
    Start,
    /// Instructions of the CPU side, counted by valgrind's callgrind
    Instructions,
}

impl Section {
    /// The name on the command line and in the CSV.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Correct => "correct",
            Self::Passes => "passes",
            Self::Bound => "bound",
            Self::Sweep => "sweep",
            Self::Proportion => "proportion",
            Self::Start => "start",
            Self::Instructions => "instructions",
        }
    }
}

impl Args {
    pub(crate) fn wants(&self, section: Section) -> bool {
        self.sections.is_empty() || self.sections.contains(&section)
    }

    pub(crate) fn desc(&self) -> HeadlessDesc {
        HeadlessDesc::default().device(self.device.clone())
    }

    /// The scenes of a section.
    pub(crate) fn sources(&self, section: Section) -> Vec<Source> {
        if !self.scenes.is_empty() {
            let file = |path: &PathBuf| Source::File(path.clone(), self.cameras.clone());
            return self.scenes.iter().map(file).collect();
        }
        let usual: &[u32] = match section {
            _ if self.quick => &[2000],
            Section::Passes => &[100_000, 500_000, 1_000_000, 2_000_000, 5_000_000],
            Section::Bound => &[100_000, 1_000_000, 5_000_000],
            Section::Proportion => &[2_000_000, 5_000_000],
            Section::Correct => &[5000],
            _ => &[500_000],
        };
        // The scenes of `correct` stay small, since the reference takes its time.
        let given = match section {
            Section::Correct => &[],
            _ => &self.gaussians[..],
        };
        let kinds: &[Kind] = match section {
            Section::Sweep if !self.quick => &[Kind::General, Kind::Strands],
            Section::Correct => &[Kind::General, Kind::Strands, Kind::Layers],
            _ => &[Kind::General],
        };
        let counts = if given.is_empty() { usual } else { given };
        let of = |&count: &u32| kinds.iter().map(move |&kind| Source::Made(kind, count));
        counts.iter().flat_map(of).collect()
    }

    /// The picture widths of `passes`.
    pub(crate) fn sizes(&self) -> Vec<u32> {
        match &self.sizes[..] {
            [] if self.quick => vec![64, 96],
            [] => vec![512, 1024, 2048],
            given => given.to_vec(),
        }
    }

    /// The picture width of all other sections.
    pub(crate) fn size(&self) -> u32 {
        let usual = if self.quick { 64 } else { 1024 };
        self.sizes.first().copied().unwrap_or(usual)
    }

    pub(crate) fn rounds(&self) -> Rounds {
        let most = self.rounds.unwrap_or(if self.quick { 1 } else { 9 });
        Rounds {
            most,
            least: most.min(3),
            enough: Duration::from_secs(30),
        }
    }
}
