//! `rara generate`: scenes made up by rule, the same for the same seed.

use std::path::PathBuf;

use clap::Args;
use clap::builder::TypedValueParser;

use super::failure::Failure;
use super::memory;
use super::output::{self, counted, say};
use super::values;
use rara::scene;

/// Generate a synthetic scene
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara generate general -n 100000 -o general.ply
  rara generate strands -n 3000000 --seed 7 -o hair.ply")]
pub(super) struct Generate {
    /// The kind of scene
    #[arg(value_parser = values::named::<scene::Kind>())]
    kind: scene::Kind,
    /// Number of Gaussians
    #[arg(short = 'n', long, value_name = "COUNT", default_value_t = 100_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    count: u32,
    /// Seed of the random numbers; the same seed makes the same scene
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// File for the scene
    #[arg(short, long, value_name = "OUT.ply", value_parser = values::one_file().try_map(values::ply_path))]
    output: PathBuf,
}

impl Generate {
    pub(super) fn run(self) -> Result<(), Failure> {
        output::check_file(&self.output)?;
        memory::check_gaussians(self.count.into())?;
        let made = scene::generate(self.kind, self.count as usize, self.seed);
        scene::save_ply(&self.output, &made)?;
        say(format_args!(
            "wrote {} to {}",
            counted(made.len() as u64, "Gaussian"),
            self.output.display()
        ));
        Ok(())
    }
}
