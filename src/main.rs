//! The `rara` command: it parses the command line, does the work, and prints one line if that fails.
#![forbid(unsafe_code)]

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
